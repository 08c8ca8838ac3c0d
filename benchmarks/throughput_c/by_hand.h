/* The monitor of the robot's fourteen rules as an engineer writes it by hand: see by_hand.c. */

#ifndef BY_HAND_H_
#define BY_HAND_H_

#include <stdbool.h>
#include <stdint.h>

typedef enum { TRIGGER, RESET, REFUSED, CLOCK_STEP } by_hand_kind;

/* In the order in which the rules name them. */
typedef enum { LOW_SPEED, STOP, MOTOR_STOP, CONTROLLER_OK, NO_ACTION } by_hand_action;

typedef enum {
  TOO_FAST,
  MUCH_TOO_FAST,
  FAST_BY_HAND,
  TILTED,
  WARN,
  HOLD,
  AVOID,
  BUTTON,
  BUMPED,
  ARM_HIT,
  LEFT_RUNNING,
  LOST,
  MANUAL,
  NO_BEHAVIOUR
} by_hand_behaviour;

typedef enum { UNKNOWN_MOTION, STANDING, MOVING } by_hand_motion;

/* Times are in nanoseconds; what is due at no time is due at INT64_MAX. */
typedef struct {
  int64_t now;
  int64_t due; /* when something may be due at the earliest */
  int64_t imu_at, speed_at, front_at, mode_at, button_at, bumper_at, arm_at;
  int64_t tilt_due, speed_due, reverse_due, left_due;
  uint32_t holds; /* a bit for each behaviour */
  by_hand_motion motion;
  bool imu_gone, speed_gone, front_gone, mode_gone, button_gone, bumper_gone, arm_gone;
  bool tilted, roll_over, far, close, near, button, bumper, arm, manual, automatic;
  bool too_fast, dangerous;
  bool low_speed_on, stop_on, motor_stop_on;
} by_hand;

/* Written by the owner. */
void by_hand_emit(
  int64_t t, by_hand_kind kind, by_hand_action action, by_hand_behaviour behaviour);

void by_hand_start(by_hand *m, int64_t t);
void by_hand_imu(by_hand *m, int64_t t, double x, double y, double z, double w);
void by_hand_odometry(by_hand *m, int64_t t, double speed);
void by_hand_front(by_hand *m, int64_t t, double distance);
void by_hand_mode(by_hand *m, int64_t t, int64_t mode);
void by_hand_stop_button(by_hand *m, int64_t t, bool pressed);
void by_hand_bumper(by_hand *m, int64_t t, bool pressed);
void by_hand_arm(by_hand *m, int64_t t, bool pressed);

#endif
