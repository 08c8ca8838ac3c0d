/* action stop; input s = topic /scan entity e { r: s.nearest(-30 deg, 30 deg) < 0.4; } if e.r then { stop; }; */

/*@ predicate is_within(double past, double width) = (\lt_double(past, (double)0.0) ==>
  is_by_offset(\add_double(past, (double)6.283185307179586), width)) && (!\lt_double(past,
  (double)0.0) ==> is_by_offset(past, width)); */

/*@ predicate is_least_of{L}(double r, float *ranges, integer count, double angle_min, double
  angle_increment, double range_min, double range_max, double start, double end) = (\forall integer
  k; 0 <= k < count ==> \is_NaN(beam_of((double)ranges[k], \add_double(angle_min,
  \mul_double((double)k, angle_increment)), range_min, range_max, start, end)) || \le_double(r,
  beam_of((double)ranges[k], \add_double(angle_min, \mul_double((double)k, angle_increment)),
  range_min, range_max, start, end))); */

/*@ predicate judged_e_r(small_monitor *m) =
      (m->e_r == SMALL_TRUE <==> (m->s_nearest_known != 0 && (m->s_nearest_below_0_4 != 0))) &&
      (m->e_r == SMALL_FALSE <==> (m->s_nearest_known != 0 && !(m->s_nearest_below_0_4 != 0))); */

… 3 lines of scans.py: /*@ requires \valid_read(ranges + (0 .. count - 1));
      \result, ranges, count, angle_min, angle_increment, range_min, range_max, start, end);
    check ensures is_least_of(
      \result, ranges, count, angle_min, angle_increment, range_min, range_max, start, end);
    admit ensures is_nearest(
      \result, ranges, count, angle_min, angle_increment, range_min, range_max, start, end); */
static double nearest(
  const float *ranges, size_t count, double angle_min, double angle_increment,
  double range_min, double range_max, double start, double end);

… 4 lines of scans.py: /*@ requires \valid_read(ranges + (0 .. count - 1));
static bool scan_usable(const float *ranges, size_t count, double range_min);
