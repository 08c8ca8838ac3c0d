/* input v = topic /odom.twist.twist.linear.x entity e { r: v > 1; s: v > 2; } action stop latched; if e.r then { stop; }; if e.s then { stop; }; */

/* To be called after the start, if stop was active when an earlier run ended. */
void small_latch_stop(small_monitor *m);

… 3 lines of monitor.h.j2: /* Resets the latched actions whose causes are all known to be over; tells whether none is left
bool small_reset(small_monitor *m, int64_t t);

/* Action stop is latched (small.deros:2) */
static void settle_stop(small_monitor *m)
{
  if (m->stop_active) {
    if ((m->behaviour_1_condition == SMALL_FALSE) && (m->behaviour_2_condition == SMALL_FALSE)) {
      m->stop_active = false;
      small_emit(m->owner, m->now, SMALL_RESET, 2U);
    } else {
      small_emit(m->owner, m->now, SMALL_REFUSED, 2U);
… 4 lines of rule_metadata.cpp.j2: }
static void behave_behaviour_1(small_monitor *m)
{
  /* 5 lines of smallest */
    m->stop_active = true;
  /* 2 lines of smallest */
}

void small_latch_stop(small_monitor *m)
{
  m->stop_active = true;
}

… 4 lines of body.c.j2: bool small_reset(small_monitor *m, int64_t t)
  settle_stop(m);
  if (m->stop_active) {
… 4 lines of body.c.j2: done = false;
