/* action stop; input v = topic /imu.angular_velocity entity e { r: v.norm() > 1; } if e.r then { stop; }; */

static double norm(double x, double y, double z)
{
  return sqrt(((x * x) + (y * y)) + (z * z));
}

static bool observe_v(
  small_monitor *m, double angular_velocity_x, double angular_velocity_y,
  double angular_velocity_z)
{
  bool news = false;
  if (is_number(angular_velocity_x) &&
    is_number(angular_velocity_y) &&
    is_number(angular_velocity_z))
  {
    m->v_norm = norm(angular_velocity_x, angular_velocity_y, angular_velocity_z);
    news = store_truth(&m->v_norm_known, is_number(m->v_norm), news);
    news = store_truth(&m->v_norm_above_1, m->v_norm > 1.0, news);
  /* 4 lines of element */
}
