/* action stop; input v = topic /odom.twist.twist.linear.x timeout 0.5 sec entity e { failsafe r: v > 1 or v.unknown(); } if e.r then { stop; }; */

/*@ predicate judged_e_r(small_monitor *m) =
      (m->e_r == SMALL_TRUE <==> (((m->v_known != 0 && (m->v_above_1 != 0)) || (m->v_known == 0 &&
        (m->v_came != 0 || m->v_missing != 0))) || (!(((m->v_known != 0 && !(m->v_above_1 != 0)) &&
        (m->v_known != 0 || !(m->v_came != 0 || m->v_missing != 0)))) && (m->v_came != 0 ||
        m->v_missing != 0)))) &&
      (m->e_r == SMALL_FALSE <==> ((m->v_known != 0 && !(m->v_above_1 != 0)) && (m->v_known != 0 ||
        !(m->v_came != 0 || m->v_missing != 0)))); */
