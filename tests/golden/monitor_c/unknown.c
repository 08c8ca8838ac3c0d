/* action stop; input v = topic /odom.twist.twist.linear.x timeout 0.5 sec entity e { r: v.unknown(); } if e.r then { stop; }; */

static bool judge_e_r(small_monitor *m)
{
  const small_verdict verdict = truth_of(true, (!m->v_known) && (m->v_came || m->v_missing));
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}

static bool observe_v(small_monitor *m, double twist_twist_linear_x)
{
  /* 3 lines of timeout */
    m->v_base = m->now;
    news = store_truth(&m->v_came, true, news);
    news = store_truth(&m->v_missing, false, news);
    m->due = earlier(m->due, m->now + INT64_C(500000000));
  /* 4 lines of timeout */
}
