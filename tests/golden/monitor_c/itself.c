/* action stop; input v = topic /ticks.data entity e { r: v = v; } if e.r then { stop; }; */

static bool judge_e_r(small_monitor *m)
{
  const small_verdict verdict = truth_of(m->v_known, true);
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}
