/* action stop; input v = topic /scan entity e { r: v.nearest(-30 deg, 30 deg) < 0.4; } if e.r then { stop; }; */

/* A message with a longer array counts as one with a NaN. */
#define SMALL_MOST_ELEMENTS 1048576U

… 17 lines of scan_texts.py: static bool in_sector(double bearing, double start, double end)
… 21 lines of scan_texts.py: static double beam(double measured, double range_min, double range_max, bool zero_is_free)
… 7 lines of scan_texts.py: static double nearest(
  /*@ loop invariant 0 <= i <= count;
      loop invariant 0 <= beams <= i;
      loop invariant 0 < beams ==> has_beam(i, angle_min, angle_increment, start, end);
      loop invariant has_beam(i, angle_min, angle_increment, start, end) ==> 0 < beams;
      loop invariant 0 <= unseen <= i;
      loop invariant 0 < unseen ==> has_blind(ranges, i, angle_min, angle_increment, range_min,
        range_max, start, end, zero_is_free);
      loop invariant has_blind(ranges, i, angle_min, angle_increment, range_min, range_max, start,
        end, zero_is_free) ==> 0 < unseen;
      loop invariant unseen <= beams;
      loop invariant is_one_of(shortest, ranges, i, angle_min, angle_increment, range_min,
        range_max, start, end, zero_is_free);
      loop invariant is_least_of(shortest, ranges, i, angle_min, angle_increment, range_min,
        range_max, start, end, zero_is_free);
      loop assigns i, beams, unseen, shortest;
      loop variant count - i; */
… 17 lines of scan_texts.py: for (size_t i = 0U; i < count; ++i) {
… 6 lines of scan_texts.py: static double blind(
… 10 lines as above: /*@ loop invariant 0 <= i <= count;
      loop assigns i, beams, unseen;
      loop variant count - i; */
… 13 lines of scan_texts.py: for (size_t i = 0U; i < count; ++i) {
… 4 lines of scan_texts.py: static bool scan_usable(
  /*@ loop invariant 0 <= i <= count;
      loop invariant usable != 0 <==> formula_of_scan_usable(ranges, i, range_min, range_max,
        zero_is_free);
      loop assigns i, usable;
      loop variant count - i; */
… 8 lines of scan_texts.py: for (size_t i = 0U; i < count; ++i) {
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
    scan_usable(ranges, ranges_count, range_min, range_max, false))
  {
    m->v_nearest = nearest(
      ranges, ranges_count, angle_min, angle_increment, range_min, range_max, -0.5235987755982989,
      0.5235987755982989, false);
    news = store_truth(&m->v_nearest_known, is_number(m->v_nearest), news);
    m->v_blind = blind(
      ranges, ranges_count, angle_min, angle_increment, range_min, range_max, -0.5235987755982989,
      0.5235987755982989, false);
    news = store_truth(&m->v_blind_known, is_number(m->v_blind), news);
    news = store_truth(&m->v_nearest_below_0_4, m->v_nearest < 0.4000000059604645, news);
  /* 4 lines of vector */
}
