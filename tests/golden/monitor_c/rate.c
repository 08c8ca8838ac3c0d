/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v.rate() > 2 or v.abs() > 2; } if e.r then { stop; }; */

/* The change per second since the message before; NaN for two at the same time. */
… 12 lines of function_texts.py: static double rate(double value, int64_t t, double *last, int64_t *last_t)
static bool forget_v(small_monitor *m)
{
  bool news = false;
  news = store_truth(&m->v_rate_known, false, news);
  news = store_truth(&m->v_abs_known, false, news);
  m->v_last = NAN;
  return news;
}

… 3 lines of body.c.j2: static void restart(small_monitor *m, int64_t from)
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
