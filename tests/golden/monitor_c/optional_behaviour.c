/* input v = topic /odom.twist.twist.linear.x entity e { r: v > 1; s: v > 2; } action stop; optional behaviour near: if e.r then { stop; }; */

  /* 10 lines of reset_by */
  small_verdict near_condition;  /* its condition and all around it */
  /* 3 lines of reset_by */
  bool near_enabled;  /* whether it may act */
  bool started;  /* whether there has been an event */
} small_monitor;

/* Enables or disables behaviour near; disabled, its condition counts as false. */
void small_enable_near(small_monitor *m, int64_t t, bool enabled);

static void behave_near(small_monitor *m)
{
  const small_verdict condition = both(truth_of(true, m->near_enabled), m->e_r);
  /* 6 lines of behaviour */
}

static void clear(small_monitor *m, void *owner, int64_t t)
{
  /* 5 lines of reset_by */
  m->near_condition = SMALL_UNKNOWN;
  /* 3 lines of reset_by */
  m->near_enabled = true;
  m->started = false;
}

void small_enable_near(small_monitor *m, int64_t t, bool enabled)
{
  arrive(m, t);
  if (m->near_enabled != enabled) {
    m->near_enabled = enabled;
… 3 lines of body.c.j2: evaluate(m);
