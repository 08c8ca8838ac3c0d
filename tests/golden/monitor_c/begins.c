/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1.5 begins; } if e.r then { stop; }; */

/* 'begins': true while the operand, true since *since, has not lasted the shortest time. */
… 5 lines of verdicts.py: static small_verdict begun(small_verdict lasts, int64_t since)
static bool judge_e_r(small_monitor *m)
{
  /* 2 lines of duration */
    INT64_C(1),
  /* 3 lines of duration */
  const small_verdict verdict = begun(for_1, m->e_r_since);
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}
