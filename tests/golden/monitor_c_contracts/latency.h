/* action stop; input v = topic /imu entity e { r: v.latency() > 0.2 sec; } if e.r then { stop; }; */

/*@ predicate formula_of_latency(double r, integer received, integer sec, integer nanosec) = (0 <=
  received && 0 <= sec <= INT32_MAX && 0 <= nanosec < 1000000000 && sec + nanosec > 0 ==> same(r,
  \div_double((double)(received - (sec * 1000000000 + nanosec)), (double)1000000000.0))) && (!(0 <=
  received && 0 <= sec <= INT32_MAX && 0 <= nanosec < 1000000000 && sec + nanosec > 0) ==>
  \is_NaN(r)); */

… 4 lines of windows.py: /* The seconds from the stamp of a header to the receipt of its message; NaN without a stamp. */
static double latency(int64_t received, int64_t sec, int64_t nanosec);

… 15 lines as in angle.h: /* Processes a message of /imu that arrives now. */
    ensures ((m->v_latency_known != 0 <==> !\is_NaN(m->v_latency)) && is_latency(m->v_latency,
      received, header_stamp_sec, header_stamp_nanosec)); */
static void take_v(
  small_monitor *m, int64_t received, int64_t header_stamp_sec, int64_t header_stamp_nanosec);
