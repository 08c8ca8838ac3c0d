/* Times monitors: driver MESSAGES REPEAT NANOSECONDS, or driver MESSAGES for the events alone.
 *
 * All take the same messages, in turns, from the start of the drive; a turn is as many drives as
 * fit into NANOSECONDS, one at least. Prints a line for each turn: the name, the processor time of
 * a message in nanoseconds, and the size of the monitor. Without REPEAT it prints a line for each
 * event instead: the name, the time, the kind, the action, the behaviour.
 */

#define _POSIX_C_SOURCE 199309L

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "contenders.h"

static const char *telling; /* whose events are printed */
static uint64_t events;

void happened(int64_t t, int kind, int action, int behaviour)
{
  events++;
  if (telling != NULL) {
    printf("%s\t%" PRId64 "\t%d\t%d\t%d\n", telling, t, kind, action, behaviour);
  }
}

static int64_t processor_time(void)
{
  struct timespec now;
  if (clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now) != 0) {
    perror("clock_gettime");
    exit(1);
  }
  return (int64_t)now.tv_sec * INT64_C(1000000000) + now.tv_nsec;
}

static message *read_drive(const char *path, size_t *count)
{
  FILE *file = fopen(path, "rb");
  message *drive = NULL;
  long size;
  if (file == NULL || fseek(file, 0, SEEK_END) != 0 || (size = ftell(file)) <= 0) {
    perror(path);
    exit(1);
  }
  rewind(file);
  *count = (size_t)size / sizeof(message);
  drive = malloc((size_t)size);
  if (drive == NULL || fread(drive, sizeof(message), *count, file) != *count) {
    perror(path);
    exit(1);
  }
  fclose(file);
  return drive;
}

static void pass(const contender *each, const message *drive, size_t count)
{
  void (*const take)(const message *) = each->take;
  each->start();
  for (size_t i = 0; i < count; i++) {
    take(&drive[i]);
  }
}

/* Returns the nanoseconds of a message. */
static double turn(const contender *each, const message *drive, size_t count, int64_t least)
{
  const int64_t start = processor_time();
  int64_t taken;
  size_t passes = 0;
  do {
    pass(each, drive, count);
    passes++;
    taken = processor_time() - start;
  } while (taken < least);
  return (double)taken / (double)passes / (double)count;
}

int main(int argc, char **argv)
{
  if (argc != 2 && argc != 4) {
    fprintf(stderr, "usage: driver MESSAGES [REPEAT NANOSECONDS]\n");
    return 2;
  }
  size_t count;
  message *const drive = read_drive(argv[1], &count);
  const long repeat = argc == 4 ? strtol(argv[2], NULL, 10) : 0;
  for (size_t i = 0; i < contender_count; i++) { /* the first pass warms all up */
    telling = repeat ? NULL : contenders[i].name;
    pass(&contenders[i], drive, count);
  }
  for (long round = 0; round < repeat; round++) {
    for (size_t i = 0; i < contender_count; i++) {
      const contender *each = &contenders[i];
      const double cost = turn(each, drive, count, strtoll(argv[3], NULL, 10));
      printf("%s\t%.4f\t%zu\n", each->name, cost, each->size);
    }
  }
  free(drive);
  return 0;
}
