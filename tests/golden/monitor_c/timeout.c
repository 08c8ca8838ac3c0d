/* action stop; input v = topic /odom.twist.twist.linear.x timeout 0.5 sec entity e { r: v > 1 or v.missing() or v.age() > 0.2 sec; } if e.r then { stop; }; */

  /* 5 lines of comparison */
  int64_t v_base;  /* when its timeout began */
  /* 4 lines of comparison */
  bool v_came;  /* whether a message has counted */
  bool v_missing;  /* whether its timeout has passed */
  bool v_known;  /* whether v is known */
  bool v_above_1;  /* how values compare */
  bool started;  /* whether there has been an event */
} small_monitor;

/* The earlier of two deadlines, of which the second counts only if it is in the future. */
… 5 lines of helpers.py: static int64_t ahead(int64_t now, int64_t due, int64_t end)
… 3 lines of body.c.j2: static int64_t earliest(const small_monitor *m)
  if (!m->v_missing) {
    due = earlier(due, m->v_base + INT64_C(500000000));
  }
  if (m->v_came) {
    due = ahead(m->now, due, m->v_base + INT64_C(200000001));
  }
  return due;
}

static bool judge_e_r(small_monitor *m)
{
  const small_verdict verdict = either(
    either(truth_of(m->v_known, m->v_above_1), truth_of(true, m->v_missing)),
    truth_of(m->v_came, (m->now - m->v_base) > INT64_C(200000000)));
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}

/* Checks whether the timeout of input v has passed. */
static void expire_v(small_monitor *m)
{
  const bool passed = ((m->v_base + INT64_C(500000000)) <= m->now);
  if (passed && (!m->v_missing)) {
    m->v_missing = true;
    (void)forget_v(m);
  }
}

static void expire(small_monitor *m)
{
  expire_v(m);
}

static void restart(small_monitor *m, int64_t from)
{
  m->v_base = from;
  m->e_r_turned = m->now;
  m->v_came = false;
  m->v_missing = false;
  /* 2 lines of smallest */
}

… 4 lines of body.c.j2: static void reach_deadline(small_monitor *m)
  /* 2 lines of smallest */
}

… 3 lines of body.c.j2: bool small_waiting(const small_monitor *m)
  if ((!m->v_came) && (!m->v_missing)) {
    waiting = true;
  }
  return waiting;
}

static bool observe_v(small_monitor *m, double twist_twist_linear_x)
{
  /* 4 lines of comparison */
    news = store_truth(&m->v_above_1, m->v > 1.0, news);
    m->v_base = m->now;
    m->v_came = true;
    news = store_truth(&m->v_missing, false, news);
    news = true;  /* its age is another */
    m->due = earlier(m->due, m->now + INT64_C(200000001));
  /* 4 lines of comparison */
}
