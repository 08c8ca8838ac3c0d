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

/// Return where the file of a node is unless a parameter says otherwise.
std::filesystem::path default_path(const std::string & stem);

/// A file with the names of the active actions, and a digest over them.
/**
 * It is replaced as a whole, so it is never half written. Whatever cannot be read counts as 'all
 * active': only a file that says so, or no file at all, lets an action begin inactive. What stands
 * in its place but is not a regular file (a link, a device, a pipe) counts as a file that cannot be
 * read, and is left as it is. Nodes in Python and in C++ read each other's files.
 */
class LatchFile
{
public:
  using Names = std::set<std::string>;

  /// What a file says, and why it is all if it should not be.
  struct Loaded
  {
    Names active;
    std::string problem;
  };

  /// Prepare; owner tells the node from others that are given the same file by mistake.
  LatchFile(std::filesystem::path path, std::string owner);

  const std::filesystem::path & path() const
  {
    return path_;
  }

  /// Tell whether the file says that these are active, as far as is known.
  bool says(const Names & active) const
  {
    return saved_ == active;
  }

  /// Return which of the known actions are active.
  Loaded load(const Names & known) const;

  /// Have the file say which actions are active, now and after a loss of power.
  /**
   * \throw std::system_error if that is impossible; what the file says then is not known
   */
  void save(const Names & active);

  /// Tell whether the name still stands for the file that was saved.
  bool is_in_place() const;

  /// Take it that nothing is known of the file any more, so that it is saved again.
  void forget()
  {
    saved_.reset();
  }

  /// Remove new files that processes have left that were killed while they saved.
  void remove_leftovers() const;

  /// Have the file count as 'all active' until it is saved again.
  /**
   * This takes microseconds, because it does not wait for the disk: it outlives the process,
   * however that ends, though not a loss of power.
   */
  void mark_dirty() noexcept;

  /// Empty the file, which needs no space: it counts as 'all active' then.
  /**
   * \throw std::system_error if that is impossible, too
   */
  void truncate();

private:
  std::string text_of(const std::vector<std::string> & names) const;
  std::filesystem::path new_path() const;
  void write_new(const std::filesystem::path & path, const Names & active);

  std::filesystem::path path_;
  std::string owner_;
  std::optional<Names> saved_;  // what the file says, if that is known
  Descriptor opened_;
};

/// The latched actions that are active, in this process and in the file; each has a number.
class Latches
{
public:
  /// Takes a subject and what is wrong with it; an empty text takes it back.
  using Tell = std::function<void (const std::string &, const std::string &)>;

  /// Begin as the file says; if it cannot be read or written, with all known actions active.
  Latches(LatchFile file, std::vector<std::string> known, Tell tell);

  /// Tell whether an action is active.
  bool is_active(std::size_t action) const
  {
    return active_[action];
  }

  /// Return the names of the active actions, sorted.
  LatchFile::Names active() const;

  /// Make sure, before an action is carried out, that no end of the process forgets it.
  void mark_pending(std::size_t action) noexcept
  {
    if (!active_[action]) {
      file_.mark_dirty();
    }
  }

  /// Follow an event of the monitor.
  void follow(std::size_t action, bool active)
  {
    active_[action] = active;
  }

  /// Have the file say what is active; return why it does not. To be tried again then.
  std::string persist();

  /// Have the file say what a reset will leave active, in advance, or return why not.
  std::string allow_reset(const LatchFile::Names & remaining);

private:
  LatchFile file_;
  std::vector<std::string> known_;
  std::vector<bool> active_;
  Tell tell_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__LATCHES_HPP_
