/* action stop; input v = topic /odom.twist.twist.linear.x input w = topic /battery.percentage const limit = 1 m/s tunable in [50 cm/s, 2 m/s] const least = 20 % tunable in [5, 60] % entity e { r: v > 2 * limit or v not in [-limit, limit] or w < least; } if e.r then { stop; }; */

… 3 lines of monitor.h.j2: /* The tunable constants, each in its own unit. */
  double limit;  /* [0.5, 2.0] m/s */
  double least_2;  /* [5.0, 60.0] % */
} small_constants;

  /* 5 lines of comparison */
  double limit;  /* set at the start */
  double negative_limit;  /* set at the start */
  double least_2;  /* set at the start */
  double least_compared;  /* set at the start */
  double computed_1;  /* set at the start */
  double v;  /* as of the last message */
  double w;  /* as of the last message */
  /* 4 lines of comparison */
  bool w_known;  /* whether w is known */
  bool v_above_computed_1;  /* how values compare */
  bool v_within;  /* how values compare */
  bool w_below_least_compared;  /* how values compare */
  bool started;  /* whether there has been an event */
} small_monitor;

/* Returns whether each constant is in its interval; NaN is in none. */
… 3 lines of body.c.j2: static bool are_valid(const small_constants *constants)
  valid = valid && (constants->limit >= 0.5) && (constants->limit <= 2.0);
  valid = valid && (constants->least_2 >= 5.0) && (constants->least_2 <= 60.0);
  return valid;
}

static void clear(
  small_monitor *m, void *owner, int64_t t, const small_constants *constants)
{
  /* 2 lines of smallest */
  m->limit = constants->limit;
  m->negative_limit = -constants->limit;
  m->least_2 = constants->least_2;
  m->least_compared = (double)(float)(constants->least_2 * 0.01);
  m->computed_1 = compute_1(m->limit);
  m->v = 0.0;
  m->w = 0.0;
  /* 3 lines of smallest */
  m->w_known = false;
  m->v_above_computed_1 = false;
  m->v_within = false;
  m->w_below_least_compared = false;
  m->started = false;
}

… 8 lines of body.c.j2: bool small_start(

static bool observe_v(small_monitor *m, double twist_twist_linear_x)
{
  /* 4 lines of comparison */
    news = store_truth(&m->v_above_computed_1, m->v > m->computed_1, news);
    news = store_truth(&m->v_within, (m->v >= m->negative_limit) && (m->v <= m->limit), news);
  /* 4 lines of comparison */
}
