// Fills the disk of one process, by LD_PRELOAD: while the file named by DISK_FULL exists, nothing
// can be written to files in the folder named by DISK, and none can be made there. What a full disk
// still lets one do, it lets one do: read, truncate, rename, remove.

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

static int is_below(const char *path) {
  const char *folder = getenv("DISK"), *flag = getenv("DISK_FULL");
  return folder && flag && strncmp(path, folder, strlen(folder)) == 0 && access(flag, F_OK) == 0;
}

static int is_full(int file) {
  char link[64], path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  ssize_t length = readlink(link, path, sizeof path - 1);
  if (length <= 0) return 0;
  path[length] = 0;
  return is_below(path);
}

static int refused(void) {
  errno = ENOSPC;
  return -1;
}

ssize_t write(int file, const void *data, size_t size) {
  static ssize_t (*real)(int, const void *, size_t);
  if (!real) real = dlsym(RTLD_NEXT, "write");
  return size && is_full(file) ? refused() : real(file, data, size);
}

ssize_t pwrite64(int file, const void *data, size_t size, off64_t at) {
  static ssize_t (*real)(int, const void *, size_t, off64_t);
  if (!real) real = dlsym(RTLD_NEXT, "pwrite64");
  return size && is_full(file) ? refused() : real(file, data, size, at);
}

ssize_t writev(int file, const struct iovec *data, int count) {
  static ssize_t (*real)(int, const struct iovec *, int);
  if (!real) real = dlsym(RTLD_NEXT, "writev");
  return is_full(file) ? refused() : real(file, data, count);
}

int open64(const char *path, int flags, ...) {
  static int (*real)(const char *, int, ...);
  if (!real) real = dlsym(RTLD_NEXT, "open64");
  va_list rest;
  va_start(rest, flags);
  mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  if (flags & O_CREAT && access(path, F_OK) != 0 && is_below(path)) return refused();
  return real(path, flags, mode);
}
