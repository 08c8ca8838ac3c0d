// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__LATCHES_HPP_
#define DEROS_RUNTIME_CPP__LATCHES_HPP_

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "deros_runtime_cpp/descriptor.hpp"

namespace deros_runtime_cpp
{

/// Return the default path of the latch file of a node.
std::filesystem::path default_path(const std::string & stem);

/// A file with the names of the active actions, and a digest of them.
/**
 * It is replaced as a whole, so it is never half written. A file that cannot be read means that all
 * actions are active: an action starts inactive only if a valid file, or no file at all, says so.
 * Anything but a regular file (a link, a device, a pipe) counts as a file that cannot be read, and
 * is not touched. Nodes in Python and in C++ read each other's files.
 */
class LatchFile
{
public:
  using Names = std::set<std::string>;

  /// The contents of a file, and why all actions are active if it cannot be used.
  struct Loaded
  {
    Names active;
    std::string problem;
  };

  /// The owner is the name of the node, in case other nodes are given the same file by mistake.
  LatchFile(std::filesystem::path path, std::string owner);

  const std::filesystem::path & path() const
  {
    return path_;
  }

  /// Return whether the file is known to contain exactly these actions.
  bool contains(const Names & active) const
  {
    return saved_ == active;
  }

  /// Return the active actions, among those that are known.
  Loaded load(const Names & known) const;

  /// Write the active actions to the file, and flush it to the disk.
  /** \throw std::system_error on failure; the contents of the file are unknown then */
  void save(const Names & active);

  /// Return whether the path still leads to the file that was saved.
  bool is_in_place() const;

  /// Consider the contents of the file unknown, so that it is saved again.
  void invalidate()
  {
    saved_.reset();
  }

  /// Remove temporary files of processes that were killed while they saved.
  void remove_leftovers() const;

  /// Make the file unreadable, so that all actions count as active until it is saved again.
  /**
   * This takes microseconds, because it does not wait for the disk: it survives the end of the
   * process, but not a loss of power.
   */
  void mark_dirty() noexcept;

  /// Empty the file, which needs no space on the disk: all actions count as active then.
  /** \throw std::system_error on failure */
  void truncate();

private:
  std::string text_of(const std::vector<std::string> & names) const;
  std::filesystem::path new_path() const;
  void write_new(const std::filesystem::path & path, const Names & active);

  std::filesystem::path path_;
  std::string owner_;
  std::optional<Names> saved_;  // the contents of the file, if they are known
  Descriptor opened_;
};

/// The active latched actions, in this process and in the file; each action has a number.
class Latches
{
public:
  /// Takes the subject and the text of a fault; an empty text clears it.
  using Report = std::function<void (const std::string &, const std::string &)>;

  /// Read the file; if it cannot be read or written, all known actions are active.
  Latches(LatchFile file, std::vector<std::string> known, Report report);

  /// Return whether an action is active.
  bool is_active(std::size_t action) const
  {
    return active_[action];
  }

  /// Return the names of the active actions, sorted.
  LatchFile::Names active() const;

  /// Make sure, before an action is executed, that it is active after any end of the process.
  void mark_pending(std::size_t action) noexcept
  {
    if (!active_[action]) {
      file_.mark_dirty();
    }
  }

  /// Record an event of the monitor.
  void record(std::size_t action, bool active)
  {
    active_[action] = active;
  }

  /// Save the active actions; return why that failed, to be tried again, or an empty text.
  std::string persist();

  /// Save the actions that a reset leaves active before it happens; return why that failed.
  std::string allow_reset(const LatchFile::Names & remaining);

private:
  LatchFile file_;
  std::vector<std::string> known_;
  std::vector<bool> active_;
  Report report_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__LATCHES_HPP_
