/*
* The contracts of the functions of small_monitor.c, written from the rules.
… 5 lines of contracts.h.j2: *
#ifndef SMALL_CONTRACTS_H_
#define SMALL_CONTRACTS_H_

/* *INDENT-OFF* */
… 11 lines of emissions.py: /* All events so far, as one value. after() gives that of one event more, and may be any function;
/*@ assigns emitted;
    ensures emitted == after(\old(emitted), owner, t, kind, site); */
extern void small_emit(
  void *owner, int64_t t, small_kind kind, uint32_t site);
/*@ logic integer emitted_by_behave_behaviour_1(integer events, void *owner, integer now, integer
  was_behaviour_1_condition, integer behaviour_1_condition) =
      ((behaviour_1_condition == SMALL_TRUE && was_behaviour_1_condition != SMALL_TRUE) ?
        after(events, owner, now, SMALL_TRIGGER, 0) : events); */
/*@ logic integer emitted_by_event(integer events, void *owner, integer now, integer
  was_behaviour_1_condition, integer behaviour_1_condition) =
      emitted_by_behave_behaviour_1(events, owner, now, was_behaviour_1_condition,
        behaviour_1_condition); */
/*@ axiomatic Following { axiom event: \forall integer events, void *owner, integer now, integer
  was_behaviour_1_condition, integer behaviour_1_condition; follows(events,
  emitted_by_event(events, owner, now, was_behaviour_1_condition, behaviour_1_condition)); } */



/* What the rules mean, and what holds of a monitor between two calls. */
#define is_verdict(v) ( \
  ((v) == SMALL_FALSE || (v) == SMALL_UNKNOWN || (v) == SMALL_TRUE))
#define time_of(t) ((t) < 0 ? 0 : (t) > SMALL_LATEST ? SMALL_LATEST : (t))
/*@ predicate judged_e_r(small_monitor *m) =
      (m->e_r == SMALL_TRUE <==> (m->b_known != 0 && (m->b != 0))) &&
      (m->e_r == SMALL_FALSE <==> (m->b_known != 0 && !(m->b != 0))); */
/*@ predicate acted_behave_behaviour_1(small_monitor *m) =
      (m->behaviour_1_condition == SMALL_TRUE <==> (m->e_r == SMALL_TRUE)) &&
      (m->behaviour_1_condition == SMALL_FALSE <==> (m->e_r == SMALL_FALSE)); */
/*@ predicate ranged(small_monitor *m) =
      0 <= m->now <= SMALL_LATEST &&
      is_verdict(m->e_r) &&
      is_verdict(m->behaviour_1_condition) &&
      (m->b_known == 0 || m->b_known == 1) &&
      (m->b == 0 || m->b == 1) &&
      (m->started == 0 || m->started == 1); */
/*@ predicate timeouts_in_time(small_monitor *m, integer due) =
      \true; */
/*@ predicate ends_in_time(small_monitor *m, integer due) =
      \true; */
/*@ predicate unexpired(small_monitor *m) =
      \true; */
/*@ predicate is_end(small_monitor *m, integer t) =
      (t == SMALL_NEVER); */
/*@ predicate judged(small_monitor *m) =
      judged_e_r(m); */
/*@ predicate acted(small_monitor *m) =
      acted_behave_behaviour_1(m); */
/*@ predicate unacted(small_monitor *m) =
      m->behaviour_1_condition == SMALL_UNKNOWN; */
/*@ predicate sane(small_monitor *m) =
      ranged(m) &&
      timeouts_in_time(m, m->due) &&
      ends_in_time(m, m->due) &&
      unexpired(m) &&
      m->due > m->now &&
      (m->started != 0 ==> judged(m) && acted(m)) &&
      (m->started == 0 ==> unacted(m)); */
/* What has become of a monitor since an earlier moment. */
/*@ predicate verdicts_dated{Before, Now}(small_monitor *m) =
      \at(m->e_r_turned == ((m->e_r == SMALL_TRUE && \at(m->e_r, Before) != SMALL_TRUE) || (m->e_r
        != SMALL_TRUE && \at(m->e_r, Before) == SMALL_TRUE) ? m->now : \at(m->e_r_turned, Before)),
        Now); */
/*@ predicate intervals_run_on{Before, Now}(small_monitor *m) =
      \at(\true, Now); */
/*@ predicate states_done{Before, Now}(small_monitor *m) =
      \at(\true, Now); */
/*@ predicate emission_done{Before, Now}(small_monitor *m) =
      \at(emitted == emitted_by_event(\at(emitted, Before), m->owner, m->now,
        \at(m->behaviour_1_condition, Before), m->behaviour_1_condition), Now); */
