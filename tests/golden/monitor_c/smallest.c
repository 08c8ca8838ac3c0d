/*
 * The monitor of small; see the header for how to use it.
 *
 * It follows MISRA C:2012 but for these advisory guidelines:
 * - Directive 4.6: messages consist of char, float and double
 * - Rule 2.3: the type that checks the monitor's size has no other use
 * - Rule 5.9: monitors that are linked together have static functions of the same names
 */
#include "small_monitor.h"

… 5 lines of monitor.c.j2: #ifdef __FAST_MATH__
typedef char small_fits[
    (sizeof(small_monitor) <= SMALL_MEMORY) ? 1 : -1];

#ifdef __FRAMAC__
#include "small_contracts.h"
#endif

… 5 lines of helpers.py: static int64_t earlier(int64_t a, int64_t b)
/* A time within the range that the monitor counts in. */
… 5 lines of helpers.py: static int64_t bounded(int64_t t)
/* Stores a value; returns whether it has changed, or another one had. */
static bool store_truth(bool *place, bool value, bool news)
… 6 lines of helpers.py: {
/* The verdict of a condition, which is unknown unless its values are known. */
… 6 lines of verdicts.py: static small_verdict truth_of(bool known, bool holds)
/* Stores a rule's verdict; returns whether it has changed. */
… 10 lines of verdicts.py: static bool turned(small_verdict verdict, small_verdict *held, int64_t *since, int64_t now)
const small_site small_sites[SMALL_SITE_COUNT] = {
  {SMALL_ACTION_STOP, SMALL_BEHAVIOUR_BEHAVIOUR_1, 2U}
};

/* Makes the values of input v unknown; returns whether they were known. */
static bool forget_v(small_monitor *m)
{
  bool news = false;
  news = store_truth(&m->v_known, false, news);
… 4 lines of body.c.j2: return news;
… 3 lines of body.c.j2: static int64_t earliest(const small_monitor *m)
… 4 lines of body.c.j2: (void)m;
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
… 3 lines of body.c.j2: static void act(small_monitor *m, bool changed)
    behave_behaviour_1(m);
  }
}

/* Evaluates all rules. */
static void judge_all(small_monitor *m)
{
  (void)judge_e_r(m);
}

/* Processes one event: all rules, then all behaviours. */
… 7 lines of body.c.j2: static void evaluate(small_monitor *m)
/* Forgets all inputs and intervals; timeouts count from the time given. */
… 3 lines of body.c.j2: static void restart(small_monitor *m, int64_t from)
  m->e_r_turned = m->now;
  (void)forget_v(m);
… 4 lines of body.c.j2: m->due = earliest(m);
… 3 lines of body.c.j2: static void reach_deadline(small_monitor *m)
… 5 lines of body.c.j2: evaluate(m);
… 3 lines of body.c.j2: static void catch_up(small_monitor *m, int64_t t)
  /*@ loop invariant sane(m);
      loop invariant is_end(m, m->due);
      loop invariant m->now <= t;
      loop invariant latched_kept{Pre, Here}(m);
      loop invariant caught_up{Pre, Here}(m);
      loop invariant kept_by_deadlines{Pre, Here}(m);
      loop assigns *m, emitted;
      loop variant t - m->now; */
… 7 lines of body.c.j2: while (m->due <= t) {
… 6 lines of body.c.j2: static void step_back(small_monitor *m, int64_t t)
}

/* Advances the time to an instant before the next deadline. */
… 6 lines of body.c.j2: static void pass(small_monitor *m, int64_t t)
… 13 lines of body.c.j2: static inline void arrive(small_monitor *m, int64_t t)
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

… 6 lines of body.c.j2: void small_start(small_monitor *m, void *owner, int64_t t, int64_t grace)
… 6 lines of body.c.j2: int64_t small_advance(small_monitor *m, int64_t t)
… 3 lines of body.c.j2: bool small_waiting(const small_monitor *m)
… 4 lines of body.c.j2: (void)m;
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
… 4 lines of body.c.j2: {
    act(m, judge_e_r(m));
… 5 lines of body.c.j2: } else {
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
