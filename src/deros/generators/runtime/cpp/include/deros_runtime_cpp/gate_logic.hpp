// Copyright and licence: see package.xml.

/// \file
/// What a gate does: it plays the table of its lines.
///
/// What the lines mean is stated in the gate_logic.py of the runtime in Python. It uses only the
/// messages of ROS 2: the caller passes each event with its time in nanoseconds of one clock, and
/// an Output.

#ifndef DEROS_RUNTIME_CPP__GATE_LOGIC_HPP_
#define DEROS_RUNTIME_CPP__GATE_LOGIC_HPP_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "builtin_interfaces/msg/time.hpp"
#include "deros_runtime_cpp/gate_limits.hpp"
#include "deros_runtime_cpp/gate_numbers.hpp"
#include "deros_runtime_cpp/gate_sources.hpp"
#include "deros_runtime_cpp/gate_table.hpp"

namespace deros_runtime_cpp
{

/// Whether an action is active, as a message says.
struct ActionState
{
  std::string_view action;
  bool is_active;
};

/// Return whether one of the actions is active.
bool is_any_active(std::initializer_list<ActionState> states);

/// How far each of the table's fields has fallen to zero, at most; infinity is all the way.
using Drops = std::vector<double>;

/// Let a number of zeros fall from that of a command.
template<typename Value>
void fall(double by, Value from, Value & number)
{
  if (!std::isfinite(by)) {
    return;
  }
  const double start = static_cast<double>(from);
  const double end = start > 0 ? std::max(start - by, 0.0) : std::min(start + by, 0.0);
  number = std::abs(end) < std::abs(start) ? static_cast<Value>(end) : from;
}

/// Keep a number within a limit; return whether that changed it.
template<typename Value>
bool keep(const Limit * limit, Value & number)
{
  if (limit == nullptr) {
    return false;
  }
  const Value lower = limit->lower.template as<Value>();
  const Value upper = limit->upper.template as<Value>();
  if (number >= lower && number <= upper) {
    return false;
  }
  number = number < lower ? lower : upper;
  return true;
}

/// Finds which lines of a table apply, and publishes at once.
/** It allocates memory only when it is made. */
class Gate
{
public:
  /// Start at start; the first call publishes. parameters are those that bounds name.
  /** \throw std::invalid_argument if a line names an action or a field that the table does not */
  Gate(const Table & table, std::int64_t start, std::vector<double> parameters = {});
  virtual ~Gate() = default;

  // Events

  /// Take a refused command of a source, by its number in the table.
  void on_refused(std::int64_t t, std::size_t source = 0);

  /// Take the states of actions that one message holds; active ones, if it is unreadable.
  /** An untrusted message, perhaps not from the safety node, makes nothing inactive. */
  void on_state(
    std::int64_t t, std::initializer_list<ActionState> states, bool is_trusted);

  /// Take the numbers that one message holds for inputs of the table.
  void on_inputs(std::int64_t t, std::initializer_list<InputNumber> numbers);

  /// Take a heartbeat of the safety node: a sign of life if its counter has advanced.
  void on_heartbeat(std::int64_t t, std::uint64_t counter);

  /// Note that no node, or more than one, can be the safety node.
  void on_no_safety_node(std::int64_t t);

  /// Decide a reset; return false if it is refused, because a line refuses() it.
  bool on_reset(std::int64_t t);

  // Time

  /// Return when to call advance() at the latest.
  std::int64_t next_deadline() const;

  /// Handle everything due up to and including t.
  void advance(std::int64_t t);

  // State

  /// Return the instant of the last event.
  std::int64_t now() const {return now_;}

  /// Return the table.
  const Table & table() const {return table_;}

  /// Return for each of the reports() whether it applies.
  const std::vector<bool> & applying() const {return applying_;}

  /// Return when that changed last.
  std::int64_t since() const {return since_;}

  /// Return the topic whose commands may pass, if there is one among several sources.
  std::string_view source_name() const;

  /// Return the texts of everything that can hold commands back: lines, latches and waits.
  std::vector<std::string> reports() const;

  /// Return whether a line applies that does not let the gate be reset.
  bool refuses(std::size_t line) const;

protected:
  /// Decide on a command that has just been stored; is_safe: a line stops with such a one.
  void take_command(std::size_t source, bool is_safe);