/*@ predicate nothing_done{Before, Now}(small_monitor *m) =
      \at((m->behaviour_1_condition == \at(m->behaviour_1_condition, Before)) &&
      emitted == \at(emitted, Before), Now); */
/*@ predicate nothing_changed{Before, Now}(small_monitor *m) =
      \at((m->owner == \at(m->owner, Before) && m->due == \at(m->due, Before) && m->e_r_turned ==
        \at(m->e_r_turned, Before) && m->e_r == \at(m->e_r, Before) && m->behaviour_1_condition ==
        \at(m->behaviour_1_condition, Before) && m->b_known == \at(m->b_known, Before) && m->b ==
        \at(m->b, Before) && m->started == \at(m->started, Before)) &&
      emitted == \at(emitted, Before), Now); */
/*@ predicate latched_kept{Before, Now}(small_monitor *m) =
      \at(\true, Now); */
/*@ predicate kept_by_judging{Before, Now}(small_monitor *m) =
      \at((m->owner == \at(m->owner, Before) && m->now == \at(m->now, Before) && m->b_known ==
        \at(m->b_known, Before) && m->b == \at(m->b, Before)), Now); */
/*@ predicate kept_by_deadlines{Before, Now}(small_monitor *m) =
      \at((m->owner == \at(m->owner, Before) && m->b == \at(m->b, Before)), Now); */
/*@ predicate kept_by_time{Before, Now}(small_monitor *m) =
      \at((m->owner == \at(m->owner, Before) && m->b == \at(m->b, Before)), Now); */
/*@ predicate caught_up{Before, Now}(small_monitor *m) =
      \at(follows(\at(emitted, Before), emitted), Now); */
/*@ predicate stepped_back{Before, Now}(small_monitor *m) =
      \at(m->started == 1 &&
      m->e_r_turned == m->now &&
      m->b_known == 0 &&
      emitted == emitted_by_event(after(\at(emitted, Before), m->owner, m->now, SMALL_CLOCK_STEP,
        SMALL_SITE_NONE), m->owner, m->now, \at(m->behaviour_1_condition, Before),
        m->behaviour_1_condition), Now); */

/*@ assigns \nothing;
    ensures \result <= a && \result <= b && (\result == a || \result == b); */
static int64_t earlier(int64_t a, int64_t b);

… 3 lines of helpers.py: /* A time within the range that the monitor counts in. */
static int64_t bounded(int64_t t);

… 5 lines of helpers.py: /* Stores a value; returns whether it has changed, or another one had. */
static bool store_truth(bool *place, bool value, bool news);

… 5 lines of verdicts.py: /* The verdict of a condition, which is unknown unless its values are known. */
static small_verdict truth_of(bool known, bool holds);

… 7 lines of verdicts.py: /* Stores a rule's verdict; returns whether it has changed. */
static bool turned(small_verdict verdict, small_verdict *held, int64_t *since, int64_t now);

/* Makes the values of input b unknown; returns whether they were known. */
/*@ requires \valid(m);
    requires ((m->b_known == 0 || m->b_known == 1));
    assigns m->b_known;
    ensures (m->b_known == 0);
    ensures (\result != 0 <==> (\old(m->b_known) != 0)); */
static bool forget_b(small_monitor *m);

/* The earliest deadline ahead. */
/*@ requires \valid_read(m);
    requires (0 <= m->now <= SMALL_LATEST);
    requires (\true);
    assigns \nothing;
    ensures \result > m->now;
    ensures (\true);
    ensures (\result == SMALL_NEVER); */
static int64_t earliest(const small_monitor *m);

/* Rule e.r (rules.deros:2)
 *   r: b;
 */
/*@ requires \valid(m);
    requires (0 <= m->now <= SMALL_LATEST && (m->b_known == 0 || m->b_known == 1) && (m->b == 0 ||
      m->b == 1));
    assigns m->e_r, m->e_r_turned;
    ensures is_verdict(m->e_r);
    ensures ((m->e_r == SMALL_TRUE <==> (m->b_known != 0 && (m->b != 0))) && (m->e_r == SMALL_FALSE
      <==> (m->b_known != 0 && !(m->b != 0))));
    ensures (\result != 0 <==> m->e_r != \old(m->e_r));
    ensures m->e_r_turned == ((m->e_r == SMALL_TRUE && \old(m->e_r) != SMALL_TRUE) || (m->e_r !=
      SMALL_TRUE && \old(m->e_r) == SMALL_TRUE) ? m->now : \old(m->e_r_turned)); */
