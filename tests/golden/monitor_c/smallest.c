/*
 * The monitor of small; see the header for how to use it.
 *
 * It follows MISRA C:2012 but for these advisory guidelines:
 * - Directive 4.6: messages consist of char, float and double
 * - Rule 2.3: the type that checks the monitor's size has no other use
 * - Rule 5.9: monitors that are linked together have static functions of the same names
 */
#include "small_monitor.h"

#ifdef __FAST_MATH__
#error "-ffast-math gives rules another meaning"
#endif

/* Does not compile if a monitor takes more memory than the header says. */
typedef char small_fits[
    (sizeof(small_monitor) <= SMALL_MEMORY) ? 1 : -1];

#ifdef __FRAMAC__
#include "small_contracts.h"
#endif

static int64_t earlier(int64_t a, int64_t b)
{
  return (a < b) ? a : b;
}

/* A time within the range that the monitor counts in. */
static int64_t bounded(int64_t t)
{
  return (t < 0) ? 0 : earlier(t, SMALL_LATEST);
}

/* Stores a value; returns whether it has changed, or another one had. */
static bool store_truth(bool *place, bool value, bool news)
{
  const bool other = (*place != value);
  *place = value;
  return news || other;
}

/* The verdict of a condition, which is unknown unless its values are known. */
static small_verdict truth_of(bool known, bool holds)
{
  const small_verdict verdict = holds ? SMALL_TRUE : SMALL_FALSE;
  return known ? verdict : SMALL_UNKNOWN;
}

/* Stores a rule's verdict; returns whether it has changed. */
static bool turned(small_verdict verdict, small_verdict *held, int64_t *since, int64_t now)
{
  const bool changed = (verdict != *held);
  if (changed && ((verdict == SMALL_TRUE) || (*held == SMALL_TRUE))) {
    *since = now;
  }
  *held = verdict;
  return changed;
}

const small_site small_sites[SMALL_SITE_COUNT] = {
  {SMALL_ACTION_STOP, SMALL_BEHAVIOUR_BEHAVIOUR_1, 2U}
};

/* Makes the values of input v unknown; returns whether they were known. */
static bool forget_v(small_monitor *m)
{
  bool news = false;
  news = store_truth(&m->v_known, false, news);
  return news;
}

/* The earliest deadline ahead. */
static int64_t earliest(const small_monitor *m)
{
  int64_t due = SMALL_NEVER;
  (void)m;
  return due;
}

/* Rule e.r (small.deros:2)
 *   r: v;
 */
static bool judge_e_r(small_monitor *m)
{
  const small_verdict verdict = truth_of(m->v_known, m->v);
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}

/* Behaviour behaviour_1 (small.deros:2)
 *   if e.r then { stop; };
 */
static void behave_behaviour_1(small_monitor *m)
{
  const small_verdict condition = m->e_r;
  const bool held = (m->behaviour_1_condition == SMALL_TRUE);
  const bool rises = (condition == SMALL_TRUE) && (!held);
  m->behaviour_1_condition = condition;
  if (rises) {
    small_emit(m->owner, m->now, SMALL_TRIGGER, 0U);  /* stop */
  }
}

/* Runs the behaviours whose conditions turned true, then the resets that they request. */
static void act(small_monitor *m, bool changed)
{
  if (changed) {
    behave_behaviour_1(m);
  }
}

/* Evaluates all rules. */
static void judge_all(small_monitor *m)
{
  (void)judge_e_r(m);
}

/* Processes one event: all rules, then all behaviours. */
static void evaluate(small_monitor *m)
{
  m->started = true;
  judge_all(m);
  act(m, true);
}

/* Forgets all inputs and intervals; timeouts count from the time given. */
static void restart(small_monitor *m, int64_t from)
{
  (void)from;
  m->e_r_turned = m->now;
  (void)forget_v(m);
  m->due = earliest(m);
}

/* Advances to the next deadline, processes all that ends there, and finds the one after it. */
static void reach_deadline(small_monitor *m)
{
  m->now = m->due;
  evaluate(m);
  m->due = earliest(m);
}

/* Processes the deadlines up to t in order. */
static void catch_up(small_monitor *m, int64_t t)
{
  m->due = earliest(m);
  /*@ loop invariant sane(m);
      loop invariant is_end(m, m->due);
      loop invariant m->now <= t;
      loop invariant latched_kept{Pre, Here}(m);
      loop invariant caught_up{Pre, Here}(m);
      loop invariant kept_by_deadlines{Pre, Here}(m);
      loop assigns *m, emitted;
      loop variant t - m->now; */
  while (m->due <= t) {
    reach_deadline(m);
  }
  m->now = t;
}

/* Processes a backward step of the clock, to t. */
static void step_back(small_monitor *m, int64_t t)
{
  m->now = t;
  restart(m, t);
  small_emit(m->owner, t, SMALL_CLOCK_STEP, SMALL_SITE_NONE);
  evaluate(m);
}

/* Advances the time to an instant before the next deadline. */
static void pass(small_monitor *m, int64_t t)
{
  m->now = t;
}

/* Advances the monitor to the time of a call. */
static void arrive(small_monitor *m, int64_t t)
{
  const int64_t now = bounded(t);
  if (now < m->now) {
    step_back(m, now);
  } else if (now >= m->due) {
    catch_up(m, now);
  } else {
    pass(m, now);
  }
}

/* Initialises all fields that a restart does not set. */
static void clear(small_monitor *m, void *owner, int64_t t)
{
  m->owner = owner;
  m->now = bounded(t);
  m->e_r = SMALL_UNKNOWN;
  m->behaviour_1_condition = SMALL_UNKNOWN;
  m->v_known = false;
  m->v = false;
  m->started = false;
}

void small_start(small_monitor *m, void *owner, int64_t t, int64_t grace)
{
  clear(m, owner, t);
  restart(m, bounded(m->now + bounded(grace)));
}

int64_t small_advance(small_monitor *m, int64_t t)
{
  arrive(m, t);
  return m->due;
}

bool small_waiting(const small_monitor *m)
{
  bool waiting = false;
  (void)m;
  return waiting;
}

/* Takes the values of a message of /flag; returns whether one has changed. */
static bool observe_v(small_monitor *m, bool data)
{
  bool news = false;
  /* Input v (small.deros:2)
   *   input v = topic /flag.data
   */
  news = store_truth(&m->v_known, true, news);
  news = store_truth(&m->v, data, news);
  return news;
}

/* Evaluates the rules that a message of /flag can change; all rules at the first event. */
static void after_v(small_monitor *m, bool news)
{
  if (!m->started) {
    evaluate(m);
  } else if (news) {
    act(m, judge_e_r(m));
  } else {
    /* no verdict changes */
  }
}

/* Processes a message of /flag that arrives now. */
static void take_v(small_monitor *m, bool data)
{
  const bool news = observe_v(m, data);
  after_v(m, news);
}

void small_on_v(small_monitor *m, int64_t t, bool data)
{
  arrive(m, t);
  take_v(m, data);
}
