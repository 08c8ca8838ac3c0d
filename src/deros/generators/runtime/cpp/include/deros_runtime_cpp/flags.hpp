// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__FLAGS_HPP_
#define DEROS_RUNTIME_CPP__FLAGS_HPP_

#include <algorithm>
#include <cstddef>
#include <memory>

namespace deros_runtime_cpp
{

/// Return the entries of an array of flags one after another; a std::vector<bool> packs them.
/**
 * They are valid until the next call for the same place in the same thread. Memory is taken for an
 * array that is longer than all before.
 */
template<std::size_t Place, typename Array>
const bool * flags(const Array & array)
{
  static thread_local std::unique_ptr<bool[]> entries;
  static thread_local std::size_t room = 0;
  if (array.size() > room) {
    entries = std::make_unique<bool[]>(array.size());
    room = array.size();
  }
  std::copy(array.begin(), array.end(), entries.get());
  return entries.get();
}

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__FLAGS_HPP_
