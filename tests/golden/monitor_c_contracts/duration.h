/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1.5 for 2 sec; } if e.r then { stop; }; */

/*@ predicate judged_e_r(small_monitor *m) =
      (m->e_r_since != SMALL_UNSET <==> (m->v_known != 0 && (m->v_above_1_5 != 0))) &&
      (m->e_r == SMALL_TRUE <==> (m->e_r_since != SMALL_UNSET && (m->now >= m->e_r_since +
        2000000000))) &&
      (m->e_r == SMALL_FALSE <==> ((m->v_known != 0 && !(m->v_above_1_5 != 0)) || (m->e_r_since !=
        SMALL_UNSET && !(m->now >= m->e_r_since + 2000000000)))); */

/*@ predicate ends_in_time(small_monitor *m, integer due) =
      (m->e_r_since != SMALL_UNSET && m->e_r_since + 2000000000 > m->now ==> due <= m->e_r_since +
        2000000000); */

/*@ predicate intervals_run_on{Before, Now}(small_monitor *m) =
      \at(((m->e_r_since != SMALL_UNSET ==> m->e_r_since == (\at(m->e_r_since, Before) ==
        SMALL_UNSET ? m->now : \at(m->e_r_since, Before)))) &&
      m->due == \min(\at(m->due, Before), (\at(m->e_r_since, Before) == SMALL_UNSET && m->e_r_since
        != SMALL_UNSET ? m->now + 2000000000 : SMALL_NEVER)), Now); */

… 14 lines of verdicts.py: /* 'for': true once the operand has been true without a break for so long, since *since. */
  small_verdict operand, int64_t duration, int64_t now, int64_t *since, int64_t *due);

/* The earliest deadline ahead. */
/*@ requires \valid_read(m);
    requires (0 <= m->now <= SMALL_LATEST && (m->e_r_since == SMALL_UNSET || 0 <= m->e_r_since <=
      m->now));
    requires (\true);
    assigns \nothing;
    ensures \result > m->now;
    ensures ((m->e_r_since != SMALL_UNSET && m->e_r_since + 2000000000 > m->now ==> \result <=
      m->e_r_since + 2000000000));
    ensures (\result == SMALL_NEVER || (m->e_r_since != SMALL_UNSET && \result == m->e_r_since +
      2000000000)); */
static int64_t earliest(const small_monitor *m);
