/* input v = topic /odom.twist.twist.linear.x entity e { r: v > 1; s: stop.active and v > 2; t: not stop.active; } action stop latched; action cut; if e.r then { stop; }; if e.s or e.t and stop.active for 1 sec then { cut; }; */

/*@ predicate judged_e_s(small_monitor *m) =
      (m->e_s == SMALL_TRUE <==> (m->stop_active != 0 && (m->v_known != 0 && (m->v_above_2 != 0))))
        &&
      (m->e_s == SMALL_FALSE <==> (m->stop_active == 0 || (m->v_known != 0 && !(m->v_above_2 !=
        0)))); */

/*@ predicate acted_behave_behaviour_2(small_monitor *m) =
      (m->behaviour_2_since != SMALL_UNSET <==> (m->e_s == SMALL_TRUE || (m->e_t == SMALL_TRUE &&
        m->stop_active != 0))) &&
      (m->behaviour_2_condition == SMALL_TRUE <==> ((m->behaviour_2_since != SMALL_UNSET && (m->now
        >= m->behaviour_2_since + 1000000000)))) &&
      (m->behaviour_2_condition == SMALL_FALSE <==> (((m->e_s == SMALL_FALSE && (m->e_t ==
        SMALL_FALSE || m->stop_active == 0)) || (m->behaviour_2_since != SMALL_UNSET && !(m->now >=
        m->behaviour_2_since + 1000000000))))); */

/* Evaluates the rules of round 2. */
/*@ requires \valid(m);
    requires (0 <= m->now <= SMALL_LATEST && (m->stop_active == 0 || m->stop_active == 1) &&
      (m->v_known == 0 || m->v_known == 1) && (m->v_above_2 == 0 || m->v_above_2 == 1));
    assigns *m;
    ensures (m->owner == \old(m->owner) && m->now == \old(m->now) && m->due == \old(m->due) &&
      same(m->v, \old(m->v)) && m->e_r_turned == \old(m->e_r_turned) && m->behaviour_2_since ==
      \old(m->behaviour_2_since) && m->e_r == \old(m->e_r) && m->behaviour_1_condition ==
      \old(m->behaviour_1_condition) && m->behaviour_2_condition == \old(m->behaviour_2_condition)
      && m->v_known == \old(m->v_known) && m->v_above_1 == \old(m->v_above_1) && m->v_above_2 ==
      \old(m->v_above_2) && m->stop_active == \old(m->stop_active) && m->started ==
      \old(m->started));
    ensures (is_verdict(m->e_s) && is_verdict(m->e_t));
    ensures ((m->e_s == SMALL_TRUE <==> (m->stop_active != 0 && (m->v_known != 0 && (m->v_above_2
      != 0)))) && (m->e_s == SMALL_FALSE <==> (m->stop_active == 0 || (m->v_known != 0 &&
      !(m->v_above_2 != 0)))));
    ensures ((m->e_t == SMALL_TRUE <==> m->stop_active == 0) && (m->e_t == SMALL_FALSE <==>
      m->stop_active != 0));
    ensures (m->e_s_turned == ((m->e_s == SMALL_TRUE && \old(m->e_s) != SMALL_TRUE) || (m->e_s !=
      SMALL_TRUE && \old(m->e_s) == SMALL_TRUE) ? m->now : \old(m->e_s_turned)) && m->e_t_turned ==
      ((m->e_t == SMALL_TRUE && \old(m->e_t) != SMALL_TRUE) || (m->e_t != SMALL_TRUE &&
      \old(m->e_t) == SMALL_TRUE) ? m->now : \old(m->e_t_turned))); */
static void judge_round_2(small_monitor *m);

