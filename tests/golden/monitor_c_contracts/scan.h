/* action stop; input s = topic /scan entity e { r: s.nearest(-30 deg, 30 deg) < 0.4; } if e.r then { stop; }; */

/*@ predicate is_within(double past, double width) = (\lt_double(past, (double)0.0) ==>
  is_by_offset(\add_double(past, (double)6.283185307179586), width)) && (!\lt_double(past,
  (double)0.0) ==> is_by_offset(past, width)); */

/*@ predicate has_blind{L}(float *ranges, integer count, double angle_min, double angle_increment,
  double range_min, double range_max, double start, double end, integer zero_is_free) = \exists
  integer k; 0 <= k < count && is_in_sector(\add_double(angle_min, \mul_double((double)k,
  angle_increment)), start, end) && \is_NaN(beam_of((double)ranges[k], range_min, range_max,
  zero_is_free)); */

/*@ predicate is_least_of{L}(double r, float *ranges, integer count, double angle_min, double
  angle_increment, double range_min, double range_max, double start, double end, integer
  zero_is_free) = (\forall integer k; 0 <= k < count ==> is_in_sector(\add_double(angle_min,
  \mul_double((double)k, angle_increment)), start, end) ==> \is_NaN(beam_of((double)ranges[k],
  range_min, range_max, zero_is_free)) || \le_double(r, beam_of((double)ranges[k], range_min,
  range_max, zero_is_free))); */

/*@ predicate judged_e_r(small_monitor *m) =
      (m->e_r == SMALL_TRUE <==> (m->s_nearest_known != 0 && (m->s_nearest_below_0_4 != 0))) &&
      (m->e_r == SMALL_FALSE <==> (m->s_nearest_known != 0 && !(m->s_nearest_below_0_4 != 0))); */

/*@ requires \valid_read(ranges + (0 .. count - 1));
    assigns \nothing;
    check ensures is_one_of(\result, ranges, count, angle_min, angle_increment, range_min,
      range_max, start, end, zero_is_free);
    check ensures !\is_NaN(\result) ==> is_least_of(\result, ranges, count, angle_min,
      angle_increment, range_min, range_max, start, end, zero_is_free);
    check ensures has_beam(count, angle_min, angle_increment, start, end) && !has_blind(ranges,
      count, angle_min, angle_increment, range_min, range_max, start, end, zero_is_free) ==>
      !\is_NaN(\result);
    admit ensures is_nearest(\result, ranges, count, angle_min, angle_increment, range_min,
      range_max, start, end, zero_is_free); */
static double nearest(
  const float *ranges, size_t count, double angle_min, double angle_increment, double range_min,
  double range_max, double start, double end, bool zero_is_free);

/*@ requires \valid_read(ranges + (0 .. count - 1));
    assigns \nothing;
    check ensures \result != 0 <==> formula_of_scan_usable(ranges, count, range_min, range_max,
      zero_is_free);
    admit ensures \result != 0 <==> is_scan_usable(ranges, count, range_min, range_max,
      zero_is_free); */
static bool scan_usable(
  const float *ranges, size_t count, double range_min, double range_max, bool zero_is_free);
