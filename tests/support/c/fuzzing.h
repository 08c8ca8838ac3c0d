/*
 * What turns bytes into the arguments of a monitor's functions: any bits for numbers and times.
 */
#ifndef FUZZING_H_
#define FUZZING_H_

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct
{
  const uint8_t *next;
  const uint8_t *end;
} input_bytes;

/* Takes bytes; where none are left, zeros. */
static void take(input_bytes *in, void *to, size_t size)
{
  const size_t left = (size_t)(in->end - in->next);
  const size_t taken = (size < left) ? size : left;
  memset(to, 0, size);
  memcpy(to, in->next, taken);
  in->next += taken;
}

static uint8_t take_byte(input_bytes *in)
{
  uint8_t value;
  take(in, &value, sizeof value);
  return value;
}

static int64_t take_word(input_bytes *in)
{
  int64_t value;
  take(in, &value, sizeof value);
  return value;
}

static double take_real(input_bytes *in)
{
  double value;
  take(in, &value, sizeof value);
  return value;
}

/* A time: any at all, or one near another, because little happens at the ends of time. */
static int64_t take_time(input_bytes *in, int64_t near)
{
  static const int64_t scales[] = {0, 1, 1000, 1000000, 10000000, 100000000, 1000000000};
  const uint8_t choice = take_byte(in);
  if (choice % 8U == 7U) {
    return take_word(in);
  }
  const int8_t steps = (int8_t)take_byte(in);
  const int64_t step = ((choice & 8U) != 0U) ? steps : (steps < 0 ? -(int64_t)steps : steps);
  return near + (step * scales[choice % 8U]);
}

/* Memory of exactly so many bytes, so that a sanitizer sees whoever reads beyond. */
static void *take_memory(input_bytes *in, size_t size)
{
  void *memory = malloc(size);
  if (memory == NULL && size != 0U) {
    abort();
  }
  if (size != 0U) {
    take(in, memory, size);
  }
  return memory;
}

#define HOLDS(condition) \
  do { \
    if (!(condition)) { \
      fprintf(stderr, "does not hold: %s\n", #condition); \
      abort(); \
    } \
  } while (0)

#endif
