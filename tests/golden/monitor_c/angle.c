/* action stop; input v = topic /imu.orientation entity e { r: v.roll() in [0, 1] or v.pitch() > 1 or v.yaw() > 1 or v.tilt() > 1; } if e.r then { stop; }; */

static double length_of(double x, double y, double z, double w)
{
  const double length = sqrt((((x * x) + (y * y)) + (z * z)) + (w * w));
  return ((length > 0.0) && (length < INFINITY)) ? length : NAN;
}

static double clamped(double sine)
{
  return (sine > 1.0) ? 1.0 : ((sine < -1.0) ? -1.0 : sine);
}

static double roll(double ux, double uy, double uz, double uw)
{
  return atan2(2.0 * ((uw * ux) + (uy * uz)), 1.0 - (2.0 * ((ux * ux) + (uy * uy))));
}

static double pitch(double ux, double uy, double uz, double uw)
{
  return asin(clamped(2.0 * ((uw * uy) - (uz * ux))));
}

static double yaw(double ux, double uy, double uz, double uw)
{
  return atan2(2.0 * ((uw * uz) + (ux * uy)), 1.0 - (2.0 * ((uy * uy) + (uz * uz))));
}

static double tilt(double ux, double uy, double uz, double uw)
{
  return 2.0 * atan2(sqrt((ux * ux) + (uy * uy)), sqrt((uz * uz) + (uw * uw)));
}

static bool observe_v(
  small_monitor *m, double orientation_x, double orientation_y, double orientation_z,
  double orientation_w)
{
  bool news = false;
  if (is_number(orientation_x) &&
    is_number(orientation_y) &&
    is_number(orientation_z) &&
    is_number(orientation_w))
  {
    const double length_1 = length_of(orientation_x, orientation_y, orientation_z, orientation_w);
    m->v_roll = roll(
      orientation_x / length_1, orientation_y / length_1, orientation_z / length_1,
      orientation_w / length_1);
    news = store_truth(&m->v_roll_known, is_number(m->v_roll), news);
    m->v_pitch = pitch(
      orientation_x / length_1, orientation_y / length_1, orientation_z / length_1,
      orientation_w / length_1);
    news = store_truth(&m->v_pitch_known, is_number(m->v_pitch), news);
    m->v_yaw = yaw(
      orientation_x / length_1, orientation_y / length_1, orientation_z / length_1,
      orientation_w / length_1);
    news = store_truth(&m->v_yaw_known, is_number(m->v_yaw), news);
    m->v_tilt = tilt(
      orientation_x / length_1, orientation_y / length_1, orientation_z / length_1,
      orientation_w / length_1);
    news = store_truth(&m->v_tilt_known, is_number(m->v_tilt), news);
    news = store_truth(&m->v_roll_within, (m->v_roll >= 0.0) && (m->v_roll <= 1.0), news);
    news = store_truth(&m->v_pitch_above_1, m->v_pitch > 1.0, news);
    news = store_truth(&m->v_yaw_above_1, m->v_yaw > 1.0, news);
    news = store_truth(&m->v_tilt_above_1, m->v_tilt > 1.0, news);
  /* 4 lines of element */
}
