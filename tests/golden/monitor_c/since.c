/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1.5 since v < 0; } if e.r then { stop; }; */

  /* 8 lines of comparison */
  small_verdict e_r_kept;  /* a since, as of the last event */
  small_verdict behaviour_1_condition;  /* its condition and all around it */
  bool v_came;  /* whether a message has counted */
  /* 2 lines of comparison */
  bool v_below_0;  /* how values compare */
  bool started;  /* whether there has been an event */
} small_monitor;

/* The cause of a 'since': one that is unknown is none before all that it reads has come. */
… 5 lines of verdicts.py: static small_verdict heard(small_verdict cause, bool come)
static bool judge_e_r(small_monitor *m)
{
  m->e_r_kept = either(
    heard(truth_of(m->v_known, m->v_below_0), m->v_came),
    both(truth_of(m->v_known, m->v_above_1_5), m->e_r_kept));
  const small_verdict verdict = either(truth_of(m->v_known, m->v_below_0), m->e_r_kept);
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}

static void restart(small_monitor *m, int64_t from)
{
  /* 2 lines of smallest */
  m->e_r_kept = SMALL_FALSE;
  m->v_came = false;
  /* 2 lines of smallest */
}
