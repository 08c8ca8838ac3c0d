// Copyright and licence: see package.xml.

/// \file
/// The limits of a gate that always hold: some of their ends come in messages, or as parameters.

#ifndef DEROS_RUNTIME_CPP__GATE_LIMITS_HPP_
#define DEROS_RUNTIME_CPP__GATE_LIMITS_HPP_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/gate_numbers.hpp"
#include "deros_runtime_cpp/gate_table.hpp"

namespace deros_runtime_cpp
{

/// The limit in force of each of the table's fields; nullptr is none.
using Limits = std::vector<const Limit *>;

/// The number of an input that is unknown.
constexpr double UNKNOWN = std::numeric_limits<double>::quiet_NaN();

/// The number that a message holds for an input, by that of the input in the table.
struct InputNumber
{
  std::size_t input;
  double number;
};

/// Return a number cut to an integer, and within the range of its type.
template<typename Whole>
Number as_whole(double value)
{
  using Range = std::numeric_limits<Whole>;
  const double beyond = static_cast<double>(Range::max() / 2 + 1) * 2;  // a power of two
  if (value >= beyond) {
    return Number(Range::max());
  }
  if (value <= (Range::is_signed ? -beyond : 0.0)) {
    return Number(Range::min());
  }
  return Number(static_cast<Whole>(value));
}

/// Return a number as a field of a type holds it.
inline Number held(double value, Holds type)
{
  switch (type) {
    case Holds::FLOAT32: return Number(static_cast<float>(value));
    case Holds::INT8: return as_whole<std::int8_t>(value);
    case Holds::UINT8: return as_whole<std::uint8_t>(value);
    case Holds::INT16: return as_whole<std::int16_t>(value);
    case Holds::UINT16: return as_whole<std::uint16_t>(value);
    case Holds::INT32: return as_whole<std::int32_t>(value);
    case Holds::UINT32: return as_whole<std::uint32_t>(value);
    case Holds::INT64: return as_whole<std::int64_t>(value);
    case Holds::UINT64: return as_whole<std::uint64_t>(value);
    case Holds::FLOAT64: break;
  }
  return Number(value);
}

/// Finds the limits that always hold; what they mean is stated in the gate_limits.py of the runtime
/// in Python.
/** It allocates memory only when it is made. */
class StandingLimits
{
public:
  /// Start without a message; parameters are those that bounds name, by their numbers.
  StandingLimits(const Table & table, std::vector<double> parameters)
  : inputs_(table.inputs),
    limits_(table.fields.size(), nullptr),
    parameters_(std::move(parameters)),
    numbers_(table.inputs.size(), UNKNOWN),
    arrived_(table.inputs.size(), LONG_AGO)
  {
    opened_.reserve(table.fields.size());  // their places must not change
  }

  /// Set a limit that stands, with its bounds, if it has some.
  void set(std::size_t field, const Limit & limit, const Rows<Bound> & bounds)
  {
    limits_[field] = &limit;
    Opened opened{limit, limit, nullptr, nullptr};
    for (const Bound & bound : bounds) {
      if (bound.field == limit.field) {
        (bound.end == End::LOWER ? opened.lower : opened.upper) = &bound;
      }
    }
    if (opened.lower != nullptr || opened.upper != nullptr) {
      opened_.push_back(opened);
      limits_[field] = &opened_.back().now;
    }
  }

  /// Forget all messages.
  void forget() {numbers_.assign(numbers_.size(), UNKNOWN);}

  /// Take the numbers of some inputs.
  void take(std::int64_t t, std::initializer_list<InputNumber> numbers)
  {
    for (const InputNumber & each : numbers) {
      numbers_[each.input] = each.number;
      arrived_[each.input] = t;
    }
  }

  /// Find the limits at t.
  void settle(std::int64_t t)
  {
    for (std::size_t input = 0; input < numbers_.size(); ++input) {
      if (due(input) <= t) {
        numbers_[input] = UNKNOWN;
      }
    }
    for (Opened & each : opened_) {
      const Holds type = each.lower != nullptr ? each.lower->type : each.upper->type;
      const double lower = value(each.lower, each.written.lower);
      const double upper = value(each.upper, each.written.upper);
      const bool is_empty = lower > upper;
      if (each.lower != nullptr || is_empty) {
        each.now.lower = held(lower < 0 && !is_empty ? lower : 0.0, type);
      } else {
        each.now.lower = each.written.lower;
      }
      if (each.upper != nullptr || is_empty) {
        each.now.upper = held(upper > 0 && !is_empty ? upper : 0.0, type);
      } else {
        each.now.upper = each.written.upper;
      }
    }
  }

  /// Return the limits, as of the last time that they were found.
  const Limits & limits() const {return limits_;}

  /// Return whether some of them can change.
  bool can_change() const {return !opened_.empty();}

  /// Return whether the number of an input is unknown.
  bool is_unknown(std::size_t input) const {return std::isnan(numbers_[input]);}

  /// Return when a number becomes unknown, if no other one comes.
  std::int64_t due() const
  {
    std::int64_t first = NEVER;
    for (std::size_t input = 0; input < numbers_.size(); ++input) {
      first = std::min(first, due(input));
    }
    return first;
  }

private:
  struct Opened
  {
    Limit written;
    Limit now;
    const Bound * lower;
    const Bound * upper;
  };

  std::int64_t due(std::size_t input) const
  {
    const std::int64_t silent_ns = inputs_[input].silent_ns;
    return silent_ns == 0 || is_unknown(input) ? NEVER : arrived_[input] + silent_ns;
  }

  double value(const Bound * bound, const Number & written) const
  {
    if (bound == nullptr) {
      return written.as<double>();
    }
    if (bound->origin == Origin::PARAMETER) {
      return parameters_[bound->number] * bound->factor;
    }
    return is_unknown(bound->number) ? 0.0 : numbers_[bound->number] * bound->factor;
  }

  const Rows<Input> inputs_;
  Limits limits_;
  std::vector<Opened> opened_{};
  const std::vector<double> parameters_;
  std::vector<double> numbers_;  // of the inputs
  std::vector<std::int64_t> arrived_;  // when they did
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__GATE_LIMITS_HPP_
