// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/regular_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

namespace deros_runtime_cpp
{

namespace
{

constexpr mode_t OWN = 0600;

const char * kind_of(mode_t mode)
{
  switch (mode & S_IFMT) {
    case S_IFLNK:
      return "symbolic link";
    case S_IFDIR:
      return "directory";
    case S_IFIFO:
      return "pipe";
    case S_IFSOCK:
      return "socket";
    case S_IFCHR:
    case S_IFBLK:
      return "device";
    default:
      return "special file";
  }
}

void check(const struct stat & found)
{
  if (!S_ISREG(found.st_mode)) {
    throw FileError(std::string("it is a ") + kind_of(found.st_mode) + ", not a regular file");
  }
}

}  // namespace

Descriptor open_regular(const std::filesystem::path & path, int flags)
{
  check_replaceable(path);
  const int safe = O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
  Descriptor file(::open(path.c_str(), flags | safe, OWN));
  struct stat found{};
  if (!file && errno == ENOENT) {
    return file;
  }
  if (!file || ::fstat(file.get(), &found) != 0) {
    throw std::system_error(errno, std::generic_category());
  }
  check(found);  // it may have been replaced after the first check
  return file;
}

void check_replaceable(const std::filesystem::path & path)
{
  struct stat found{};
  if (::lstat(path.c_str(), &found) == 0) {
    check(found);
  } else if (errno != ENOENT) {
    throw std::system_error(errno, std::generic_category());
  }
}

bool is_same(const std::filesystem::path & path, const Descriptor & file)
{
  struct stat named{};
  struct stat opened{};
  return ::lstat(path.c_str(), &named) == 0 && ::fstat(file.get(), &opened) == 0 &&
         named.st_dev == opened.st_dev && named.st_ino == opened.st_ino;
}

}  // namespace deros_runtime_cpp
