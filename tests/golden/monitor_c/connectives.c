/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v in [-1, 1) and not v = 0 or v != 2; } if e.r then { stop; }; */

/* Kleene's negation. */
… 13 lines of verdicts.py: static small_verdict negated(small_verdict operand)
/* Kleene's conjunction: the less true of the two. */
… 5 lines of verdicts.py: static small_verdict both(small_verdict a, small_verdict b)
/* Kleene's disjunction: the truer of the two. */
… 5 lines of verdicts.py: static small_verdict either(small_verdict a, small_verdict b)
static bool judge_e_r(small_monitor *m)
{
  const small_verdict verdict = either(
    both(truth_of(m->v_known, m->v_within), negated(truth_of(m->v_known, m->v_is_0))),
    truth_of(m->v_known, m->v_is_not_2));
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}

static bool observe_v(small_monitor *m, double twist_twist_linear_x)
{
  /* 4 lines of comparison */
    news = store_truth(&m->v_within, (m->v >= -1.0) && (m->v < 1.0), news);
    news = store_truth(&m->v_is_0, m->v == 0.0, news);
    news = store_truth(&m->v_is_not_2, m->v != 2.0, news);
  /* 4 lines of comparison */
}
