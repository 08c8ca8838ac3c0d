/* input v = topic /odom.twist.twist.linear.x entity e { r: v > 1; s: v > 2; } action stop; if e.r for 1 sec then { stop; }; if e.r since e.s then { stop; }; if (not e.r) within 1 sec then { stop; }; if e.r 2 times within 3 sec then { stop; }; */

static void behave_behaviour_4(small_monitor *m)
{
  const small_verdict times_1_operand = m->e_r;
  if ((times_1_operand == SMALL_TRUE) && (!m->behaviour_4_held)) {
    m->behaviour_4_end_2 = m->behaviour_4_end_1;
    m->behaviour_4_end_1 = m->now + INT64_C(3000000000);
    m->due = ahead(m->now, m->due, m->behaviour_4_end_2);
  }
  m->behaviour_4_held = (times_1_operand == SMALL_TRUE);
  const small_verdict times_1 = counted(times_1_operand, m->now < m->behaviour_4_end_2);
  const small_verdict condition = times_1;
  const bool held = (m->behaviour_4_condition == SMALL_TRUE);
  const bool rises = (condition == SMALL_TRUE) && (!held);
  m->behaviour_4_condition = condition;
  if (rises) {
    small_emit(m->owner, m->now, SMALL_TRIGGER, 3U);  /* stop */
  }
}

static void behave_behaviour_3(small_monitor *m)
{
  const small_verdict within_1 = recent(
    negated(m->e_r),
    INT64_C(1000000000),
    m->now,
    &m->behaviour_3_until,
    &m->due);
  const small_verdict condition = within_1;
  const bool held = (m->behaviour_3_condition == SMALL_TRUE);
  const bool rises = (condition == SMALL_TRUE) && (!held);
  m->behaviour_3_condition = condition;
  if (rises) {
    small_emit(m->owner, m->now, SMALL_TRIGGER, 2U);  /* stop */
  }
}

static void behave_behaviour_2(small_monitor *m)
{
  m->behaviour_2_kept = either(heard(m->e_s, m->v_came), both(m->e_r, m->behaviour_2_kept));
  const small_verdict condition = either(m->e_s, m->behaviour_2_kept);
  /* 4 lines of reset_by */
    small_emit(m->owner, m->now, SMALL_TRIGGER, 1U);  /* stop */
  }
}

static void behave_behaviour_1(small_monitor *m)
{
  const small_verdict for_1 = lasting(
    m->e_r,
    INT64_C(1000000000),
    m->now,
    &m->behaviour_1_since,
    &m->due);
  const small_verdict condition = for_1;
  /* 6 lines of smallest */
}

static void after_v(small_monitor *m, bool news)
{
  /* 3 lines of smallest */
    (void)judge_by_v(m);
    act(m, true);
  /* 2 lines of smallest */
}
