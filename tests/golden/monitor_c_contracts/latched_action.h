/* action stop latched; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1.5; } if e.r then { stop; }; */

/*@ predicate latched_kept{Before, Now}(small_monitor *m) =
      \at((\at(m->stop_active, Before) != 0 ==> m->stop_active != 0), Now); */

/* Action stop is latched (rules.deros:2) */
/*@ requires \valid(m);
    requires ((m->stop_active == 0 || m->stop_active == 1) &&
      is_verdict(m->behaviour_1_condition));
    assigns m->stop_active, emitted;
    ensures m->stop_active == ((m->behaviour_1_condition == SMALL_FALSE) ? 0 :
      \old(m->stop_active));
    ensures emitted == emitted_by_settle_stop(\old(emitted), m->owner, m->now,
      \old(m->stop_active), m->behaviour_1_condition); */
static void settle_stop(small_monitor *m);

/*@ requires \valid(m);
    requires sane(m);
    assigns m->stop_active;
    ensures sane(m);
    ensures m->stop_active == 1; */
void small_latch_stop(small_monitor *m);

/*@ requires \valid(m);
    requires sane(m);
    assigns *m, emitted;
    ensures sane(m);
    ensures m->now == time_of(t);
    ensures kept_by_time{Old, Here}(m);
    ensures \old(m->stop_active) != 0 && !(m->behaviour_1_condition == SMALL_FALSE) ==>
      m->stop_active != 0;
    ensures m->behaviour_1_condition == SMALL_FALSE ==> m->stop_active == 0;
    ensures \old(m->now) <= time_of(t) < \old(m->due) ==> ((m->behaviour_1_condition == SMALL_FALSE
      || m->stop_active == \old(m->stop_active)) && emitted ==
      emitted_by_settle_stop(\old(emitted), m->owner, m->now, \old(m->stop_active),
      m->behaviour_1_condition));
    ensures (\result != 0 <==> (m->stop_active == 0)); */
bool small_reset(small_monitor *m, int64_t t);
