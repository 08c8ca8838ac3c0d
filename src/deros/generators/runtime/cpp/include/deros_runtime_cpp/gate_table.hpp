// Copyright and licence: see package.xml.

/// \file
/// The table of a gate: all that distinguishes it from others, but for the type of its commands.

#ifndef DEROS_RUNTIME_CPP__GATE_TABLE_HPP_
#define DEROS_RUNTIME_CPP__GATE_TABLE_HPP_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace deros_runtime_cpp
{

/// A constant array.
template<typename Item>
class Rows
{
public:
  constexpr Rows() = default;

  template<std::size_t COUNT>
  constexpr Rows(const Item (& rows)[COUNT])  // NOLINT(runtime/explicit)
  : begin_(rows), size_(COUNT)
  {
  }

  constexpr const Item * begin() const {return begin_;}
  constexpr const Item * end() const {return begin_ + size_;}
  constexpr std::size_t size() const {return size_;}
  constexpr const Item & operator[](std::size_t row) const {return begin_[row];}

private:
  const Item * begin_{nullptr};
  std::size_t size_{0};
};

/// The end of an interval, exact for every type of number that a field can have.
class Number
{
public:
  template<typename Value>
  constexpr Number(Value value)  // NOLINT(runtime/explicit)
  : real_(static_cast<double>(value)),
    whole_(std::is_integral_v<Value> ? static_cast<std::uint64_t>(value) : 0)
  {
  }

  /// Return the number as one of the field's type.
  template<typename Value>
  constexpr Value as() const
  {
    if constexpr (std::is_integral_v<Value>) {
      return static_cast<Value>(whole_);
    } else {
      return static_cast<Value>(real_);
    }
  }

  constexpr bool operator==(const Number & other) const
  {
    return real_ == other.real_ && whole_ == other.whole_;
  }

private:
  double real_;
  std::uint64_t whole_;  // modulo 2^64
};

/// The interval, ends included, that a line keeps a field in.
struct Limit
{
  std::string_view field;
  Number lower;
  Number upper;
};

/// The type of a field, which decides how it holds a number.
enum class Holds {FLOAT64, FLOAT32, INT8, UINT8, INT16, UINT16, INT32, UINT32, INT64, UINT64};

/// An end of a limit.
enum class End {LOWER, UPPER};

/// What gives a number: messages, or a parameter.
enum class Origin {INPUT, PARAMETER};

/// An end of a standing limit that is a number of others times a factor, in the unit of the field.
/** An unknown number stands for 0. The text is for readers. */
struct Bound
{
  std::string_view text;
  std::string_view field;
  End end;
  Origin origin;
  std::size_t number;  // of the input in the table, or of the parameter
  double factor;
  Holds type;  // of the field
};

/// A number that messages hold: unknown before the first one that holds it, silent_ns after the
/// last one (0: never), and as soon as one holds NaN, or is unreadable.
struct Input
{
  std::string_view name;
  std::int64_t silent_ns;
};

/// What a line is about; a standing one always applies.
enum class Cause {ACTION, LOST_HEARTBEAT, LOST_INPUT, STANDING};

/// When a line applies: while an action is active, or what can be lost has been silent for a time.
struct Condition
{
  Cause cause;
  std::string_view action;
  std::int64_t lost_ns;
};

constexpr Condition active(std::string_view action)
{
  return {Cause::ACTION, action, 0};
}

constexpr Condition lost_heartbeat(std::int64_t ns)
{
  return {Cause::LOST_HEARTBEAT, {}, ns};
}

constexpr Condition lost_input(std::int64_t ns)
{
  return {Cause::LOST_INPUT, {}, ns};
}

constexpr Condition always()
{
  return {Cause::STANDING, {}, 0};
}

/// The rate at which a field goes to zero, in its unit per second.
struct Ramp
{
  std::string_view field;
  double rate;
};

/// What a gate publishes while it stops; NOTHING is of a line that does not stop it.
enum class Stop {NOTHING, ZERO, SEND, HOLD, SILENCE};

/// What a line does to commands: it stops them, perhaps until a reset, it limits fields, or what
/// moves waits.
struct Effect
{
  Stop stop;
  Rows<Ramp> ramps;
  Rows<Limit> limits;
  bool until_reset;
  std::int64_t wait_ns;

  constexpr bool stops() const {return stop != Stop::NOTHING;}
};

constexpr Effect zero(Rows<Ramp> ramps = {})
{
  return {Stop::ZERO, ramps, {}, false, 0};
}

constexpr Effect send()
{
  return {Stop::SEND, {}, {}, false, 0};
}

constexpr Effect hold()
{
  return {Stop::HOLD, {}, {}, false, 0};
}

constexpr Effect silence()
{
  return {Stop::SILENCE, {}, {}, false, 0};
}

constexpr Effect until_reset(Effect effect)
{
  return {effect.stop, effect.ramps, effect.limits, true, 0};
}

constexpr Effect limited(Rows<Limit> limits)
{
  return {Stop::NOTHING, {}, limits, false, 0};
}

constexpr Effect wait(std::int64_t ns)
{
  return {Stop::NOTHING, {}, {}, false, ns};
}

/// How a line is reported while it applies.
enum class Severity {WARNING, SEVERE};

/// One line of a gate; text is the line as it is reported, with its place.
struct Line
{
  std::string_view text;
  Condition when;
  Effect effect;
  Severity severity;

  constexpr bool is_about_loss() const
  {
    return when.cause == Cause::LOST_HEARTBEAT || when.cause == Cause::LOST_INPUT;
  }
};

/// A topic whose commands pass while the last one is younger than a time.
struct Source
{
  std::string_view topic;
  std::int64_t silent_ns;
  bool from_zero;  // each time it takes over, its commands pass from the first one that is zero
};

/// The lines of a gate, of which earlier ones take precedence, and what they name.
struct Table
{
  Rows<Line> lines;
  Rows<std::string_view> actions;
  Rows<std::string_view> fields;
  std::int64_t period_ns;  // between two messages while the gate stops
  bool resume_on_zero;
  Rows<Source> sources{};  // those with a time of their own, earlier ones first
  Rows<Input> inputs{};  // those that bounds name
  Rows<Bound> bounds{};  // of the standing limits

  /// Return whether the gate may wait for a command that is safe.
  bool waits_for_zero() const
  {
    return resume_on_zero || std::any_of(
      sources.begin(), sources.end(), [](const Source & source) {return source.from_zero;});
  }
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__GATE_TABLE_HPP_
