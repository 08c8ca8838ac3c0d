/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v.previous() > 2; } if e.r then { stop; }; */

/* previous(): its value at the message before; unknown until there are two. */
static double previous_of(double value, double *last)
{
  const double former = *last;
  *last = value;
  return former;
}

static bool observe_v(small_monitor *m, double twist_twist_linear_x)
{
  /* 2 lines of comparison */
    const double v_last_previous = previous_of(twist_twist_linear_x, &m->v_last);
    m->v_previous = v_last_previous;
    news = store_truth(&m->v_previous_known, is_number(m->v_previous), news);
    news = store_truth(&m->v_previous_above_2, m->v_previous > 2.0, news);
  /* 4 lines of comparison */
}
