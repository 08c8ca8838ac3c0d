/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1.5; } if e.r then { stop; }; */

  /* 5 lines of smallest */
  double v;  /* as of the last message */
  /* 4 lines of smallest */
  bool v_above_1_5;  /* how values compare */
  bool started;  /* whether there has been an event */
} small_monitor;

/* Returns whether a number is not NaN, with which no comparison is true. */
… 5 lines of helpers.py: static bool is_number(double value)
static bool judge_e_r(small_monitor *m)
{
  const small_verdict verdict = truth_of(m->v_known, m->v_above_1_5);
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}

static bool observe_v(small_monitor *m, double twist_twist_linear_x)
{
  bool news = false;
  if (is_number(twist_twist_linear_x)) {
    news = store_truth(&m->v_known, true, news);
    m->v = twist_twist_linear_x;
    news = store_truth(&m->v_above_1_5, m->v > 1.5, news);
  } else {
    news = forget_v(m) || news;
  }
  return news;
}
