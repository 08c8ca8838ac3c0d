// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__TEXT_HPP_
#define DEROS_RUNTIME_CPP__TEXT_HPP_

#include <cstdint>
#include <string>
#include <vector>

namespace deros_runtime_cpp
{

/// Return a number in the fewest digits that tell it from all others: 0.9, 1e-05, nan.
std::string shown(double value);

/// Return a value as people read it.
std::string shown(std::int64_t value);
std::string shown(std::uint64_t value);
std::string shown(bool value);

/// Return a wide text as UTF-8, with '?' for what is no character.
std::string utf8(const std::u16string & text);

/// Return texts with a separator between them.
std::string joined(const std::vector<std::string> & texts, const std::string & separator);

/// Return what an error number of the system means, in words.
std::string error_text(int number);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__TEXT_HPP_
