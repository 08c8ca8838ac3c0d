/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1.5 for 2 sec; } if e.r then { stop; }; */

/* No time: of an interval, that it is not running, because its operand is not true. */
#define SMALL_UNSET (-1)

  /* 7 lines of comparison */
  int64_t e_r_since;  /* since when its operand has been true */
  /* 5 lines of comparison */
} small_monitor;

/* 'for': true once the operand has been true without a break for so long, since *since. */
… 16 lines of verdicts.py: static small_verdict lasting(
… 3 lines of body.c.j2: static int64_t earliest(const small_monitor *m)
  if (m->e_r_since != SMALL_UNSET) {
    due = ahead(m->now, due, m->e_r_since + INT64_C(2000000000));
  }
  return due;
}

static bool judge_e_r(small_monitor *m)
{
  const small_verdict for_1 = lasting(
    truth_of(m->v_known, m->v_above_1_5),
    INT64_C(2000000000),
    m->now,
    &m->e_r_since,
    &m->due);
  const small_verdict verdict = for_1;
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}

static void restart(small_monitor *m, int64_t from)
{
  /* 2 lines of smallest */
  m->e_r_since = SMALL_UNSET;
  /* 2 lines of smallest */
}