static bool judge_e_r(small_monitor *m);

/* Behaviour behaviour_1 (rules.deros:2)
 *   if e.r then { stop; };
 */
/*@ requires \valid(m);
    requires (0 <= m->now <= SMALL_LATEST && is_verdict(m->e_r) &&
      is_verdict(m->behaviour_1_condition));
    assigns m->behaviour_1_condition, emitted;
    ensures is_verdict(m->behaviour_1_condition);
    ensures ((m->behaviour_1_condition == SMALL_TRUE <==> (m->e_r == SMALL_TRUE)) &&
      (m->behaviour_1_condition == SMALL_FALSE <==> (m->e_r == SMALL_FALSE)));
    ensures emitted == emitted_by_behave_behaviour_1(\old(emitted), m->owner, m->now,
      \old(m->behaviour_1_condition), m->behaviour_1_condition); */
static void behave_behaviour_1(small_monitor *m);

/* Runs the behaviours whose conditions turned true, then the resets that they request. */
/*@ requires \valid(m);
    requires (0 <= m->now <= SMALL_LATEST && is_verdict(m->e_r) &&
      is_verdict(m->behaviour_1_condition));
    requires changed == 0 ==> (((m->behaviour_1_condition == SMALL_TRUE <==> (m->e_r ==
      SMALL_TRUE)) && (m->behaviour_1_condition == SMALL_FALSE <==> (m->e_r == SMALL_FALSE))));
    assigns *m, emitted;
    behavior change: assumes changed != 0;
    ensures (m->owner == \old(m->owner) && m->now == \old(m->now) && m->due == \old(m->due) &&
      m->e_r_turned == \old(m->e_r_turned) && m->e_r == \old(m->e_r) && m->b_known ==
      \old(m->b_known) && m->b == \old(m->b) && m->started == \old(m->started));
    ensures (is_verdict(m->behaviour_1_condition));
    ensures ((m->behaviour_1_condition == SMALL_TRUE <==> (m->e_r == SMALL_TRUE)) &&
      (m->behaviour_1_condition == SMALL_FALSE <==> (m->e_r == SMALL_FALSE)));
    ensures emitted == emitted_by_event(\old(emitted), m->owner, m->now,
      \old(m->behaviour_1_condition), m->behaviour_1_condition);
    behavior none: assumes changed == 0;
    ensures (m->owner == \old(m->owner) && m->now == \old(m->now) && m->due == \old(m->due) &&
      m->e_r_turned == \old(m->e_r_turned) && m->e_r == \old(m->e_r) && m->b_known ==
      \old(m->b_known) && m->b == \old(m->b) && m->started == \old(m->started));
    ensures (is_verdict(m->behaviour_1_condition));
    ensures ((m->behaviour_1_condition == SMALL_TRUE <==> (m->e_r == SMALL_TRUE)) &&
      (m->behaviour_1_condition == SMALL_FALSE <==> (m->e_r == SMALL_FALSE)));
    ensures (m->behaviour_1_condition == \old(m->behaviour_1_condition));
    ensures emitted == \old(emitted);
    complete behaviors;
    disjoint behaviors; */
static void act(small_monitor *m, bool changed);

/* Evaluates all rules. */
/*@ requires \valid(m);
    requires (0 <= m->now <= SMALL_LATEST && (m->b_known == 0 || m->b_known == 1) && (m->b == 0 ||
      m->b == 1));
    assigns *m;
    ensures (m->owner == \old(m->owner) && m->now == \old(m->now) && m->due == \old(m->due) &&
      m->behaviour_1_condition == \old(m->behaviour_1_condition) && m->b_known == \old(m->b_known)
      && m->b == \old(m->b) && m->started == \old(m->started));
    ensures (is_verdict(m->e_r));
    ensures ((m->e_r == SMALL_TRUE <==> (m->b_known != 0 && (m->b != 0))) && (m->e_r == SMALL_FALSE
      <==> (m->b_known != 0 && !(m->b != 0))));
    ensures (m->e_r_turned == ((m->e_r == SMALL_TRUE && \old(m->e_r) != SMALL_TRUE) || (m->e_r !=
      SMALL_TRUE && \old(m->e_r) == SMALL_TRUE) ? m->now : \old(m->e_r_turned))); */
static void judge_all(small_monitor *m);

