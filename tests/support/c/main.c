/*
 * Runs the monitors of a library for a test that writes calls to stdin and reads answers on stdout:
 * a program of its own, so that a sanitizer can watch it.
 *
 * A request is the number of the monitor, the count of its words, and these; a negative number
 * forgets the monitor. An answer is a count and as many words.
 */
#include <stdio.h>

#include "driver.h"

size_t driver_size(int64_t number);
size_t driver_step(
  int64_t number, void *monitor, void *owner, const int64_t *in, size_t count, int64_t *out,
  size_t capacity);

int main(void)
{
  static int64_t out[1 << 16];
  int64_t head[2];
  void *monitor = NULL;
  void *owner = NULL;
  while (fread(head, sizeof head, 1, stdin) == 1) {
    if (head[0] < 0) {
      free(monitor);
      monitor = NULL;
      continue;
    }
    if (monitor == NULL) {
      monitor = exactly(1, driver_size(head[0]));
    }
    int64_t *in = exactly((size_t)head[1], sizeof *in);
    if (fread(in, sizeof *in, (size_t)head[1], stdin) != (size_t)head[1]) {
      return 1;
    }
    const int64_t count = (int64_t)driver_step(
      head[0], monitor, &owner, in, (size_t)head[1], out, sizeof out / sizeof *out);
    free(in);
    fwrite(&count, sizeof count, 1, stdout);
    fwrite(out, sizeof *out, (size_t)count, stdout);
    fflush(stdout);
  }
  free(monitor);
  return 0;
}
