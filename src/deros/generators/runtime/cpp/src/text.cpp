// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <system_error>
#include <vector>

namespace deros_runtime_cpp
{

namespace
{

constexpr int MIN_PLAIN = -4;  // decimal exponents of numbers that are written without one
constexpr int MAX_PLAIN = 16;
constexpr int FLOAT_DIGITS = 9;  // with so many decimal digits every float is told from all others

/// Return digits in positional notation; the first one counts 10 to the power of exponent.
std::string plain(const std::string & digits, int exponent)
{
  if (exponent < 0) {
    return "0." + std::string(static_cast<std::size_t>(-exponent - 1), '0') + digits;
  }
  const auto whole = static_cast<std::size_t>(exponent) + 1;
  if (digits.size() <= whole) {
    return digits + std::string(whole - digits.size(), '0') + ".0";
  }
  return digits.substr(0, whole) + '.' + digits.substr(whole);
}

std::string scientific(const std::string & digits, int exponent)
{
  std::string text = digits.substr(0, 1);
  if (digits.size() > 1) {
    text += '.' + digits.substr(1);
  }
  const int size = std::abs(exponent);
  return text + (exponent < 0 ? "e-" : "e+") + (size < 10 ? "0" : "") + std::to_string(size);
}

}  // namespace

std::string to_text(double value)
{
  if (std::isnan(value)) {
    return "nan";
  }
  const std::string sign = value < 0.0 ? "-" : "";
  if (std::isinf(value)) {
    return sign + "inf";
  }
  std::array<char, 64> buffer{};
  const auto end = std::to_chars(
    buffer.data(), buffer.data() + buffer.size(), std::fabs(value), std::chars_format::scientific);
  const std::string text(buffer.data(), end.ptr);
  const std::size_t mark = text.find('e');
  std::string digits = text.substr(0, mark);
  if (digits.size() > 1) {
    digits.erase(1, 1);  // the decimal point
  }
  const int exponent = std::stoi(text.substr(mark + 1));
  const bool is_plain = MIN_PLAIN <= exponent && exponent < MAX_PLAIN;
  return sign + (is_plain ? plain(digits, exponent) : scientific(digits, exponent));
}

std::string to_text(float value)
{
  std::array<char, 64> buffer{};
  for (int digits = 1; digits <= FLOAT_DIGITS; ++digits) {
    const auto end = std::to_chars(
      buffer.data(), buffer.data() + buffer.size(), static_cast<double>(value),
      std::chars_format::general, digits);
    double found = 0.0;
    std::from_chars(buffer.data(), end.ptr, found);
    if (static_cast<float>(found) == value) {
      return to_text(found);
    }
  }
  return to_text(static_cast<double>(value));
}

std::string to_text(std::int64_t value)
{
  return std::to_string(value);
}

std::string to_text(std::uint64_t value)
{
  return std::to_string(value);
}

std::string to_text(bool value)
{
  return value ? "true" : "false";
}

std::int64_t whole(double value)
{
  return std::isnan(value) ? 0 : static_cast<std::int64_t>(value);
}

std::string beams_text(bool is_known, double share)
{
  if (!is_known || !(share > 0.0)) {
    return "";
  }
  const int percent = static_cast<int>(100.0 * share + 0.5);
  return " (" + std::to_string(std::max(1, percent)) + " % of its beams blind)";
}

std::string utf8(const std::u16string & text)
{
  std::string bytes;
  const auto add = [&bytes](std::uint32_t lead, std::uint32_t code, int further) {
      bytes += static_cast<char>(lead | (code >> static_cast<unsigned>(6 * further)));
      while (further-- > 0) {
        bytes += static_cast<char>(0x80U | ((code >> static_cast<unsigned>(6 * further)) & 0x3fU));
      }
    };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint32_t unit = text[i];
    const bool is_pair = unit >= 0xd800 && unit < 0xdc00 && i + 1 < text.size() &&
      text[i + 1] >= 0xdc00 && text[i + 1] < 0xe000;
    if (unit < 0x80) {
      add(0, unit, 0);
    } else if (unit < 0x800) {
      add(0xc0, unit, 1);
    } else if (is_pair) {
      ++i;
      add(0xf0, 0x10000U + ((unit - 0xd800U) << 10U) + (text[i] - 0xdc00U), 3);
    } else if (unit >= 0xd800 && unit < 0xe000) {
      bytes += '?';
    } else {
      add(0xe0, unit, 2);
    }
  }
  return bytes;
}

std::string joined(const std::vector<std::string> & texts, const std::string & separator)
{
  std::string all;
  for (const std::string & text : texts) {
    all += all.empty() ? text : separator + text;
  }
  return all;
}

std::string error_text(int number)
{
  return std::generic_category().message(number);
}

}  // namespace deros_runtime_cpp
