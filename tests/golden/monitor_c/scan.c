/* action stop; input v = topic /scan entity e { r: v.nearest(-30 deg, 30 deg) < 0.4; } if e.r then { stop; }; */

/* A message with a longer array counts as one with a NaN. */
#define SMALL_MOST_ELEMENTS 1048576U

… 24 lines of function_texts.py: static double beam(
… 5 lines of function_texts.py: static double nearest(
  /*@ loop invariant 0 <= i <= count;
      loop invariant is_one_of(
          shortest, ranges, i, angle_min, angle_increment, range_min, range_max, start, end);
      loop invariant is_least_of(
          shortest, ranges, i, angle_min, angle_increment, range_min, range_max, start, end);
      loop assigns i, shortest;
      loop variant count - i; */
… 10 lines of function_texts.py: for (size_t i = 0U; i < count; ++i) {
… 5 lines of function_texts.py: static bool valid_range(double measured, double range_min)
… 3 lines of function_texts.py: static bool scan_usable(const float *ranges, size_t count, double range_min)
  /*@ loop invariant 0 <= i <= count;
      loop invariant usable != 0 <==> formula_of_usable(ranges, i, range_min);
      loop assigns i, usable;
      loop variant count - i; */
… 8 lines of function_texts.py: for (size_t i = 0U; i < count; ++i) {
static bool observe_v(
  small_monitor *m, const float *ranges, size_t ranges_count, double angle_min,
  double angle_increment, double range_min, double range_max)
{
  bool news = false;
  if ((ranges_count <= SMALL_MOST_ELEMENTS) &&
    is_number(angle_min) &&
    is_number(angle_increment) &&
    is_number(range_min) &&
    is_number(range_max) &&
    scan_usable(ranges, ranges_count, range_min))
  {
    m->v_nearest = nearest(
      ranges, ranges_count, angle_min, angle_increment, range_min, range_max, -0.5235987755982989,
      0.5235987755982989);
    news = store_truth(&m->v_nearest_known, is_number(m->v_nearest), news);
    news = store_truth(&m->v_nearest_below_0_4, m->v_nearest < 0.4000000059604645, news);
  /* 4 lines of vector */
}
