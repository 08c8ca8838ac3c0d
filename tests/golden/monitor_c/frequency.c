/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v.frequency(3) < 8 Hz or not v.frequency(2) <= 50 Hz; } if e.r then { stop; }; */

  /* 5 lines of smallest */
  int64_t v_stamp_1;  /* when its last message came */
  int64_t v_stamp_2;  /* when the last message but 1 came */
  int64_t v_stamp_3;  /* when the last message but 2 came */
  /* 3 lines of smallest */
  bool started;  /* whether there has been an event */
} small_monitor;

… 3 lines of body.c.j2: static int64_t earliest(const small_monitor *m)
  due = ahead(m->now, due, m->v_stamp_3 + INT64_C(375000001));
  due = ahead(m->now, due, m->v_stamp_2 + INT64_C(40000000));
  return due;
}

static bool judge_e_r(small_monitor *m)
{
  const small_verdict verdict = either(
    truth_of(true, (m->now - m->v_stamp_3) >= INT64_C(375000001)),
    negated(truth_of(true, (m->now - m->v_stamp_2) >= INT64_C(40000000))));
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}

static void restart(small_monitor *m, int64_t from)
{
  m->v_stamp_1 = from;
  m->v_stamp_2 = from;
  m->v_stamp_3 = from;
  m->e_r_turned = m->now;
  m->due = earliest(m);
}

static bool observe_v(small_monitor *m, double twist_twist_linear_x)
{
  /* 2 lines of comparison */
    m->v_stamp_3 = m->v_stamp_2;
    m->v_stamp_2 = m->v_stamp_1;
    m->v_stamp_1 = m->now;
    news = true;  /* its frequency is another */
    m->due = ahead(m->now, m->due, m->v_stamp_3 + INT64_C(375000001));
    m->due = ahead(m->now, m->due, m->v_stamp_2 + INT64_C(40000000));
  /* 2 lines of comparison */
}