  /// Return the number of the source whose stored command is meant.
  std::size_t source() const {return source_;}

  /// Return whether it matters that a command is safe.
  bool asks_for_safe() const {return table_.waits_for_zero() || has_waits_;}

  /// Return the limits that always hold.
  const Limits & standing() const {return standing_.limits();}

  /// Return whether some of them can change.
  bool can_narrow() const {return standing_.can_change();}

  /// Let a field fall on from where it is.
  void fall_on(std::size_t field);

private:
  /// Publish the stored command within limits, and execute that from now on.
  virtual void execute(const Limits & limits) = 0;

  /// Publish the executed command again if it exceeds limits.
  virtual void limit(const Limits & limits) = 0;

  /// Publish the executed command again.
  virtual void hold() = 0;

  /// Keep what was published last within the limits that always hold; return whether it changed.
  virtual bool narrow() = 0;

  /// Let the fields with a ramp fall from the executed command.
  virtual void begin_fall() = 0;

  /// Publish zeros, except for fields that have not fallen all the way, and for those with a limit:
  /// they are of the stored command, within it.
  virtual void make_zero(const Drops & drops, const Limits & left) = 0;

  /// Publish what a line sends.
  virtual void send(std::size_t line) = 0;

  /// Let a field with this limit fall from what was published last; return whether it was there.
  virtual bool fall_from_published(std::size_t field, const Limit * limit) = 0;

  void begin(std::int64_t t);
  std::int64_t loss(const Line & line) const;
  void settle(std::int64_t t);
  bool choose_source();
  void find_losses();
  void find_lines();
  bool find_stop();
  void forget_actions();
  bool find_wait(const Effect * stop, bool is_new, bool is_safe);
  bool has_waited() const;
  bool is_waiting() const {return waits_ || takes_over_;}
  const Effect & stop() const;
  const Limit * limit_of(std::size_t field) const;
  void choose_limits(bool is_whole);
  bool is_as_decided(const Effect * stop) const;
  void follow(const Effect * stop, bool is_new);
  void publish_stop(const Effect & stop);
  bool exceeds_limits(const Effect & stop);
  void start_ramps();
  void find_drops(std::int64_t t);
  void stop_limited();
  void fall_from_limits();
  void report(bool is_stopped);

  const Table & table_;
  std::vector<std::size_t> actions_;  // of each line, the number of its action
  std::vector<const Limit *> choices_;  // of each line, its limit of each field
  const Limits no_limits_;
  StandingLimits standing_;
  std::vector<bool> active_;  // of each action
  std::vector<std::int64_t> active_since_;  // of each action that is known to be; else NEVER
  bool has_waits_{false};  // whether a line waits before moving
  const Effect * rest_{nullptr};  // how the gate stops meanwhile, if not as it did last
  bool moves_{false};  // whether what was published last does
  bool is_held_{false};  // whether a command that moves is held back
  std::int64_t wished_since_{0};  // to move, which waits; else NEVER
  std::vector<bool> applies_;  // of each line
  std::vector<bool> latched_;  // of each line
  bool is_any_latched_{false};
  Limits limits_;  // of the last decision
  Limits chosen_;  // of this one
  const Effect * stop_{nullptr};  // of the last decision, if the gate stops
  std::size_t decided_{0};  // the line that said so
  std::size_t deciding_{0};  // the line that says how the gate stops; past the last: none does
  bool is_executing_{false};  // whether the last command published is still in effect
  Drops fell_;  // of the fields, until falls_since_
  bool has_command_{false};  // whether the source has ever sent a good one
  bool is_falling_{false};  // what was published last are zeros in the form of one
  bool has_fallen_{false};  // whether there is something that the ramps fall from
  Drops drops_;  // now
  std::vector<std::int64_t> falls_since_;
  bool waits_{false};  // for a command that is safe, after a stop
  bool takes_over_{false};  // the chosen source has to send a safe one first
  std::vector<bool> applying_;
  std::vector<bool> reported_;
  std::int64_t since_;
  std::int64_t now_{0};
  std::int64_t called_{0};
  std::int64_t heartbeat_{0};  // time of the last sign of life
  std::optional<std::uint64_t> counter_{};  // of the last heartbeat
  Sources sources_;
  std::size_t source_{0};  // the last one chosen
  bool is_heartbeat_lost_{true};
  bool is_input_lost_{true};
  std::int64_t zero_due_{0};
  std::int64_t lost_due_{0};
};

/// The kind of a published command: the new one as it arrived, the last one within the limits,
/// zero, except for numbers with a limit before the zero line and those that still fall, what a
/// line sends, or the one before once more.
enum class Published {PASS, LIMITED, ZERO, SEND, HOLD};

/// A gate for commands of one type.
/**
 * \tparam Message the functions for the fields of its commands, all static: is_finite(), is_safe(),
 *   make_zero(), send(), fall(), keep() and leave()
 *
 * It allocates no memory, except for the texts and arrays of commands.
 */
template<typename Message>
class GateOf : public Gate
{
public:
  using Command = typename Message::Command;

