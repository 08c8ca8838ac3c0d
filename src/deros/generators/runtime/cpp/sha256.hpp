#ifndef DEROS_RUNTIME__RUNTIME__SHA256_HPP_
#define DEROS_RUNTIME__RUNTIME__SHA256_HPP_

#include <string>

namespace deros_runtime
{

/// Return the SHA-256 digest of some bytes, as 64 hexadecimal digits. Source: FIPS 180-4.
std::string sha256(const std::string & bytes);

}  // namespace deros_runtime

#endif  // DEROS_RUNTIME__RUNTIME__SHA256_HPP_
