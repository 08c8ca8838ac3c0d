#include "deros_runtime/runtime/sha256.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace deros_runtime
{

namespace
{

constexpr std::size_t BLOCK = 64;  // bytes

constexpr std::array<std::uint32_t, 64> K = {
  0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
  0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
  0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
  0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
  0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
  0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
  0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
  0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2,
};

std::uint32_t rotated(std::uint32_t word, unsigned count)
{
  return (word >> count) | (word << (32U - count));
}

std::uint32_t word_at(const std::string & bytes, std::size_t place)
{
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    word = (word << 8U) | static_cast<unsigned char>(bytes[place + i]);
  }
  return word;
}

/// Return the message with its padding: a bit, zeros, and its length in bits.
std::string padded(const std::string & bytes)
{
  std::string text = bytes + '\x80';
  text.append((2 * BLOCK - 8 - text.size() % BLOCK) % BLOCK, '\0');
  const std::uint64_t bits = static_cast<std::uint64_t>(bytes.size()) * 8U;
  for (unsigned shift = 64; shift > 0; shift -= 8) {
    text += static_cast<char>((bits >> (shift - 8U)) & 0xffU);
  }
  return text;
}

void take_block(std::array<std::uint32_t, 8> & hash, const std::string & text, std::size_t begin)
{
  std::array<std::uint32_t, 64> w{};
  for (std::size_t i = 0; i < 16; ++i) {
    w[i] = word_at(text, begin + 4 * i);
  }
  for (std::size_t i = 16; i < 64; ++i) {
    const std::uint32_t low = rotated(w[i - 15], 7) ^ rotated(w[i - 15], 18) ^ (w[i - 15] >> 3U);
    const std::uint32_t high = rotated(w[i - 2], 17) ^ rotated(w[i - 2], 19) ^ (w[i - 2] >> 10U);
    w[i] = w[i - 16] + low + w[i - 7] + high;
  }
  auto [a, b, c, d, e, f, g, h] = hash;
  for (std::size_t i = 0; i < 64; ++i) {
    const std::uint32_t sum1 = rotated(e, 6) ^ rotated(e, 11) ^ rotated(e, 25);
    const std::uint32_t first = h + sum1 + ((e & f) ^ (~e & g)) + K[i] + w[i];
    const std::uint32_t sum0 = rotated(a, 2) ^ rotated(a, 13) ^ rotated(a, 22);
    const std::uint32_t second = sum0 + ((a & b) ^ (a & c) ^ (b & c));
    h = g;
    g = f;
    f = e;
    e = d + first;
    d = c;
    c = b;
    b = a;
    a = first + second;
  }
  const std::array<std::uint32_t, 8> added = {a, b, c, d, e, f, g, h};
  for (std::size_t i = 0; i < 8; ++i) {
    hash[i] += added[i];
  }
}

}  // namespace

std::string sha256(const std::string & bytes)
{
  std::array<std::uint32_t, 8> hash = {
    0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19,
  };
  const std::string text = padded(bytes);
  for (std::size_t begin = 0; begin < text.size(); begin += BLOCK) {
    take_block(hash, text, begin);
  }
  std::string digits;
  for (const std::uint32_t word : hash) {
    for (unsigned shift = 32; shift > 0; shift -= 4) {
      digits += "0123456789abcdef"[(word >> (shift - 4U)) & 0xfU];
    }
  }
  return digits;
}

}  // namespace deros_runtime
