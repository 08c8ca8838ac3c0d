/* action stop reset_by ok; action ok; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1; s: v < 0; } if e.r then { stop; }; if e.s then { ok; }; */

/*@ logic integer emitted_by_settle_stop(integer events, void *owner, integer now, integer
  stop_active, integer ok_ran, integer behaviour_1_condition) =
      (stop_active != 0 && ok_ran != 0 ? after(events, owner, now, (behaviour_1_condition ==
        SMALL_FALSE ? SMALL_RESET : SMALL_REFUSED), 2) : events); */

/* Action stop is reset by ok (rules.deros:2) */
/*@ requires \valid(m);
    requires ((m->stop_active == 0 || m->stop_active == 1) && is_verdict(m->behaviour_1_condition)
      && (m->ok_ran == 0 || m->ok_ran == 1));
    assigns m->stop_active, emitted;
    ensures m->stop_active == ((m->behaviour_1_condition == SMALL_FALSE && m->ok_ran != 0) ? 0 :
      \old(m->stop_active));
    ensures emitted == emitted_by_settle_stop(\old(emitted), m->owner, m->now,
      \old(m->stop_active), m->ok_ran, m->behaviour_1_condition); */
static void settle_stop(small_monitor *m);
