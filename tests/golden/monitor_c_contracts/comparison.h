/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1.5; } if e.r then { stop; }; */

/*@ predicate judged_e_r(small_monitor *m) =
      (m->e_r == SMALL_TRUE <==> (m->v_known != 0 && (m->v_above_1_5 != 0))) &&
      (m->e_r == SMALL_FALSE <==> (m->v_known != 0 && !(m->v_above_1_5 != 0))); */

/* Rule e.r (rules.deros:2)
 *   r: v > 1.5;
 */
/*@ requires \valid(m);
    requires (0 <= m->now <= SMALL_LATEST && (m->v_known == 0 || m->v_known == 1) &&
      (m->v_above_1_5 == 0 || m->v_above_1_5 == 1));
    assigns m->e_r, m->e_r_turned;
    ensures is_verdict(m->e_r);
    ensures ((m->e_r == SMALL_TRUE <==> (m->v_known != 0 && (m->v_above_1_5 != 0))) && (m->e_r ==
      SMALL_FALSE <==> (m->v_known != 0 && !(m->v_above_1_5 != 0))));
    ensures (\result != 0 <==> m->e_r != \old(m->e_r));
    ensures m->e_r_turned == ((m->e_r == SMALL_TRUE && \old(m->e_r) != SMALL_TRUE) || (m->e_r !=
      SMALL_TRUE && \old(m->e_r) == SMALL_TRUE) ? m->now : \old(m->e_r_turned)); */
static bool judge_e_r(small_monitor *m);

/* Processes a message of /odom that arrives now. */
… 14 lines as in smallest.h: /*@ requires \valid(m);
    ensures (!\is_NaN(twist_twist_linear_x)) ==> (m->v_known == 1 && same(m->v,
      twist_twist_linear_x));
    ensures !(!\is_NaN(twist_twist_linear_x)) ==> (m->v_known == 0); */
static void take_v(small_monitor *m, double twist_twist_linear_x);