  /// Publishes the commands. Meanwhile, now() is the instant of the command.
  struct Output
  {
    virtual ~Output() = default;

    virtual void publish(Published what, const Command & command) = 0;

    /// Return the stamp of zeros published at now().
    virtual builtin_interfaces::msg::Time stamp() = 0;
  };

  /// Start at start; the first call publishes.
  GateOf(
    const Table & table, std::int64_t start, Output & output, std::vector<double> parameters = {})
  : Gate(table, start, std::move(parameters)),
    output_(output),
    narrowed_(table.fields.size(), nullptr),
    commands_(
      std::max<std::size_t>(table.sources.size(), 1),
      Command(rosidl_runtime_cpp::MessageInitialization::ZERO))
  {
  }

  /// Take a command of a source, by its number in the table.
  /** Return false if it is refused, because a number in it is NaN or infinite. */
  bool on_command(std::int64_t t, const Command & command, std::size_t source = 0)
  {
    if (!Message::is_finite(command)) {
      on_refused(t, source);
      return false;
    }
    advance(t);
    commands_[source] = command;
    take_command(source, asks_for_safe() && Message::is_safe(command));
    return true;
  }

private:
  void execute(const Limits & limits) override
  {
    made_ = commands_[source()];
    output_.publish(keep(limits) ? Published::LIMITED : Published::PASS, made_);
  }

  void limit(const Limits & limits) override
  {
    if (keep(limits)) {
      output_.publish(Published::LIMITED, made_);
    }
  }

  void hold() override
  {
    Message::keep(made_, standing());
    output_.publish(Published::HOLD, made_);
  }

  bool narrow() override
  {
    return Message::keep(made_, standing());
  }

  void begin_fall() override
  {
    from_ = made_;
  }

  void make_zero(const Drops & drops, const Limits & left) override
  {
    made_ = commands_[source()];
    Message::make_zero(made_, output_.stamp());
    Message::fall(made_, from_, drops);
    if (can_narrow()) {
      keep_falling(drops, left);
    }
    Message::leave(made_, commands_[source()], left);
    Message::keep(made_, standing());
    output_.publish(Published::ZERO, made_);
  }

  void send(std::size_t line) override
  {
    made_ = commands_[source()];
    Message::make_zero(made_, output_.stamp());
    Message::send(made_, line);
    output_.publish(Published::SEND, made_);
  }

  bool fall_from_published(std::size_t field, const Limit * limit) override
  {
    narrowed_[field] = limit;
    const bool is_there = Message::leave(from_, made_, narrowed_);
    narrowed_[field] = nullptr;
    return is_there;
  }

  /// Keep the fields that fall within the limits that stand; they fall on from there.
  void keep_falling(const Drops & drops, const Limits & left)
  {
    for (std::size_t field = 0; field < drops.size(); ++field) {
      if (std::isfinite(drops[field]) && left[field] == nullptr) {
        narrowed_[field] = standing()[field];
        if (Message::keep(made_, narrowed_)) {
          Message::leave(from_, made_, narrowed_);
          fall_on(field);
        }
        narrowed_[field] = nullptr;
      }
    }
  }

  bool keep(const Limits & limits)
  {
    const bool is_limited = Message::keep(made_, limits);
    return Message::keep(made_, standing()) || is_limited;
  }

  Output & output_;
  Limits narrowed_;  // one at a time
  std::vector<Command> commands_;  // the last good one of each source
  Command made_{rosidl_runtime_cpp::MessageInitialization::ZERO};  // what was published last
  Command from_{rosidl_runtime_cpp::MessageInitialization::ZERO};  // what the ramps fall from
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__GATE_LOGIC_HPP_
