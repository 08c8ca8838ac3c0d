/* action stop; input v = topic /odom.twist.twist.linear.x timeout 0.5 sec entity e { failsafe r: v > 1; } if e.r then { stop; }; */

/* A failsafe rule: unknown counts as true, unless an input has been awaited since the start. */
… 5 lines of verdicts.py: static small_verdict failsafe(small_verdict operand, bool due)
static bool judge_e_r(small_monitor *m)
{
  const small_verdict verdict = failsafe(
    truth_of(m->v_known, m->v_above_1),
    m->v_came || m->v_missing);
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}
