/* What an engineer writes by hand in C for the robot of support/throughput_rules.py, for speed.
 *
 * Straight-line code, one function per topic, nothing general: the generated monitor is measured
 * against it. It does the same job, with the same events: it heeds NaN, edges, intervals, timeouts,
 * late timers and backward clocks. It keeps no record of when a rule turned, as nobody asked for it.
 */

#include "by_hand.h"

#include <math.h>

#define NEVER INT64_MAX
#define SECOND INT64_C(1000000000)
#define TIMEOUT INT64_C(500000000)
#define BIT(behaviour) (UINT32_C(1) << (behaviour))

#define LOW_SPEED_CALLS (BIT(TOO_FAST) | BIT(FAST_BY_HAND) | BIT(WARN))
#define STOP_CALLS                                                                             \
  (BIT(MUCH_TOO_FAST) | BIT(TILTED) | BIT(HOLD) | BIT(AVOID) | BIT(BUTTON) | BIT(BUMPED) |     \
    BIT(ARM_HIT) | BIT(LOST))

static void act(by_hand *m, int64_t t);
static void catch_up(by_hand *m, int64_t t);

static inline void arrive(by_hand *m, int64_t t)
{
  if (t < m->now || t >= m->due) {
    catch_up(m, t);
  }
  m->now = t;
}

static inline void at_latest(by_hand *m, int64_t due)
{
  if (due < m->due) {
    m->due = due;
  }
}

/* An input has come: its timeout begins anew. */
static inline void heard(by_hand *m, int64_t t, int64_t *at, bool *gone)
{
  *at = t;
  if (*gone) {
    *gone = false;
    at_latest(m, t + TIMEOUT);
  }
}

/* What lasts too long is due at *due. */
static inline void lasts(by_hand *m, bool holds, int64_t end, int64_t *due)
{
  if (!holds) {
    *due = NEVER;
  } else if (*due == NEVER) {
    *due = end;
    at_latest(m, end);
  }
}

/* Knows nothing, as at the start and after a backward step of the clock. */
static void forget(by_hand *m, int64_t t)
{
  m->imu_at = m->speed_at = m->front_at = m->mode_at = t;
  m->button_at = m->bumper_at = m->arm_at = t;
  m->imu_gone = m->speed_gone = m->front_gone = m->mode_gone = false;
  m->button_gone = m->bumper_gone = m->arm_gone = false;
  m->tilt_due = m->speed_due = m->reverse_due = m->left_due = NEVER;
  m->tilted = m->roll_over = m->far = m->close = m->near = false;
  m->button = m->bumper = m->arm = m->manual = m->automatic = false;
  m->too_fast = m->dangerous = false;
  m->motion = UNKNOWN_MOTION;
  m->due = t + TIMEOUT;
}

void by_hand_start(by_hand *m, int64_t t)
{
  m->now = t;
  m->holds = 0;
  m->low_speed_on = m->stop_on = m->motor_stop_on = false;
  forget(m, t);
}

/* Messages */

void by_hand_imu(by_hand *m, int64_t t, double x, double y, double z, double w)
{
  bool tilted = false;
  bool roll_over = false;
  const double square = x * x + y * y + z * z + w * w;
  arrive(m, t);
  if (!isnan(square)) { /* nor is any of the four */
    heard(m, t, &m->imu_at, &m->imu_gone);
    const double length = sqrt(square);
    if (length > 0.0 && length < (double)INFINITY) {
      x /= length;
      y /= length;
      z /= length;
      w /= length;
      const double roll = atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y));
      const double sine = 2.0 * (w * y - z * x);
      const double pitch = asin(sine < -1.0 ? -1.0 : sine > 1.0 ? 1.0 : sine);
      tilted = fabs(roll) > 0.139626 || fabs(pitch) > 0.139626;
      roll_over = fabs(roll) > 0.174533 || fabs(pitch) > 0.174533;
    }
  }
  lasts(m, tilted, t + 4 * SECOND, &m->tilt_due);
  tilted = t >= m->tilt_due;
  if (tilted != m->tilted || roll_over != m->roll_over) {
    m->tilted = tilted;
    m->roll_over = roll_over;
    act(m, t);
  }
}

