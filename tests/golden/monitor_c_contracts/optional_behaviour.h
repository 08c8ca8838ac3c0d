/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1.5; } optional behaviour near: if e.r then { stop; }; */

/*@ predicate acted_behave_near(small_monitor *m) =
      (m->near_condition == SMALL_TRUE <==> (m->e_r == SMALL_TRUE && m->near_enabled != 0)) &&
      (m->near_condition == SMALL_FALSE <==> (m->e_r == SMALL_FALSE || m->near_enabled == 0)); */

/*@ requires \valid(m);
    requires sane(m);
    requires (enabled == 0 || enabled == 1);
    assigns *m, emitted;
    ensures sane(m);
    ensures m->near_enabled == enabled;
    ensures latched_kept{Old, Here}(m);
    ensures m->now == time_of(t);
    ensures (m->owner == \old(m->owner) && same(m->v, \old(m->v)) && m->v_above_1_5 ==
      \old(m->v_above_1_5)); */
void small_enable_near(small_monitor *m, int64_t t, bool enabled);