/* Runs the behaviours whose conditions turned true, then the resets that they request. */
/*@ requires \valid(m);
    requires (0 <= m->now <= SMALL_LATEST && (m->stop_active == 0 || m->stop_active == 1) &&
      (m->v_known == 0 || m->v_known == 1) && (m->v_above_2 == 0 || m->v_above_2 == 1) &&
      is_verdict(m->e_r) && (m->behaviour_2_since == SMALL_UNSET || 0 <= m->behaviour_2_since <=
      m->now) && is_verdict(m->e_s) && is_verdict(m->e_t) && is_verdict(m->behaviour_1_condition)
      && is_verdict(m->behaviour_2_condition));
    requires changed == 0 ==> (((m->e_s == SMALL_TRUE <==> (m->stop_active != 0 && (m->v_known != 0
      && (m->v_above_2 != 0)))) && (m->e_s == SMALL_FALSE <==> (m->stop_active == 0 || (m->v_known
      != 0 && !(m->v_above_2 != 0))))) && ((m->e_t == SMALL_TRUE <==> m->stop_active == 0) &&
      (m->e_t == SMALL_FALSE <==> m->stop_active != 0)) && ((m->behaviour_1_condition == SMALL_TRUE
      <==> (m->e_r == SMALL_TRUE)) && (m->behaviour_1_condition == SMALL_FALSE <==> (m->e_r ==
      SMALL_FALSE))) && ((m->behaviour_2_since != SMALL_UNSET <==> (m->e_s == SMALL_TRUE || (m->e_t
      == SMALL_TRUE && m->stop_active != 0))) && (m->behaviour_2_condition == SMALL_TRUE <==>
      ((m->behaviour_2_since != SMALL_UNSET && (m->now >= m->behaviour_2_since + 1000000000)))) &&
      (m->behaviour_2_condition == SMALL_FALSE <==> (((m->e_s == SMALL_FALSE && (m->e_t ==
      SMALL_FALSE || m->stop_active == 0)) || (m->behaviour_2_since != SMALL_UNSET && !(m->now >=
      m->behaviour_2_since + 1000000000)))))));
    requires (m->behaviour_2_since != SMALL_UNSET && m->behaviour_2_since + 1000000000 > m->now ==>
      m->due <= m->behaviour_2_since + 1000000000);
    assigns *m, emitted;
    behavior change: assumes changed != 0;
    ensures (m->owner == \old(m->owner) && m->now == \old(m->now) && same(m->v, \old(m->v)) &&
      m->e_r_turned == \old(m->e_r_turned) && m->e_r == \old(m->e_r) && m->v_known ==
      \old(m->v_known) && m->v_above_1 == \old(m->v_above_1) && m->v_above_2 == \old(m->v_above_2)
      && m->started == \old(m->started));
    ensures (is_verdict(m->e_s) && is_verdict(m->e_t) && is_verdict(m->behaviour_1_condition) &&
      is_verdict(m->behaviour_2_condition) && (m->stop_active == 0 || m->stop_active == 1));
    ensures ((m->e_s == SMALL_TRUE <==> (m->stop_active != 0 && (m->v_known != 0 && (m->v_above_2
      != 0)))) && (m->e_s == SMALL_FALSE <==> (m->stop_active == 0 || (m->v_known != 0 &&
      !(m->v_above_2 != 0)))));
    ensures ((m->e_t == SMALL_TRUE <==> m->stop_active == 0) && (m->e_t == SMALL_FALSE <==>
      m->stop_active != 0));
    ensures m->e_s_turned == ((m->e_s == SMALL_TRUE && \old(m->e_s) != SMALL_TRUE) || (m->e_s !=
      SMALL_TRUE && \old(m->e_s) == SMALL_TRUE) ? m->now : \old(m->e_s_turned));
    ensures m->e_t_turned == ((m->e_t == SMALL_TRUE && \old(m->e_t) != SMALL_TRUE) || (m->e_t !=
      SMALL_TRUE && \old(m->e_t) == SMALL_TRUE) ? m->now : \old(m->e_t_turned));
    ensures ((m->behaviour_1_condition == SMALL_TRUE <==> (m->e_r == SMALL_TRUE)) &&
      (m->behaviour_1_condition == SMALL_FALSE <==> (m->e_r == SMALL_FALSE)));
    ensures ((m->behaviour_2_since != SMALL_UNSET <==> (m->e_s == SMALL_TRUE || (m->e_t ==
      SMALL_TRUE && m->stop_active != 0))) && (m->behaviour_2_condition == SMALL_TRUE <==>
      ((m->behaviour_2_since != SMALL_UNSET && (m->now >= m->behaviour_2_since + 1000000000)))) &&
      (m->behaviour_2_condition == SMALL_FALSE <==> (((m->e_s == SMALL_FALSE && (m->e_t ==
      SMALL_FALSE || m->stop_active == 0)) || (m->behaviour_2_since != SMALL_UNSET && !(m->now >=
      m->behaviour_2_since + 1000000000))))));
    ensures (\old(m->stop_active) != 0 ==> m->stop_active != 0);
    ensures (m->behaviour_2_since == SMALL_UNSET || 0 <= m->behaviour_2_since <= m->now);
    ensures (m->behaviour_2_since != SMALL_UNSET && m->behaviour_2_since + 1000000000 > m->now ==>
      m->due <= m->behaviour_2_since + 1000000000);
    ensures ((m->behaviour_2_since != SMALL_UNSET ==> m->behaviour_2_since ==
      (\old(m->behaviour_2_since) == SMALL_UNSET ? m->now : \old(m->behaviour_2_since))));
    ensures m->due == \min(\old(m->due), (\old(m->behaviour_2_since) == SMALL_UNSET &&
      m->behaviour_2_since != SMALL_UNSET ? m->now + 1000000000 : SMALL_NEVER));
    ensures m->due <= \old(m->due);
    ensures \old(m->due) > m->now ==> m->due > m->now;
    ensures m->stop_active == ((m->behaviour_1_condition == SMALL_TRUE &&
      \old(m->behaviour_1_condition) != SMALL_TRUE) ? 1 : \old(m->stop_active));
    ensures emitted == emitted_by_event(\old(emitted), m->owner, m->now,
      \old(m->behaviour_1_condition), m->behaviour_1_condition, \old(m->behaviour_2_condition),
      m->behaviour_2_condition);
    behavior none: assumes changed == 0;
… 33 lines as above: ensures (m->owner == \old(m->owner) && m->now == \old(m->now) && same(m->v, \old(m->v)) &&
    ensures (m->e_s == \old(m->e_s) && m->e_t == \old(m->e_t) && m->e_s_turned ==
      \old(m->e_s_turned) && m->e_t_turned == \old(m->e_t_turned) && m->behaviour_1_condition ==
      \old(m->behaviour_1_condition) && m->behaviour_2_condition == \old(m->behaviour_2_condition)
      && m->stop_active == \old(m->stop_active));
    ensures emitted == \old(emitted);
    complete behaviors;
    disjoint behaviors; */
static void act(small_monitor *m, bool changed);

/*@ requires \valid(m);
    requires sane(m);
    requires m->started == 0;
… 11 lines as in latched_action.h: assigns m->stop_active;
    ensures (\result != 0 <==> (m->stop_active == 0)); */
bool small_reset(small_monitor *m, int64_t t);

/* Evaluates the rules that a message of /odom can change; all rules at the first event. */
/*@ requires \valid(m);
    requires ranged(m);
    requires timeouts_in_time(m, m->due);
    requires ends_in_time(m, m->due);
    requires unexpired(m);
    requires m->due > m->now;
    requires m->started != 0 && news == 0 ==> (judged_e_r(m) && judged_e_s(m) && judged_e_t(m) &&
      acted(m));
… 30 lines as in smallest.h: requires (m->started == 0 ==> unacted(m));
    ensures states_done{Old, Here}(m);
    ensures emission_done{Old, Here}(m);
… 16 lines as in smallest.h: behavior none: assumes m->started != 0 && news == 0;
static void after_v(small_monitor *m, bool news);