/* Processes one event: all rules, then all behaviours. */
/*@ requires \valid(m);
    requires ranged(m);
    requires timeouts_in_time(m, m->due);
    requires ends_in_time(m, m->due);
    requires unexpired(m);
    requires m->now <= m->due;
    assigns *m, emitted;
    ensures ranged(m);
    ensures timeouts_in_time(m, m->due);
    ensures ends_in_time(m, m->due);
    ensures unexpired(m);
    ensures kept_by_judging{Old, Here}(m);
    ensures m->started == 1;
    ensures judged(m);
    ensures acted(m);
    ensures latched_kept{Old, Here}(m);
    ensures verdicts_dated{Old, Here}(m);
    ensures states_done{Old, Here}(m);
    ensures emission_done{Old, Here}(m);
    ensures intervals_run_on{Old, Here}(m);
    ensures \old(m->due) > m->now ==> m->due > m->now; */
static void evaluate(small_monitor *m);

/* Forgets all inputs and intervals; timeouts count from the time given. */
/*@ requires \valid(m);
    requires 0 <= m->now <= from <= SMALL_LATEST;
    assigns *m;
    ensures (m->owner == \old(m->owner) && m->now == \old(m->now) && m->e_r == \old(m->e_r) &&
      m->behaviour_1_condition == \old(m->behaviour_1_condition) && m->b == \old(m->b) &&
      m->started == \old(m->started));
    ensures (m->e_r_turned == m->now && m->b_known == 0);
    ensures (\true);
    ensures m->due > m->now;
    ensures (m->due == SMALL_NEVER); */
static void restart(small_monitor *m, int64_t from);

/* Advances to the next deadline, processes all that ends there, and finds the one after it. */
/*@ requires \valid(m);
    requires sane(m);
    requires is_end(m, m->due);
    requires m->due <= SMALL_LATEST;
    assigns *m, emitted;
    ensures sane(m);
    ensures is_end(m, m->due);
    ensures m->now == \old(m->due);
    ensures latched_kept{Old, Here}(m);
    ensures caught_up{Old, Here}(m);
    ensures kept_by_deadlines{Old, Here}(m); */
static void reach_deadline(small_monitor *m);

/* Processes the deadlines up to t in order. */
/*@ requires \valid(m);
    requires sane(m);
    requires m->now <= t <= SMALL_LATEST;
    assigns *m, emitted;
    ensures sane(m);
    ensures m->now == t;
    ensures latched_kept{Old, Here}(m);
    ensures caught_up{Old, Here}(m);
    ensures kept_by_deadlines{Old, Here}(m); */
static void catch_up(small_monitor *m, int64_t t);

/* Processes a backward step of the clock, to t. */
/*@ requires \valid(m);
    requires sane(m);
    requires 0 <= t < m->now;
    assigns *m, emitted;
    ensures sane(m);
    ensures latched_kept{Old, Here}(m);
    ensures m->now == t;
    ensures stepped_back{Old, Here}(m);
    ensures kept_by_time{Old, Here}(m); */
static void step_back(small_monitor *m, int64_t t);

/* Advances the time to an instant before the next deadline. */
/*@ requires \valid(m);
    requires sane(m);
    requires m->now <= t < m->due;
    requires t <= SMALL_LATEST;
    assigns m->now;
    ensures sane(m);
    ensures m->now == t;
    ensures latched_kept{Old, Here}(m);
    ensures nothing_changed{Old, Here}(m); */
static void pass(small_monitor *m, int64_t t);

/* Advances the monitor to the time of a call. */
/*@ requires \valid(m);
    requires sane(m);
    assigns *m, emitted;
    ensures sane(m);
    ensures latched_kept{Old, Here}(m);
    ensures m->now == time_of(t);
    ensures kept_by_time{Old, Here}(m);
    behavior back: assumes time_of(t) < m->now;
    ensures stepped_back{Old, Here}(m);
    behavior due: assumes m->now <= time_of(t) && m->due <= time_of(t);
    ensures caught_up{Old, Here}(m);
    ensures kept_by_deadlines{Old, Here}(m);
    behavior idle: assumes m->now <= time_of(t) < m->due;
    ensures nothing_changed{Old, Here}(m);
    complete behaviors;
    disjoint behaviors; */
static inline void arrive(small_monitor *m, int64_t t);

/* Initialises all fields that a restart does not set. */
/*@ requires \valid(m);
    assigns *m;
    ensures (m->owner == owner && m->now == time_of(t) && m->e_r == SMALL_UNKNOWN &&
      m->behaviour_1_condition == SMALL_UNKNOWN && m->b_known == 0 && m->started == 0 && m->b ==
      0); */
static void clear(small_monitor *m, void *owner, int64_t t);

