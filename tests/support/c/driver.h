/*
 * What drives generated monitors in tests: calls come in as 64-bit words, answers go out as such.
 */
#ifndef DRIVER_H_
#define DRIVER_H_

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct
{
  const int64_t *next;
  const int64_t *end;
} words;

typedef struct
{
  int64_t *next;
  int64_t *end;
} answer;

static int64_t word(words *in)
{
  if (in->next == in->end) {
    abort();
  }
  return *in->next++;
}

static double real(words *in)
{
  const int64_t bits = word(in);
  double value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

static void put(answer *out, int64_t value)
{
  if (out->next == out->end) {
    abort();
  }
  *out->next++ = value;
}

static void put_real(answer *out, double value)
{
  int64_t bits;
  memcpy(&bits, &value, sizeof bits);
  put(out, bits);
}

static void put_text(answer *out, const char *text)
{
  const size_t length = strlen(text);
  put(out, (int64_t)length);
  for (size_t i = 0; i < length; ++i) {
    put(out, (unsigned char)text[i]);
  }
}

/* Memory of exactly so many elements, so that a sanitizer sees whoever reads beyond. */
static void *exactly(size_t count, size_t size)
{
  void *memory = malloc(count * size);
  if (memory == NULL && count * size != 0) {
    abort();
  }
  return memory;
}

#endif
