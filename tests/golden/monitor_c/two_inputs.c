/* action stop; input v = topic /odom.twist.twist.linear.x timeout 1 sec input w = topic /odom.twist.twist.linear.y entity e { r: v > w; } if e.r then { stop; }; */

static bool judge_e_r(small_monitor *m)
{
  const small_verdict verdict = truth_of(m->v_known && m->w_known, m->v_above_w);
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}

static void restart(small_monitor *m, int64_t from)
{
  /* 5 lines of timeout */
  (void)forget_w(m);
  m->due = earliest(m);
}

static bool observe_odom(
  small_monitor *m, double twist_twist_linear_x, double twist_twist_linear_y)
{
  /* 4 lines of timeout */
    news = store_truth(&m->v_above_w, m->v > m->w, news);
  /* 3 lines of timeout */
    m->due = earlier(m->due, m->now + INT64_C(1000000000));
  /* 3 lines of timeout */
  if (is_number(twist_twist_linear_y)) {
    news = store_truth(&m->w_known, true, news);
    m->w = twist_twist_linear_y;
    news = store_truth(&m->v_above_w, m->v > m->w, news);
  } else {
    news = forget_w(m) || news;
  }
  return news;
}
