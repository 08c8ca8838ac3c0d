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

/// What is wrong with a file, beyond what the system knows.
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

/// Open a regular file; this never waits, and nothing is returned if there is no such file.
/**
 * Anything else is not even opened, for that alone can start what a device stands for.
 * \throw std::system_error if that is impossible
 */
Descriptor open_regular(const std::filesystem::path & path, int flags);

/// Check that there is a regular file, or nothing. \throw std::system_error
void check_replaceable(const std::filesystem::path & path);

/// Tell whether the name still stands for an open file.
bool is_same(const std::filesystem::path & path, const Descriptor & file);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__REGULAR_FILE_HPP_
