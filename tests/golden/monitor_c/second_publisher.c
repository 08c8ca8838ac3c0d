/* action stop; input v = topic /odom.twist.twist.linear.x on_second_publisher unknown timeout 1 sec entity e { r: v > 1; } if e.r then { stop; }; */

static bool observe_v(small_monitor *m, bool publisher_given, double twist_twist_linear_x)
{
  bool news = false;
  if (publisher_given && is_number(twist_twist_linear_x)) {
  /* 6 lines of timeout */
    m->due = earlier(m->due, m->now + INT64_C(1000000000));
  /* 4 lines of timeout */
}

void small_on_v(small_monitor *m, int64_t t, bool publisher_given, double twist_twist_linear_x)
{
  arrive(m, t);
  take_v(m, publisher_given, twist_twist_linear_x);
}