void by_hand_odometry(by_hand *m, int64_t t, double speed)
{
  by_hand_motion motion = UNKNOWN_MOTION;
  bool was_gone;
  arrive(m, t);
  was_gone = m->speed_gone;
  if (!isnan(speed)) {
    heard(m, t, &m->speed_at, &m->speed_gone);
    motion = fabs(speed) > 0.05 ? MOVING : STANDING;
  }
  lasts(m, speed > 0.5, t + 4 * SECOND, &m->speed_due);
  lasts(m, speed < -0.25, t + 2 * SECOND, &m->reverse_due);
  const bool too_fast = t >= m->speed_due || t >= m->reverse_due;
  const bool dangerous = speed > 1.0 || speed < -0.4;
  if (motion != m->motion || too_fast != m->too_fast || dangerous != m->dangerous ||
      was_gone != m->speed_gone) {
    m->motion = motion;
    m->too_fast = too_fast;
    m->dangerous = dangerous;
    act(m, t);
  }
}

void by_hand_front(by_hand *m, int64_t t, double distance)
{
  const bool far = distance >= 2.0 && distance < 4.0;
  const bool close = distance >= 0.8 && distance < 2.0;
  const bool near = distance < 0.8;
  arrive(m, t);
  if (!isnan(distance)) {
    heard(m, t, &m->front_at, &m->front_gone);
  }
  if (far != m->far || close != m->close || near != m->near) {
    m->far = far;
    m->close = close;
    m->near = near;
    act(m, t);
  }
}

void by_hand_mode(by_hand *m, int64_t t, int64_t mode)
{
  const bool manual = mode == 0;
  const bool automatic = mode == 2;
  arrive(m, t);
  heard(m, t, &m->mode_at, &m->mode_gone);
  if (manual != m->manual || automatic != m->automatic) {
    m->manual = manual;
    m->automatic = automatic;
    act(m, t);
  }
}

void by_hand_stop_button(by_hand *m, int64_t t, bool pressed)
{
  arrive(m, t);
  heard(m, t, &m->button_at, &m->button_gone);
  if (pressed != m->button) {
    m->button = pressed;
    act(m, t);
  }
}

void by_hand_bumper(by_hand *m, int64_t t, bool pressed)
{
  arrive(m, t);
  heard(m, t, &m->bumper_at, &m->bumper_gone);
  if (pressed != m->bumper) {
    m->bumper = pressed;
    act(m, t);
  }
}

void by_hand_arm(by_hand *m, int64_t t, bool pressed)
{
  arrive(m, t);
  heard(m, t, &m->arm_at, &m->arm_gone);
  if (pressed != m->arm) {
    m->arm = pressed;
    act(m, t);
  }
}

/* Behaviours */

static void low_speed(by_hand *m, int64_t t, by_hand_behaviour behaviour)
{
  m->low_speed_on = true;
  by_hand_emit(t, TRIGGER, LOW_SPEED, behaviour);
}

static void stop(by_hand *m, int64_t t, by_hand_behaviour behaviour)
{
  m->stop_on = true;
  by_hand_emit(t, TRIGGER, STOP, behaviour);
}

static void motor_stop(by_hand *m, int64_t t, by_hand_behaviour behaviour)
{
  m->motor_stop_on = true;
  by_hand_emit(t, TRIGGER, MOTOR_STOP, behaviour);
}

/* Does what the behaviours ask for that hold now and did not before. */
static void do_actions(by_hand *m, int64_t t, uint32_t rise)
{
  if (rise & BIT(TOO_FAST)) {
    low_speed(m, t, TOO_FAST);
  }
  if (rise & BIT(MUCH_TOO_FAST)) {
    motor_stop(m, t, MUCH_TOO_FAST);
    stop(m, t, MUCH_TOO_FAST);
  }
  if (rise & BIT(FAST_BY_HAND)) {
    low_speed(m, t, FAST_BY_HAND);
  }
  if (rise & BIT(TILTED)) {
    motor_stop(m, t, TILTED);
    stop(m, t, TILTED);
  }
  if (rise & BIT(WARN)) {
    low_speed(m, t, WARN);
  }
  if (rise & BIT(HOLD)) {
    stop(m, t, HOLD);
  }
  if (rise & BIT(AVOID)) {
    stop(m, t, AVOID);
  }
  if (rise & BIT(BUTTON)) {
    motor_stop(m, t, BUTTON);
    stop(m, t, BUTTON);
  }
  if (rise & BIT(BUMPED)) {
    motor_stop(m, t, BUMPED);
    stop(m, t, BUMPED);
  }
  if (rise & BIT(ARM_HIT)) {
    motor_stop(m, t, ARM_HIT);
    stop(m, t, ARM_HIT);
  }
  if (rise & BIT(LEFT_RUNNING)) {
    motor_stop(m, t, LEFT_RUNNING);
  }
  if (rise & BIT(LOST)) {
    stop(m, t, LOST);
  }
  if (rise & BIT(MANUAL)) {
    by_hand_emit(t, TRIGGER, CONTROLLER_OK, MANUAL);
    if (m->low_speed_on) {
      m->low_speed_on = (m->holds & LOW_SPEED_CALLS) != 0;
      by_hand_emit(t, m->low_speed_on ? REFUSED : RESET, LOW_SPEED, NO_BEHAVIOUR);
    }
    if (m->stop_on) {
      m->stop_on = (m->holds & STOP_CALLS) != 0;
      by_hand_emit(t, m->stop_on ? REFUSED : RESET, STOP, NO_BEHAVIOUR);
    }
  }
}

