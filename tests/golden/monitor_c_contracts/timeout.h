/* action stop; input v = topic /odom.twist.twist.linear.x timeout 0.5 sec entity e { r: v > 1 or v.missing(); } if e.r then { stop; }; */

/*@ predicate judged_e_r(small_monitor *m) =
      (m->e_r == SMALL_TRUE <==> ((m->v_known != 0 && (m->v_above_1 != 0)) || m->v_missing != 0))
        &&
      (m->e_r == SMALL_FALSE <==> ((m->v_known != 0 && !(m->v_above_1 != 0)) && m->v_missing ==
        0)); */

/*@ predicate timeouts_in_time(small_monitor *m, integer due) =
      (m->v_missing == 0 ==> due <= m->v_base + 500000000); */

/* Makes the values of input v unknown; returns whether they were known. */
/*@ requires \valid(m);
    requires ((m->v_known == 0 || m->v_known == 1));
    assigns m->v_known;
    ensures (m->v_known == 0);
    ensures (\result != 0 <==> (\old(m->v_known) != 0)); */
static bool forget_v(small_monitor *m);

/* Checks whether the timeout of input v has passed. */
/*@ requires \valid(m);
    requires (0 <= m->now <= SMALL_LATEST && 0 <= m->v_base <= SMALL_LATEST && (m->v_missing == 0
      || m->v_missing == 1) && (m->v_known == 0 || m->v_known == 1));
    assigns m->v_missing, m->v_known;
    ensures (m->v_missing == 0 || m->v_missing == 1);
    ensures ((m->v_missing != 0 <==> (\old(m->v_missing) != 0 || m->v_base + 500000000 <= m->now))
      && m->v_known == ((\old(m->v_missing) == 0 && m->v_base + 500000000 <= m->now) ? 0 :
      \old(m->v_known))); */
static void expire_v(small_monitor *m);
