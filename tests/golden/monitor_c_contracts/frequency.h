/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v.frequency(3) < 8 Hz; } if e.r then { stop; }; */

/*@ predicate judged_e_r(small_monitor *m) =
      (m->e_r == SMALL_TRUE <==> (m->now - m->v_stamp_3 >= 375000001)) &&
      (m->e_r == SMALL_FALSE <==> (m->now - m->v_stamp_3 < 375000001)); */

/*@ predicate ends_in_time(small_monitor *m, integer due) =
      (m->v_stamp_3 + 375000001 > m->now ==> due <= m->v_stamp_3 + 375000001); */

/* Takes the values of a message of /odom; returns whether one has changed. */
/*@ requires \valid(m);
    requires (0 <= m->now <= SMALL_LATEST && 0 <= m->v_stamp_1 <= SMALL_LATEST && 0 <= m->v_stamp_2
      <= SMALL_LATEST && 0 <= m->v_stamp_3 <= SMALL_LATEST && (m->v_stamp_3 + 375000001 > m->now
      ==> m->due <= m->v_stamp_3 + 375000001));
    assigns m->v_stamp_1, m->v_stamp_2, m->v_stamp_3, m->due;
    ensures (0 <= m->now <= SMALL_LATEST && 0 <= m->v_stamp_1 <= SMALL_LATEST && 0 <= m->v_stamp_2
      <= SMALL_LATEST && 0 <= m->v_stamp_3 <= SMALL_LATEST && (m->v_stamp_3 + 375000001 > m->now
      ==> m->due <= m->v_stamp_3 + 375000001));
    ensures \result == 0 ==> (m->v_stamp_1 == \old(m->v_stamp_1) && m->v_stamp_2 ==
      \old(m->v_stamp_2) && m->v_stamp_3 == \old(m->v_stamp_3));
    ensures (!\is_NaN(twist_twist_linear_x)) ==> (m->v_stamp_1 == m->now && m->v_stamp_2 ==
      \old(m->v_stamp_1) && m->v_stamp_3 == \old(m->v_stamp_2) && m->due == \min(\old(m->due),
      (m->v_stamp_3 + 375000001 > m->now ? m->v_stamp_3 + 375000001 : SMALL_NEVER)));
    ensures !(!\is_NaN(twist_twist_linear_x)) ==> ((m->v_stamp_1 == \old(m->v_stamp_1) &&
      m->v_stamp_2 == \old(m->v_stamp_2) && m->v_stamp_3 == \old(m->v_stamp_3) && m->due ==
      \old(m->due)));
    ensures m->due <= \old(m->due);
    ensures \old(m->due) > m->now ==> m->due > m->now; */
static bool observe_v(small_monitor *m, double twist_twist_linear_x);
