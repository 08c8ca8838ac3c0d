// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__TEXT_HPP_
#define DEROS_RUNTIME_CPP__TEXT_HPP_

#include <cstdint>
#include <string>
#include <vector>

namespace deros_runtime_cpp
{

/// Return a number with as few digits as identify it, as Python prints it: 0.9, 1e-05, nan.
std::string to_text(double value);

/// Return a float as the shortest decimal number that gives it: 0.1 for 0.10000000149.
std::string to_text(float value);

/// Return a value as text.
std::string to_text(std::int64_t value);
std::string to_text(std::uint64_t value);
std::string to_text(bool value);

/// Return a number of things, which is a double where it may be unknown; 0 for unknown.
std::int64_t whole(double value);

/// Return what follows a cause about a sector of which a share of beams is blind.
std::string beams_text(bool is_known, double share);

/// Return a UTF-16 text as UTF-8, with '?' for each lone surrogate.
std::string utf8(const std::u16string & text);

/// Return texts with a separator between them.
std::string joined(const std::vector<std::string> & texts, const std::string & separator);

/// Return the description of an error number of the system.
std::string error_text(int number);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__TEXT_HPP_
