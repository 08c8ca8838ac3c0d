/* action stop; input v = topic /imu entity e { r: v.latency() not in [0 sec, 0.2 sec]; } if e.r then { stop; }; */

/* The seconds from the stamp of a header to the receipt of its message; NaN without a stamp. */
… 8 lines of function_texts.py: static double latency(int64_t received, int64_t sec, int64_t nanosec)
static bool observe_v(
  small_monitor *m, int64_t received, int64_t header_stamp_sec, int64_t header_stamp_nanosec)
{
  bool news = false;
  m->v_latency = latency(received, header_stamp_sec, header_stamp_nanosec);
  news = store_truth(&m->v_latency_known, is_number(m->v_latency), news);
  news = store_truth(&m->v_latency_within, (m->v_latency >= 0.0) && (m->v_latency <= 0.2), news);
  return news;
}

void small_on_v(
  small_monitor *m, int64_t t, int64_t received, int64_t header_stamp_sec,
  int64_t header_stamp_nanosec)
{
  arrive(m, t);
  take_v(m, received, header_stamp_sec, header_stamp_nanosec);
}
