/* The monitors that are measured, each behind the same few lines; see contenders.c.j2. */

#ifndef CONTENDERS_H_
#define CONTENDERS_H_

#include <stddef.h>
#include <stdint.h>

/* The topics of the drive, in the order of support/throughput_rules.py. */
typedef enum { IMU, ODOMETRY, FRONT, MODE, STOP_BUTTON, BUMPER, ARM } topic;

/* A message of the drive, as it stands in the file. */
typedef struct {
  int64_t t;
  int64_t topic;
  double values[4];
} message;

typedef struct {
  const char *name;
  size_t size; /* of the monitor, in bytes */
  void (*start)(void);
  void (*take)(const message *each);
} contender;

extern const contender contenders[];
extern const size_t contender_count;

/* Takes an event: of which kind, which action, which behaviour, each as its enumeration counts. */
void happened(int64_t t, int kind, int action, int behaviour);

#endif
