/* action stop; input v = topic /joints.position entity e { r: v.max() > 1 or v.min() < 1; } if e.r then { stop; }; */

/* Returns whether no element is a NaN. */
static bool are_numbers_float64(const double *values, size_t count)
… 13 lines of helpers.py: {
static double least_float64(const double *values, size_t count)
{
  double found = NAN;
  /*@ loop invariant 0 <= i <= count;
      loop invariant carried_least_float64(found, values, i);
      loop assigns i, found;
      loop variant count - i; */
  for (size_t i = 0U; i < count; ++i) {
    if ((i == 0U) || (values[i] < found)) {
      found = values[i];
    }
  }
  return found;
}

static double greatest_float64(const double *values, size_t count)
{
  double found = NAN;
  /*@ loop invariant 0 <= i <= count;
      loop invariant carried_greatest_float64(found, values, i);
      loop assigns i, found;
      loop variant count - i; */
  for (size_t i = 0U; i < count; ++i) {
    if ((i == 0U) || (values[i] > found)) {
      found = values[i];
    }
  }
  return found;
}

static bool observe_v(small_monitor *m, const double *position, size_t position_count)
{
  bool news = false;
  if ((position_count <= SMALL_MOST_ELEMENTS) && are_numbers_float64(position, position_count)) {
    m->v_max = greatest_float64(position, position_count);
    news = store_truth(&m->v_max_known, is_number(m->v_max), news);
    m->v_min = least_float64(position, position_count);
    news = store_truth(&m->v_min_known, is_number(m->v_min), news);
    news = store_truth(&m->v_max_above_1, m->v_max > 1.0, news);
    news = store_truth(&m->v_min_below_1, m->v_min < 1.0, news);
  /* 4 lines of element */
}