/*@ requires \valid(m);
    assigns *m;
    ensures sane(m);
    ensures (m->owner == owner && m->now == time_of(t) && m->e_r == SMALL_UNKNOWN &&
      m->behaviour_1_condition == SMALL_UNKNOWN && m->b_known == 0 && m->started == 0 && m->b ==
      0);
    ensures is_end(m, m->due);
    ensures (m->e_r_turned == m->now && m->b_known == 0); */
void small_start(small_monitor *m, void *owner, int64_t t, int64_t grace);

/*@ requires \valid(m);
    requires sane(m);
    assigns *m, emitted;
    ensures sane(m);
    ensures \result == m->due;
    ensures latched_kept{Old, Here}(m);
    ensures m->now == time_of(t);
    ensures kept_by_time{Old, Here}(m);
    ensures \old(m->now) <= time_of(t) < \old(m->due) ==> nothing_changed{Old, Here}(m); */
int64_t small_advance(small_monitor *m, int64_t t);

/*@ requires \valid_read(m);
    assigns \nothing;
    ensures (\result != 0 <==> (\false)); */
bool small_waiting(const small_monitor *m);

/* Takes the values of a message of /flag; returns whether one has changed. */
/*@ requires \valid(m);
    requires (0 <= m->now <= SMALL_LATEST && (m->b_known == 0 || m->b_known == 1) && (m->b == 0 ||
      m->b == 1));
    assigns m->b_known, m->b;
    ensures (0 <= m->now <= SMALL_LATEST && (m->b_known == 0 || m->b_known == 1) && (m->b == 0 ||
      m->b == 1));
    ensures \result == 0 ==> (m->b_known == \old(m->b_known) && m->b_known == \old(m->b_known) &&
      m->b == \old(m->b));
    ensures (m->b_known == \old(m->b_known) && m->b_known == \old(m->b_known) && m->b ==
      \old(m->b)) ==> \result == 0;
    ensures (m->due == \old(m->due) && m->b_known == 1 && m->b == data); */
static bool observe_b(small_monitor *m, bool data);

/* Evaluates the rules that a message of /flag can change; all rules at the first event. */
/*@ requires \valid(m);
    requires ranged(m);
    requires timeouts_in_time(m, m->due);
    requires ends_in_time(m, m->due);
    requires unexpired(m);
    requires m->due > m->now;
    requires m->started != 0 ==> (acted(m));
    requires m->started != 0 && news == 0 ==> (judged_e_r(m));
    requires (m->started == 0 ==> unacted(m));
    assigns *m, emitted;
    behavior first: assumes m->started == 0;
    ensures ranged(m);
    ensures timeouts_in_time(m, m->due);
    ensures ends_in_time(m, m->due);
    ensures unexpired(m);
    ensures m->due > m->now;
    ensures m->started == 1;
    ensures judged(m);
    ensures acted(m);
    ensures latched_kept{Old, Here}(m);
    ensures kept_by_judging{Old, Here}(m);
    ensures verdicts_dated{Old, Here}(m);
    ensures intervals_run_on{Old, Here}(m);
    ensures states_done{Old, Here}(m);
    ensures emission_done{Old, Here}(m);
    behavior news: assumes m->started != 0 && news != 0;
… 12 lines as above: ensures ranged(m);
    ensures (m->e_r != \old(m->e_r)) ==> states_done{Old, Here}(m);
    ensures (m->e_r != \old(m->e_r)) ==> emission_done{Old, Here}(m);
    ensures !(m->e_r != \old(m->e_r)) ==> nothing_done{Old, Here}(m);
    behavior none: assumes m->started != 0 && news == 0;
… 12 lines as above: ensures ranged(m);
    ensures nothing_done{Old, Here}(m);
    complete behaviors;
    disjoint behaviors; */
static void after_b(small_monitor *m, bool news);

/* Processes a message of /flag that arrives now. */
/*@ requires \valid(m);
    requires sane(m);
    assigns *m, emitted;
… 9 lines as above: ensures ranged(m);
    ensures m->now == \old(m->now);
    ensures (m->owner == \old(m->owner));
    ensures (m->b_known == 1 && m->b == data); */
static void take_b(small_monitor *m, bool data);

… 12 lines as above: /*@ requires \valid(m);
    ensures m->now == time_of(t);
    ensures (m->owner == \old(m->owner));
    ensures (m->b_known == 1 && m->b == data); */
void small_on_b(small_monitor *m, int64_t t, bool data);

#endif  /* SMALL_CONTRACTS_H_ */
