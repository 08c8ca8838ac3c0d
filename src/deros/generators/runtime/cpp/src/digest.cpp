// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/digest.hpp"

#include <array>
#include <cstdint>
#include <string>

#include "rcutils/sha256.h"

namespace deros_runtime_cpp
{

std::string sha256(const std::string & text)
{
  std::array<std::uint8_t, RCUTILS_SHA256_BLOCK_SIZE> digest{};
  rcutils_sha256_ctx_t context;
  rcutils_sha256_init(&context);
  rcutils_sha256_update(
    &context, reinterpret_cast<const std::uint8_t *>(text.data()), text.size());
  rcutils_sha256_final(&context, digest.data());
  constexpr char DIGITS[] = "0123456789abcdef";
  std::string hexadecimal;
  for (const std::uint8_t byte : digest) {
    hexadecimal += DIGITS[byte >> 4U];
    hexadecimal += DIGITS[byte & 15U];
  }
  return hexadecimal;
}

}  // namespace deros_runtime_cpp
