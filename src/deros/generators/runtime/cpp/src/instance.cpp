// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/instance.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "deros_runtime_cpp/descriptor.hpp"
#include "deros_runtime_cpp/digest.hpp"
#include "deros_runtime_cpp/refusal.hpp"
#include "deros_runtime_cpp/regular_file.hpp"

namespace deros_runtime_cpp
{

namespace
{

constexpr std::size_t LONGEST = 200;  // of a stem; a file name ends at 255 bytes

std::system_error failure(const std::filesystem::path & path)
{
  return {errno, std::generic_category(), path.string()};
}

bool is_writable(const std::filesystem::path & folder)
{
  std::error_code ignored;
  return std::filesystem::is_directory(folder, ignored) &&
         ::access(folder.c_str(), W_OK | X_OK) == 0;
}

std::string holder_of(int lock)
{
  std::array<char, 32> buffer{};
  const ssize_t count = ::pread(lock, buffer.data(), buffer.size(), 0);
  std::string text(buffer.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  text.erase(text.find_last_not_of(" \n") + 1);
  return text.empty() ? "unknown" : text;
}

/// Check that a folder belongs to the user alone, so that no other user can hold its locks.
void check_own(const std::filesystem::path & folder)
{
  struct stat found{};
  if (::lstat(folder.c_str(), &found) != 0) {
    throw failure(folder);
  }
  if (!S_ISDIR(found.st_mode)) {
    throw FileError(folder.string() + " is not a folder");
  }
  if (found.st_uid != ::getuid()) {
    throw FileError(folder.string() + " belongs to another user");
  }
  if ((found.st_mode & (S_IWGRP | S_IWOTH)) != 0) {
    throw FileError("others may write in " + folder.string());
  }
}

std::string without_slashes(const std::string & name)
{
  const std::size_t first = name.find_first_not_of('/');
  if (first == std::string::npos) {
    return "";
  }
  std::string stem = name.substr(first, name.find_last_not_of('/') - first + 1);
  std::replace(stem.begin(), stem.end(), '/', '.');
  return stem;
}

}  // namespace

std::filesystem::path lock_folder()
{
  const std::string own = "deros-" + std::to_string(::getuid());
  for (const char * variable : {"TMPDIR", "TEMP", "TMP"}) {
    const char * folder = std::getenv(variable);
    if (folder != nullptr && *folder != '\0' && is_writable(folder)) {
      return std::filesystem::absolute(folder) / own;
    }
  }
  return std::filesystem::path("/tmp") / own;
}

Descriptor claim(
  const std::string & name, std::size_t domain, const std::filesystem::path & folder)
{
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) {
    throw failure(folder);
  }
  check_own(folder);
  const std::filesystem::path path = folder / (file_stem(name, domain) + ".lock");
  Descriptor lock;
  do {  // again if the file was removed meanwhile: another process may hold a new one
    lock = open_regular(path, O_RDWR | O_CREAT);
    if (!lock) {
      throw failure(path);
    }
    if (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK) {
        throw failure(path);
      }
      throw Refusal(
              name + " runs already in domain " + std::to_string(domain) + ", as process " +
              holder_of(lock.get()) + ": this second one ends now");
    }
  } while (!is_same(path, lock));
  const std::string holder = std::to_string(::getpid()) + '\n';
  if (::ftruncate(lock.get(), 0) != 0 ||
    ::write(lock.get(), holder.data(), holder.size()) != static_cast<ssize_t>(holder.size()))
  {
    throw failure(path);
  }
  return lock;
}

std::string file_stem(const std::string & name, std::size_t domain)
{
  std::string stem = without_slashes(name);
  if (stem.size() > LONGEST) {
    stem = stem.substr(0, LONGEST / 2) + '-' + sha256(stem).substr(0, 16);
  }
  return stem + '.' + std::to_string(domain);
}

}  // namespace deros_runtime_cpp
