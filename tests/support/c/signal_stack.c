// Calls what the shims replace from a signal handler, on a stack as small as the kernel allows.
//
//     harness PLAIN STORED
//
// PLAIN is a file on a disk with space, STORED one in the folder whose disk may be full. Below the
// stack lies a page that may not be touched: whatever runs over the end dies of SIGSEGV. The output
// tells how each call ended; one that succeeded and changed errno all the same has failed.

#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#define BUDGET 2048     // what POSIX systems had as MINSIGSTKSZ; the kernel's own frame comes on top
#define OLDEST_FRAME 2048
#define UNTOUCHED 4711  // no errno has this number

static const char *new_file;
static int plain, stored, folder, pipe_end;
static volatile int results[16];
static volatile time_t seconds[3];

static int outcome(long result) {
  if (result < 0) return errno;
  return errno == UNTOUCHED ? 0 : -errno;
}

#define RECORD(number, call) (errno = UNTOUCHED, results[number] = outcome(call))

static void handle(int number) {
  (void)number;
  const struct iovec parts[] = {{"x", 1}};
  struct timespec precise;
  struct timeval coarse;
  RECORD(0, write(pipe_end, "x", 1));
  RECORD(1, write(plain, "x", 1));
  RECORD(2, write(stored, "x", 1));
  RECORD(3, pwrite(stored, "x", 1, 0));
  RECORD(4, writev(stored, parts, 1));
  RECORD(5, pwritev(stored, parts, 1, 0));
  RECORD(6, open(new_file, O_WRONLY | O_CREAT | O_EXCL, 0600));
  RECORD(7, openat(folder, "another", O_WRONLY | O_CREAT | O_EXCL, 0600));
  RECORD(8, mkdirat(folder, "directory", 0700));
  RECORD(9, clock_gettime(CLOCK_REALTIME, &precise));
  RECORD(10, gettimeofday(&coarse, NULL));
  RECORD(11, time(NULL));
  seconds[0] = precise.tv_sec;
  seconds[1] = coarse.tv_sec;
  seconds[2] = time(NULL);
}

static void *guarded_stack(size_t size) {
  size_t page = (size_t)sysconf(_SC_PAGESIZE);
  size_t length = (size + page - 1) / page * page;
  char *memory =
      mmap(NULL, page + length, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED || mprotect(memory, page, PROT_NONE) != 0) abort();
  return memory + page;
}

int main(int count, char **words) {
  int ends[2];
  if (count != 4 || pipe(ends) != 0) return 2;
  pipe_end = ends[1];
  plain = open(words[1], O_WRONLY | O_CREAT, 0600);
  stored = open(words[2], O_WRONLY);
  new_file = words[3];
  *strrchr(words[2], '/') = 0;
  folder = open(words[2], O_RDONLY | O_DIRECTORY);
  if (plain < 0 || stored < 0 || folder < 0) return 2;

  size_t frame = getauxval(AT_MINSIGSTKSZ);  // what this processor's registers take; 0 if unknown
  stack_t stack = {.ss_size = (frame > OLDEST_FRAME ? frame : OLDEST_FRAME) + BUDGET};
  stack.ss_sp = guarded_stack(stack.ss_size);
  struct sigaction action = {.sa_handler = handle, .sa_flags = SA_ONSTACK};
  if (sigaltstack(&stack, NULL) != 0 || sigaction(SIGUSR1, &action, NULL) != 0) return 2;
  raise(SIGUSR1);
  for (int i = 0; i <= 11; i++) printf("%d ", results[i]);
  for (int i = 0; i < 3; i++) printf("%ld ", (long)seconds[i]);
  puts("");
  return 0;
}
