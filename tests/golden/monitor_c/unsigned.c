/* action stop; input v = topic /beats.data entity e { r: v > 5; } if e.r then { stop; }; */

  /* 5 lines of smallest */
  uint64_t v;  /* as of the last message */
  /* 4 lines of smallest */
  bool started;  /* whether there has been an event */
} small_monitor;

/* Stores a value; returns whether it has changed, or another one had. */
static bool store_unsigned(uint64_t *place, uint64_t value, bool news)
… 6 lines of helpers.py: {
static bool judge_e_r(small_monitor *m)
{
  const small_verdict verdict = truth_of(m->v_known, m->v > 5ULL);
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}

static bool observe_v(small_monitor *m, uint64_t data)
{
  /* 2 lines of smallest */
  news = store_unsigned(&m->v, data, news);
  return news;
}