static inline uint32_t bit_if(bool holds, by_hand_behaviour behaviour)
{
  return (uint32_t)holds << behaviour;
}

/* Judges the behaviours. */
static void act(by_hand *m, int64_t t)
{
  const bool automatic = m->automatic;
  const bool driving = m->motion == MOVING && automatic;
  const uint32_t was = m->holds;
  lasts(m, m->motion == STANDING && automatic, t + 600 * SECOND, &m->left_due);
  m->holds = bit_if(m->too_fast && automatic, TOO_FAST) |
    bit_if(m->dangerous && automatic, MUCH_TOO_FAST) |
    bit_if(m->dangerous && m->manual, FAST_BY_HAND) |
    bit_if((m->tilted && driving) || m->roll_over, TILTED) | bit_if(m->far && driving, WARN) |
    bit_if(m->close && automatic, HOLD) | bit_if(m->near, AVOID) | bit_if(m->button, BUTTON) |
    bit_if(m->bumper && automatic, BUMPED) | bit_if(m->arm && automatic, ARM_HIT) |
    bit_if(t >= m->left_due, LEFT_RUNNING) | bit_if(m->speed_gone, LOST) |
    bit_if(m->manual, MANUAL);
  if (m->holds & ~was) {
    do_actions(m, t, m->holds & ~was);
  }
}

/* Time */

static int64_t earlier(int64_t a, int64_t b)
{
  return a < b ? a : b;
}

/* The next deadline; of an interval, the first time only. */
static int64_t earliest(const by_hand *m)
{
  const int64_t ends[] = {m->tilt_due, m->speed_due, m->reverse_due, m->left_due};
  int64_t due = m->imu_gone ? NEVER : m->imu_at + TIMEOUT;
  due = m->speed_gone ? due : earlier(due, m->speed_at + TIMEOUT);
  due = m->front_gone ? due : earlier(due, m->front_at + TIMEOUT);
  due = m->mode_gone ? due : earlier(due, m->mode_at + TIMEOUT);
  due = m->button_gone ? due : earlier(due, m->button_at + TIMEOUT);
  due = m->bumper_gone ? due : earlier(due, m->bumper_at + TIMEOUT);
  due = m->arm_gone ? due : earlier(due, m->arm_at + TIMEOUT);
  for (int i = 0; i < 4; i++) {
    due = ends[i] > m->now ? earlier(due, ends[i]) : due;
  }
  return due;
}

static bool expires(int64_t at, int64_t due, bool *gone)
{
  const bool expired = at + TIMEOUT <= due && !*gone;
  *gone = *gone || expired;
  return expired;
}

static void settle(by_hand *m, int64_t due)
{
  m->now = due;
  if (expires(m->imu_at, due, &m->imu_gone)) {
    m->roll_over = false;
    m->tilt_due = NEVER;
  }
  if (expires(m->speed_at, due, &m->speed_gone)) {
    m->motion = UNKNOWN_MOTION;
    m->dangerous = false;
    m->speed_due = m->reverse_due = NEVER;
  }
  if (expires(m->front_at, due, &m->front_gone)) {
    m->far = m->close = m->near = false;
  }
  if (expires(m->mode_at, due, &m->mode_gone)) {
    m->manual = m->automatic = false;
  }
  if (expires(m->button_at, due, &m->button_gone)) {
    m->button = false;
  }
  if (expires(m->bumper_at, due, &m->bumper_gone)) {
    m->bumper = false;
  }
  if (expires(m->arm_at, due, &m->arm_gone)) {
    m->arm = false;
  }
  m->tilted = due >= m->tilt_due;
  m->too_fast = due >= m->speed_due || due >= m->reverse_due;
  act(m, due);
}

/* Settles a backward step of the clock, then what is due up to t. */
static void catch_up(by_hand *m, int64_t t)
{
  int64_t due;
  if (t < m->now) {
    m->now = t;
    forget(m, t);
    by_hand_emit(t, CLOCK_STEP, NO_ACTION, NO_BEHAVIOUR);
    act(m, t);
  }
  while ((due = earliest(m)) <= t) {
    settle(m, due);
  }
  m->due = due;
}
