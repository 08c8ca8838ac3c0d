/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1.5 within 2 sec; } if e.r then { stop; }; */

  /* 7 lines of comparison */
  int64_t e_r_until;  /* until when a within is true */
  /* 5 lines of comparison */
} small_monitor;

/* 'within': true while the operand is, and until *until, so long after it has ceased to be. */
… 14 lines of verdicts.py: static small_verdict recent(
… 3 lines of body.c.j2: static int64_t earliest(const small_monitor *m)
  if (m->e_r_until != SMALL_NEVER) {
    due = ahead(m->now, due, m->e_r_until);
  /* 2 lines of duration */
}

static bool judge_e_r(small_monitor *m)
{
  const small_verdict within_1 = recent(
  /* 3 lines of duration */
    &m->e_r_until,
    &m->due);
  const small_verdict verdict = within_1;
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}

static void restart(small_monitor *m, int64_t from)
{
  /* 2 lines of smallest */
  m->e_r_until = 0;
  /* 2 lines of smallest */
}
