/* input v = topic /odom.twist.twist.linear.x entity e { r: v > 1; s: stop.active and v > 2; t: not stop.active; } action stop latched; action cut; if e.r then { stop; }; if e.s or e.t and stop.active for 1 sec then { cut; }; */

  /* 8 lines of reset_by */
  int64_t e_t_turned;  /* when it last became true or ceased to be */
  int64_t behaviour_2_since;  /* since when its operand has been true */
  /* 2 lines of reset_by */
  small_verdict e_t;  /* rule e.t */
  /* 6 lines of reset_by */
  bool started;  /* whether there has been an event */
} small_monitor;

static bool judge_e_s(small_monitor *m)
{
  const small_verdict verdict = both(
    truth_of(true, m->stop_active),
    truth_of(m->v_known, m->v_above_2));
  return turned(verdict, &m->e_s, &m->e_s_turned, m->now);
}

static void behave_behaviour_2(small_monitor *m)
{
  const small_verdict for_1 = lasting(
    either(m->e_s, both(m->e_t, truth_of(true, m->stop_active))),
    INT64_C(1000000000),
    m->now,
    &m->behaviour_2_since,
    &m->due);
  const small_verdict condition = for_1;
  /* 4 lines of reset_by */
    small_emit(m->owner, m->now, SMALL_TRIGGER, 1U);  /* cut */
  }
}

static void judge_round_2(small_monitor *m)
{
  (void)judge_e_s(m);
  (void)judge_e_t(m);
}

static void act(small_monitor *m, bool changed)
{
  /* 2 lines of smallest */
    judge_round_2(m);
    behave_behaviour_2(m);
  }
}

static void judge_all(small_monitor *m)
{
  (void)judge_e_r(m);
}

bool small_reset(small_monitor *m, int64_t t)
{
  /* 2 lines of latched_action */
  const bool was_stop_active = m->stop_active;
  settle_stop(m);
  bool released = false;
  released = (was_stop_active != m->stop_active) || released;
… 3 lines of body.c.j2: if (released) {
  /* 4 lines of latched_action */
}

static void after_v(small_monitor *m, bool news)
{
  /* 3 lines of lasting_behaviour */
    (void)judge_e_r(m);
  /* 3 lines of lasting_behaviour */
}
