// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__REGULAR_FILE_HPP_
#define DEROS_RUNTIME_CPP__REGULAR_FILE_HPP_

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "deros_runtime_cpp/descriptor.hpp"

namespace deros_runtime_cpp
{

/// A fault of a file for which the system has no error number.
class FileError : public std::system_error
{
public:
  explicit FileError(std::string text)
  : std::system_error(EINVAL, std::generic_category()), text_(std::move(text))
  {
  }

  const char * what() const noexcept override
  {
    return text_.c_str();
  }

private:
  std::string text_;
};

/// Open a regular file without blocking; the result is not open if the file does not exist.
/**
 * Nothing else is even opened, because opening a device can have effects.
 * \throw std::system_error on failure, or if it is not a regular file
 */
Descriptor open_regular(const std::filesystem::path & path, int flags);

/// Check that a path leads to a regular file or to nothing. \throw std::system_error
void check_replaceable(const std::filesystem::path & path);

/// Return whether a path leads to an open file.
bool is_same(const std::filesystem::path & path, const Descriptor & file);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__REGULAR_FILE_HPP_
