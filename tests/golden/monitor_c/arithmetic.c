/* action stop; input v = topic /battery.percentage entity e { r: hypot(v, sqrt(2 * abs(v))) in (0.5, 2) and sin(v) / v < min(max(v, 0.5), 2) - v; } if e.r then { stop; }; */

static double least(double a, double b)
{
  return (a < b) ? a : ((b < a) ? b : ((a != b) ? NAN : ((a != 0.0) ? a : (-((-a) - b)))));
}

static double greatest(double a, double b)
{
  return (a > b) ? a : ((b > a) ? b : ((a != b) ? NAN : ((a != 0.0) ? a : (a + b))));
}

static double compute_1(double v)
{
  const double part_1 = (v > 0.0) ? v : (0.0 - v);
  const double part_2 = 2.0 * part_1;
  const double part_3 = (part_2 >= 0.0) ? sqrt(part_2) : NAN;
  return sqrt((v * v) + (part_3 * part_3));
}

static double compute_2(double v)
{
  const double part_1 = ((v > -INFINITY) && (v < INFINITY)) ? sin(v) : NAN;
  return (v == 0.0) ? NAN : (part_1 / v);
}

static double compute_3(double v)
{
  const double part_1 = greatest(v, 0.5);
  return least(part_1, 2.0) - v;
}

static bool observe_v(small_monitor *m, double percentage)
{
  bool news = false;
  if (is_number(percentage)) {
    news = store_truth(&m->v_known, true, news);
    m->v = percentage;
    m->computed_1 = compute_1(m->v);
    news = store_truth(&m->computed_1_known, m->v_known && is_number(m->computed_1), news);
    m->computed_2 = compute_2(m->v);
    news = store_truth(&m->computed_2_known, m->v_known && is_number(m->computed_2), news);
    m->computed_3 = compute_3(m->v);
    news = store_truth(&m->computed_3_known, m->v_known && is_number(m->computed_3), news);
    news = store_truth(
      &m->computed_1_within,
      (m->computed_1 > 0.5) && (m->computed_1 < 2.0),
      news);
    news = store_truth(&m->computed_2_below_computed_3, m->computed_2 < m->computed_3, news);
  /* 4 lines of element */
}
