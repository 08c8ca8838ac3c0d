/* action stop; input s = topic /scan zone front = circle (1, 0) 0.5 m entity e { r: s.points_in(front) >= 4; } if e.r then { stop; }; */

/*@ predicate has_points_in_front_0{L}(float *ranges, integer count, double angle_min, double
  angle_increment, double range_min, double range_max, double start, double end, integer
  zero_is_free) = \exists integer k; 0 <= k < count && is_in_sector(\add_double(angle_min,
  \mul_double((double)k, angle_increment)), start, end) && \le_double(beam_of((double)ranges[k],
  range_min, range_max, zero_is_free), (double)1.5000000000015001) &&
  is_in_front_0(beam_of((double)ranges[k], range_min, range_max, zero_is_free),
  \add_double(angle_min, \mul_double((double)k, angle_increment))); */

/* s.points_in(front); zone front, declared in line 2 */
/*@ assigns \nothing;
    check ensures \exists double cosine, sine; is_cos(cosine, bearing) && is_sin(sine, bearing) &&
      (\let x = \mul_double(distance, cosine); \let y = \mul_double(distance, sine); (\result != 0
      <==> (\let from_x = \sub_double(x, (double)1.0); (\let from_y = y;
      \le_double(\add_double(\mul_double(from_x, from_x), \mul_double(from_y, from_y)),
      (double)0.25)))));
    admit ensures \result != 0 <==> is_in_front_0(distance, bearing); */
static bool is_in_front_0(double distance, double bearing);

/*@ requires \valid_read(ranges + (0 .. count - 1));
    assigns \nothing;
    check ensures !has_beam(count, angle_min, angle_increment, start, end) ==> \is_NaN(\result);
    check ensures !\is_NaN(\result) ==> formula_of_points_in_front_0(\result, ranges, count,
      angle_min, angle_increment, range_min, range_max, start, end, zero_is_free);
    check ensures has_beam(count, angle_min, angle_increment, start, end) && !has_blind(ranges,
      count, angle_min, angle_increment, range_min, range_max, start, end, zero_is_free) ==>
      !\is_NaN(\result);
    admit ensures is_points_in_front_0(\result, ranges, count, angle_min, angle_increment,
      range_min, range_max, start, end, zero_is_free); */
static double points_in_front_0(
  const float *ranges, size_t count, double angle_min, double angle_increment, double range_min,
  double range_max, double start, double end, bool zero_is_free);
