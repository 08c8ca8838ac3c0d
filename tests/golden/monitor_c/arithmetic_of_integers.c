/* action stop; input v = topic /mode.data entity e { r: abs(v - 1) > v / 2; } if e.r then { stop; }; */

static double compute_1(double v)
{
  const double part_1 = v - 1.0;
  return (part_1 > 0.0) ? part_1 : (0.0 - part_1);
}

static double compute_2(double v)
{
  return v / 2.0;
}

static bool observe_v(small_monitor *m, int64_t data)
{
  /* 3 lines of integer */
  m->computed_1 = compute_1((double)m->v);
  news = store_truth(&m->computed_1_known, m->v_known && is_number(m->computed_1), news);
  m->computed_2 = compute_2((double)m->v);
  news = store_truth(&m->computed_2_known, m->v_known && is_number(m->computed_2), news);
  news = store_truth(&m->computed_1_above_computed_2, m->computed_1 > m->computed_2, news);
  return news;
}
