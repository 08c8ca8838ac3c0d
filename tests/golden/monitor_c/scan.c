/* action stop; input v = topic /scan entity e { r: v.nearest(-30 deg, 30 deg) < 0.4; } if e.r then { stop; }; */

/* A message with a longer array counts as one with a NaN. */
#define SMALL_MOST_ELEMENTS 1048576U

static double beam(
  double measured, double bearing, double range_min, double range_max, double start, double end)
{
  const double turn = 6.283185307179586;
  double width = end - start;
  double offset = fmod(bearing - start, turn);
  double distance = NAN;
  if (end < start) {
    width += turn;
  }
  if (offset < 0.0) {
    offset += turn;
  }
  const bool inside = (offset <= (width + 1e-6)) || (offset >= (turn - 1e-6));
  if (inside && (measured == -INFINITY)) {  /* too near to measure (REP 117) */
    distance = range_min + 0.0;  /* which makes 0.0 of -0.0 */
  } else if (inside && (measured >= range_min)) {
    distance = (measured > range_max) ? INFINITY : (measured + 0.0);
  } else {
    /* beside the sector, or invalid */
  }
  return distance;
}

static double nearest(
  const float *ranges, size_t count, double angle_min, double angle_increment,
  double range_min, double range_max, double start, double end)
{
  double shortest = NAN;
  /*@ loop invariant 0 <= i <= count;
      loop invariant is_one_of(
          shortest, ranges, i, angle_min, angle_increment, range_min, range_max, start, end);
      loop invariant is_least_of(
          shortest, ranges, i, angle_min, angle_increment, range_min, range_max, start, end);
      loop assigns i, shortest;
      loop variant count - i; */
  for (size_t i = 0U; i < count; ++i) {
    const double bearing = angle_min + ((double)i * angle_increment);
    const double distance = beam((double)ranges[i], bearing, range_min, range_max, start, end);
    if (is_number(distance) && !(shortest <= distance)) {
      shortest = distance;
    }
  }
  return shortest;
}

static bool valid_range(double measured, double range_min)
{
  return (measured >= range_min) || (measured == -INFINITY);
}

static bool scan_usable(const float *ranges, size_t count, double range_min)
{
  bool usable = false;
  /*@ loop invariant 0 <= i <= count;
      loop invariant usable != 0 <==> formula_of_usable(ranges, i, range_min);
      loop assigns i, usable;
      loop variant count - i; */
  for (size_t i = 0U; i < count; ++i) {
    if (valid_range((double)ranges[i], range_min)) {
      usable = true;
    }
  }
  return usable;
}

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
