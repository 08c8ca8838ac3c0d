// Fills the disk of one process, by LD_PRELOAD: while the file named by DISK_FULL exists, nothing
// can be written to files in the folder named by DISK, and nothing can be made there. What a full
// disk still lets one do, it lets one do: read, truncate, rename, remove. Streams of the C library
// (fopen) are not covered: their calls do not leave it.
//
// What is replaced here may be called by signal handlers, on alternate stacks of a few kilobytes:
// everything is looked up by the constructor, the kernel is called directly, the stack is used by
// the hundred bytes, nothing is shared between calls, and a call that succeeds leaves errno alone.

#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#define LONGEST_FOLDER 500  // bytes of the folder's name, as they have to fit on the stack
#define PROCESS_FILES "/proc/self/fd/"

_Static_assert(sizeof(long) == 8, "offsets are handed to the kernel in one word");

static char folder[PATH_MAX], flag[PATH_MAX];
static size_t folder_length;

__attribute__((constructor)) static void set_up(void) {
  const char *disk = getenv("DISK"), *full = getenv("DISK_FULL");
  if (!disk || !full) return;
  if (!realpath(disk, folder) || strlen(folder) > LONGEST_FOLDER || strlen(full) >= sizeof flag)
    abort();
  strcpy(flag, full);
  folder_length = strlen(folder);
}

// Whether a path, of which the beginning is enough, names the folder or something in it.
static int is_below(const char *path) {
  return strncmp(path, folder, folder_length) == 0 &&
         (path[folder_length] == 0 || path[folder_length] == '/');
}

static int link_is_below(const char *link) {
  char path[LONGEST_FOLDER + 2];  // the folder's name and what follows it: a slash, or nothing
  long length = syscall(SYS_readlinkat, AT_FDCWD, link, path, folder_length + 1);
  if (length < (long)folder_length) return 0;
  path[length] = 0;
  return is_below(path);
}

static int is_open_below(int file) {
  char link[sizeof PROCESS_FILES + 12] = PROCESS_FILES, digits[12];
  size_t count = 0, end = sizeof PROCESS_FILES - 1;
  if (file < 0) return 0;
  do digits[count++] = (char)('0' + file % 10);
  while (file /= 10);
  while (count) link[end++] = digits[--count];
  link[end] = 0;
  return link_is_below(link);
}

static int has_no_space(void) {
  return folder_length && syscall(SYS_faccessat, AT_FDCWD, flag, F_OK) == 0;
}

static int refuses_writing(int file) {
  int before = errno, refused = 0;
  struct stat status;
  if (folder_length && fstat(file, &status) == 0 && S_ISREG(status.st_mode))
    refused = has_no_space() && is_open_below(file);
  errno = refused ? ENOSPC : before;
  return refused;
}

static int refuses_making(int base, const char *path) {
  int before = errno, refused = 0;
  if (has_no_space() && syscall(SYS_faccessat, base, path, F_OK) != 0)
    refused = path[0] == '/'      ? is_below(path)
              : base == AT_FDCWD ? link_is_below("/proc/self/cwd")
                                  : is_open_below(base);
  errno = refused ? ENOSPC : before;
  return refused;
}

ssize_t write(int file, const void *data, size_t size) {
  return size && refuses_writing(file) ? -1 : syscall(SYS_write, file, data, size);
}

ssize_t pwrite64(int file, const void *data, size_t size, off64_t at) {
  return size && refuses_writing(file) ? -1 : syscall(SYS_pwrite64, file, data, size, at);
}

ssize_t writev(int file, const struct iovec *data, int count) {
  return refuses_writing(file) ? -1 : syscall(SYS_writev, file, data, count);
}

ssize_t pwritev64(int file, const struct iovec *data, int count, off64_t at) {
  return refuses_writing(file) ? -1 : syscall(SYS_pwritev, file, data, count, at, 0L);
}

static int open_below(int base, const char *path, int flags, mode_t mode) {
  if (flags & O_CREAT && refuses_making(base, path)) return -1;
  return (int)syscall(SYS_openat, base, path, flags, mode);
}

// The mode is an argument only where something may be made.
#define MODE_AFTER(last)                                                   \
  mode_t mode = 0;                                                         \
  if (flags & O_CREAT || (flags & O_TMPFILE) == O_TMPFILE) {               \
    va_list rest;                                                          \
    va_start(rest, last);                                                  \
    mode = va_arg(rest, mode_t);                                           \
    va_end(rest);                                                          \
  }

int open64(const char *path, int flags, ...) {
  MODE_AFTER(flags)
  return open_below(AT_FDCWD, path, flags, mode);
}

int openat64(int base, const char *path, int flags, ...) {
  MODE_AFTER(flags)
  return open_below(base, path, flags, mode);
}

int creat64(const char *path, mode_t mode) {
  return open_below(AT_FDCWD, path, O_CREAT | O_WRONLY | O_TRUNC, mode);
}

int mkdirat(int base, const char *path, mode_t mode) {
  return refuses_making(base, path) ? -1 : (int)syscall(SYS_mkdirat, base, path, mode);
}

int mkdir(const char *path, mode_t mode) { return mkdirat(AT_FDCWD, path, mode); }

// With offsets of 64 bits the other names are the same.
extern __typeof(pwrite64) pwrite __attribute__((alias("pwrite64")));
extern __typeof(pwritev64) pwritev __attribute__((alias("pwritev64")));
extern __typeof(open64) open __attribute__((alias("open64")));
extern __typeof(openat64) openat __attribute__((alias("openat64")));
extern __typeof(creat64) creat __attribute__((alias("creat64")));
