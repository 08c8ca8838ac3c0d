/* action stop; input v = topic /scan mounted (0.2, 0, 0.1) m yaw 90 deg zone front = polygon (0.3, -0.4) (1.2, -0.2) (1.2, 0.2) (0.3, 0.4) m "what it drives into" entity e { r: v.points_in(front) >= 4; } if e.r then { stop; }; */

/* v.points_in(front); zone front, declared in line 2: what it drives into */
static bool is_in_front_0(double distance, double bearing)
{
  const double x = distance * cos(bearing);
  const double y = distance * sin(bearing);
  const double side_1_2 = (0.2 * (y + 0.1)) + (0.9 * (x + 0.4));
  const double side_3_4 = (0.2 * (y + 1.0)) - (0.9 * (x - 0.2));
  return (side_1_2 >= 0.0) && (y >= -1.0) && (side_3_4 >= 0.0) && (y <= -0.1);
}

static double points_in_front_0(
… 6 lines of formulas.py: const float *ranges, size_t count, double angle_min, double angle_increment, double range_min,
… 10 lines as in scan.c: /*@ loop invariant 0 <= i <= count;
      loop invariant 0 <= found <= i;
      loop invariant 0 < found ==> has_points_in_front_0(ranges, i, angle_min, angle_increment,
        range_min, range_max, start, end, zero_is_free);
      loop invariant has_points_in_front_0(ranges, i, angle_min, angle_increment, range_min,
        range_max, start, end, zero_is_free) ==> 0 < found;
      loop assigns i, beams, unseen, found;
      loop variant count - i; */
… 7 lines of scan_texts.py: for (size_t i = 0U; i < count; ++i) {
      } else if ((shown <= 1.0198039027195769) && is_in_front_0(shown, bearing)) {
… 9 lines of formulas.py: found += 1U;
… 6 lines of scan_texts.py: static double points(
  /*@ loop invariant 0 <= i <= count;
      loop invariant 0 <= beams <= i;
      loop invariant 0 < beams ==> has_beam(i, angle_min, angle_increment, start, end);
      loop invariant has_beam(i, angle_min, angle_increment, start, end) ==> 0 < beams;
      loop invariant 0 <= found <= i;
      loop invariant 0 < found ==> has_point(ranges, i, angle_min, angle_increment, range_min,
        range_max, start, end, zero_is_free);
      loop invariant has_point(ranges, i, angle_min, angle_increment, range_min, range_max, start,
        end, zero_is_free) ==> 0 < found;
      loop assigns i, beams, found;
      loop variant count - i; */
… 12 lines of scan_texts.py: for (size_t i = 0U; i < count; ++i) {
static bool observe_v(
  small_monitor *m, const float *ranges, size_t ranges_count, double angle_min,
  double angle_increment, double range_min, double range_max)
{
  /* 8 lines of scan */
    m->v_points_in = points_in_front_0(
      ranges, ranges_count, angle_min, angle_increment, range_min, range_max, -2.8966139904629293,
      -0.24497866312686423, false);
    news = store_truth(&m->v_points_in_known, is_number(m->v_points_in), news);
    m->v_blind = blind(
      ranges, ranges_count, angle_min, angle_increment, range_min, range_max, -2.8966139904629293,
      -0.24497866312686423, false);
    news = store_truth(&m->v_blind_known, is_number(m->v_blind), news);
    m->v_points = points(
      ranges, ranges_count, angle_min, angle_increment, range_min, range_max, -2.8966139904629293,
      -0.24497866312686423, false);
    news = store_truth(&m->v_points_known, is_number(m->v_points), news);
    news = store_truth(&m->v_points_in_at_least_4, m->v_points_in >= 4.0, news);
  /* 4 lines of scan */
}
