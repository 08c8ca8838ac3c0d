/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v.rate() > 2 or v.abs() > 2; } if e.r then { stop; }; */

/* The change per second since the message before; NaN for two at the same time. */
static double rate(double value, int64_t t, double *last, int64_t *last_t)
{
  const int64_t elapsed = t - *last_t;
  double change = NAN;
  if (elapsed != 0) {
    change = (value - *last) / ((double)elapsed / 1e9);
  }
  *last = value;
  *last_t = t;
  return change;
}

static bool forget_v(small_monitor *m)
{
  bool news = false;
  news = store_truth(&m->v_rate_known, false, news);
  news = store_truth(&m->v_abs_known, false, news);
  m->v_last = NAN;
  return news;
}

static void restart(small_monitor *m, int64_t from)
{
  (void)from;
  m->v_last_t = m->now;
  /* 3 lines of smallest */
}

static bool observe_v(small_monitor *m, double twist_twist_linear_x)
{
  /* 2 lines of comparison */
    const double v_last_rate = rate(twist_twist_linear_x, m->now, &m->v_last, &m->v_last_t);
    m->v_rate = v_last_rate;
    news = store_truth(&m->v_rate_known, is_number(m->v_rate), news);
    m->v_abs = fabs(twist_twist_linear_x);
    news = store_truth(&m->v_abs_known, is_number(m->v_abs), news);
    news = store_truth(&m->v_rate_above_2, m->v_rate > 2.0, news);
    news = store_truth(&m->v_abs_above_2, m->v_abs > 2.0, news);
  /* 4 lines of comparison */
}
