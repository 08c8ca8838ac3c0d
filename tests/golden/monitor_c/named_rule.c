/* action stop; input v = topic /odom.twist.twist.linear.x entity e { q: v > 1; r: v < 2 and not q for 1 sec; } if e.r then { stop; }; */

static bool judge_e_r(small_monitor *m)
{
  const small_verdict for_1 = lasting(
    both(truth_of(m->v_known, m->v_below_2), negated(m->e_q)),
    INT64_C(1000000000),
  /* 5 lines of duration */
}

/* Evaluates the rules that read /odom; returns whether a verdict has changed. */
static bool judge_by_v(small_monitor *m)
{
  bool changed = false;
  changed = judge_e_q(m) || changed;
  changed = judge_e_r(m) || changed;
  return changed;
}

static void after_v(small_monitor *m, bool news)
{
  /* 3 lines of smallest */
    act(m, judge_by_v(m));
  /* 2 lines of smallest */
}
