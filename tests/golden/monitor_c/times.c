/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1.5 3 times within 2 sec; } if e.r then { stop; }; */

  /* 7 lines of comparison */
  int64_t e_r_end_1;  /* until when the last turn counts */
  int64_t e_r_end_2;  /* until when the turn counts that is the last but 1 */
  int64_t e_r_end_3;  /* until when the turn counts that is the last but 2 */
  /* 4 lines of comparison */
  bool e_r_held;  /* whether what is counted is true */
  bool started;  /* whether there has been an event */
} small_monitor;

… 5 lines of helpers.py: static int64_t ahead(int64_t now, int64_t due, int64_t end)
/* 'times within': true if the operand turned true so often; else unknown where the operand is. */
… 13 lines of verdicts.py: static small_verdict counted(small_verdict operand, bool often)
… 3 lines of body.c.j2: static int64_t earliest(const small_monitor *m)
  if (m->e_r_end_3 != 0) {
    due = ahead(m->now, due, m->e_r_end_3);
  /* 2 lines of duration */
}

static bool judge_e_r(small_monitor *m)
{
  const small_verdict times_1_operand = truth_of(m->v_known, m->v_above_1_5);
  if ((times_1_operand == SMALL_TRUE) && (!m->e_r_held)) {
    m->e_r_end_3 = m->e_r_end_2;
    m->e_r_end_2 = m->e_r_end_1;
    m->e_r_end_1 = m->now + INT64_C(2000000000);
    m->due = ahead(m->now, m->due, m->e_r_end_3);
  }
  m->e_r_held = (times_1_operand == SMALL_TRUE);
  const small_verdict times_1 = counted(times_1_operand, m->now < m->e_r_end_3);
  const small_verdict verdict = times_1;
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}

static void restart(small_monitor *m, int64_t from)
{
  /* 2 lines of smallest */
  m->e_r_end_1 = 0;
  m->e_r_end_2 = 0;
  m->e_r_end_3 = 0;
  m->e_r_held = false;
  /* 2 lines of smallest */
}
