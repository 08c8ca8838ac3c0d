// Copyright and licence: see package.xml.

/// \file
/// Whose commands pass, of several sources of a gate.

#ifndef DEROS_RUNTIME_CPP__GATE_SOURCES_HPP_
#define DEROS_RUNTIME_CPP__GATE_SOURCES_HPP_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "deros_runtime_cpp/gate_numbers.hpp"
#include "deros_runtime_cpp/gate_table.hpp"

namespace deros_runtime_cpp
{

/// Chooses the first source that has spoken within its time.
/**
 * A source whose last command was refused has spoken, but has no command: none passes then, not
 * even of a later source. It allocates memory only when it is made.
 */
class Sources
{
public:
  /// Start without a command; without rows, there is one source that has no time of its own.
  explicit Sources(Rows<Source> rows)
  : spoken_(std::max<std::size_t>(rows.size(), 1))
  {
    std::transform(
      rows.begin(), rows.end(), spoken_.begin(),
      [](const Source & row) {return Spoken{row.silent_ns, LONG_AGO, false, false};});
    forget();
  }

  /// Forget all commands.
  void forget()
  {
    for (Spoken & each : spoken_) {
      each.heard = LONG_AGO;
      each.is_good = false;
    }
    speaking_ = chosen_ = arrived_ = spoken_.size();
    has_changed_ = false;
  }

  /// Take a command; is_good: it is not refused; is_safe: a line stops with such a one.
  void take(std::int64_t t, std::size_t source, bool is_good, bool is_safe)
  {
    Spoken & spoken = spoken_[source];
    spoken.heard = t;
    spoken.is_good = is_good;
    spoken.is_safe = is_safe;
    arrived_ = source;
  }

  /// Choose; return whether there is a new command to be executed.
  bool choose(std::int64_t t)
  {
    const std::size_t before = chosen_;
    const std::size_t arrived = arrived_;
    arrived_ = spoken_.size();
    speaking_ = 0;
    while (speaking_ < spoken_.size() && !spoken_[speaking_].is_speaking(t)) {
      ++speaking_;
    }
    const bool is_good = speaking_ < spoken_.size() && spoken_[speaking_].is_good;
    chosen_ = is_good ? speaking_ : spoken_.size();
    has_changed_ = chosen_ != before;
    return is_good && (has_changed_ || arrived == chosen_);
  }

  /// Return whether there is a source whose commands pass.
  bool is_any_chosen() const {return chosen_ < spoken_.size();}

  /// Return the number of that source.
  std::size_t chosen() const {return chosen_;}

  /// Return whether it is another one than at the last choice.
  bool has_changed() const {return has_changed_;}

  /// Return whether its last command is safe.
  bool is_safe() const {return is_any_chosen() && spoken_[chosen_].is_safe;}

  /// Return when the input is lost without another command, but for the time of a line.
  std::int64_t lost_from() const
  {
    return is_any_chosen() ? spoken_[chosen_].heard + spoken_[chosen_].silent_ns : LONG_AGO;
  }

  /// Return when to choose again at the latest.
  std::int64_t due() const
  {
    const bool is_timed = speaking_ < spoken_.size() && spoken_[speaking_].silent_ns != 0;
    return is_timed ? spoken_[speaking_].heard + spoken_[speaking_].silent_ns : NEVER;
  }

private:
  /// What a source has said last, and when.
  struct Spoken
  {
    std::int64_t silent_ns{0};
    std::int64_t heard{LONG_AGO};
    bool is_good{false};
    bool is_safe{false};

    bool is_speaking(std::int64_t t) const {return silent_ns == 0 || t < heard + silent_ns;}
  };

  std::vector<Spoken> spoken_;
  std::size_t speaking_{0};  // past the last: none
  std::size_t chosen_{0};  // past the last: none
  std::size_t arrived_{0};  // the source of a command that has just come; past the last: none
  bool has_changed_{false};
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__GATE_SOURCES_HPP_
