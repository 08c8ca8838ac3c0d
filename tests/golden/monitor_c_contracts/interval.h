/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v in [-1, 1) and not v = 0; } if e.r then { stop; }; */

/*@ predicate judged_e_r(small_monitor *m) =
      (m->e_r == SMALL_TRUE <==> ((m->v_known != 0 && (m->v_within != 0)) && (m->v_known != 0 &&
        !(m->v_is_0 != 0)))) &&
      (m->e_r == SMALL_FALSE <==> ((m->v_known != 0 && !(m->v_within != 0)) || (m->v_known != 0 &&
        (m->v_is_0 != 0)))); */
