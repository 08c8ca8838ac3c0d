// Copyright and licence: see package.xml.

/// \file
/// Times and numbers of a gate: what is finite, and what is zero.

#ifndef DEROS_RUNTIME_CPP__GATE_NUMBERS_HPP_
#define DEROS_RUNTIME_CPP__GATE_NUMBERS_HPP_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ == 1
#error "a gate has to distinguish NaN from numbers: compile it without -ffast-math"
#endif

namespace deros_runtime_cpp
{

/// Later than any time, in nanoseconds.
constexpr std::int64_t NEVER = std::numeric_limits<std::int64_t>::max();

/// The latest time there is, in 2116; the sum of it and a duration is still less than NEVER.
constexpr std::int64_t LATEST = (std::int64_t{1} << 62) - 1;

/// The time of a message that has not been received: every timeout for it has expired.
constexpr std::int64_t LONG_AGO = -LATEST;

/// Return a time clamped to the range in which no sum overflows.
constexpr std::int64_t bounded(std::int64_t t)
{
  return std::clamp(t, std::int64_t{0}, LATEST);
}

/// Return whether all elements of an array pass a test.
template<typename Array, typename Test>
bool are_all(const Array & array, Test test)
{
  return std::all_of(array.begin(), array.end(), test);
}

/// Return whether all floats of an array are finite.
template<typename Array>
bool all_finite(const Array & array)
{
  return are_all(array, [](const auto & each) {return std::isfinite(each);});
}

/// Return whether all numbers or booleans of an array are zero.
template<typename Array>
bool all_zero(const Array & array)
{
  return are_all(array, [](const auto & each) {return each == typename Array::value_type{};});
}

/// Set all numbers or booleans of an array to zero.
template<typename Array>
void fill_with_zeros(Array & array)
{
  std::fill(array.begin(), array.end(), typename Array::value_type{});
}

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__GATE_NUMBERS_HPP_
