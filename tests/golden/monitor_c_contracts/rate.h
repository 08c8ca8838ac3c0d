/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v.rate() > 2; } if e.r then { stop; }; */

/*@ predicate judged_e_r(small_monitor *m) =
      (m->e_r == SMALL_TRUE <==> (m->v_rate_known != 0 && (m->v_rate_above_2 != 0))) &&
      (m->e_r == SMALL_FALSE <==> (m->v_rate_known != 0 && !(m->v_rate_above_2 != 0))); */

… 8 lines of helpers.py: /* The change per second since the message before; NaN for two at the same time. */
      \div_double(\sub_double(value, \old(*last)),
      \div_double((double)(t - \old(*last_t)), (double)1000000000.0))); */
static double rate(double value, int64_t t, double *last, int64_t *last_t);
