#include "nothing.h"

void nothing_vector(void *m, int64_t t, double x, double y, double z, double w)
{
  (void)m;
  (void)t;
  (void)x;
  (void)y;
  (void)z;
  (void)w;
}

void nothing_number(void *m, int64_t t, double value)
{
  (void)m;
  (void)t;
  (void)value;
}

void nothing_integer(void *m, int64_t t, int64_t value)
{
  (void)m;
  (void)t;
  (void)value;
}
