/* Functions that do nothing, with the parameters of a monitor: what calling costs. */

#ifndef NOTHING_H_
#define NOTHING_H_

#include <stdint.h>

void nothing_vector(void *m, int64_t t, double x, double y, double z, double w);
void nothing_number(void *m, int64_t t, double value);
void nothing_integer(void *m, int64_t t, int64_t value);

#endif
