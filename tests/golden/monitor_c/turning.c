/* action stop; input v = topic /imu.orientation entity e { r: v.yaw().rate() > 2; } if e.r then { stop; }; */

  /* 5 lines of smallest */
  double v_rate;  /* as of the last message */
  double v_last;  /* the value before */
  double v_total;  /* the angle without its jumps */
  double v_last_2;  /* the value before */
  int64_t v_last_t;  /* when it came */
  /* 3 lines of smallest */
  bool v_rate_known;  /* whether it is known */
  bool v_rate_above_2;  /* how values compare */
  bool started;  /* whether there has been an event */
} small_monitor;

/* An unwrapped angle: the total changes by the shortest way. */
… 12 lines of function_texts.py: static double unwrapped(double value, double turn, double *last, double *total)
static void clear(small_monitor *m, void *owner, int64_t t)
{
  /* 2 lines of smallest */
  m->v_rate = 0.0;
  m->v_total = 0.0;
  /* 2 lines of smallest */
  m->v_rate_known = false;
  m->v_rate_above_2 = false;
  m->started = false;
}

static bool observe_v(
  small_monitor *m, double orientation_x, double orientation_y, double orientation_z,
  double orientation_w)
{
  /* 7 lines of angle */
    const double new_yaw = yaw(
  /* 2 lines of angle */
    const double v_last_unwrapped = unwrapped(new_yaw, 6.283185307179586, &m->v_last, &m->v_total);
    const double v_last_2_rate = rate(v_last_unwrapped, m->now, &m->v_last_2, &m->v_last_t);
    m->v_rate = v_last_2_rate;
    news = store_truth(&m->v_rate_known, is_number(m->v_rate), news);
    news = store_truth(&m->v_rate_above_2, m->v_rate > 2.0, news);
  /* 4 lines of angle */
}
