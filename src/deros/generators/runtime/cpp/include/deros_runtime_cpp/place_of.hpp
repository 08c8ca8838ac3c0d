// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__PLACE_OF_HPP_
#define DEROS_RUNTIME_CPP__PLACE_OF_HPP_

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace deros_runtime_cpp
{

/// Return the place of the first element that a condition holds of; the length for none.
template<typename Array, typename Condition>
std::size_t place_of(const Array & array, Condition holds)
{
  const auto found = std::find_if(array.begin(), array.end(), holds);
  return static_cast<std::size_t>(std::distance(array.begin(), found));
}

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__PLACE_OF_HPP_
