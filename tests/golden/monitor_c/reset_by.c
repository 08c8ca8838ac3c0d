/* input v = topic /odom.twist.twist.linear.x entity e { r: v > 1; s: v > 2; } action stop reset_by ok; action ok; if e.r then { stop; }; if e.s then { ok; }; */

  /* 7 lines of comparison */
  int64_t e_s_turned;  /* when it last became true or ceased to be */
  small_verdict e_r;  /* rule e.r */
  small_verdict e_s;  /* rule e.s */
  small_verdict behaviour_1_condition;  /* its condition and all around it */
  small_verdict behaviour_2_condition;  /* its condition and all around it */
  bool v_known;  /* whether v is known */
  bool v_above_1;  /* how values compare */
  bool v_above_2;  /* how values compare */
  bool stop_active;  /* whether it was run and not reset since */
  bool ok_ran;  /* whether it ran in this event */
  bool started;  /* whether there has been an event */
} small_monitor;

static void settle_stop(small_monitor *m)
{
  if (m->ok_ran && m->stop_active) {
    if (m->behaviour_1_condition == SMALL_FALSE) {
  /* 6 lines of latched_action */
}

static void behave_behaviour_2(small_monitor *m)
{
  const small_verdict condition = m->e_s;
  const bool held = (m->behaviour_2_condition == SMALL_TRUE);
  const bool rises = (condition == SMALL_TRUE) && (!held);
  m->behaviour_2_condition = condition;
  if (rises) {
    m->ok_ran = true;
    small_emit(m->owner, m->now, SMALL_TRIGGER, 1U);  /* ok */
  }
}

… 3 lines of body.c.j2: static void act(small_monitor *m, bool changed)
    m->ok_ran = false;
    behave_behaviour_1(m);
    behave_behaviour_2(m);
    settle_stop(m);
  }
}

static void clear(small_monitor *m, void *owner, int64_t t)
{
  /* 2 lines of smallest */
  m->v = 0.0;
  m->e_r = SMALL_UNKNOWN;
  m->e_s = SMALL_UNKNOWN;
  m->behaviour_1_condition = SMALL_UNKNOWN;
  m->behaviour_2_condition = SMALL_UNKNOWN;
  m->v_known = false;
  m->v_above_1 = false;
  m->v_above_2 = false;
  m->stop_active = false;
  m->ok_ran = false;
  m->started = false;
}
