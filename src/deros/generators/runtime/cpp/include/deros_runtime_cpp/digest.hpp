// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__DIGEST_HPP_
#define DEROS_RUNTIME_CPP__DIGEST_HPP_

#include <string>

namespace deros_runtime_cpp
{

/// Return the SHA-256 digest of a text as 64 hexadecimal digits.
std::string sha256(const std::string & text);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__DIGEST_HPP_
