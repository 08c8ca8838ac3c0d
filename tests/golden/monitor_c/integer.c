/* action stop; input v = topic /mode.data entity e { r: v in [-3, 5); } if e.r then { stop; }; */

/* Stores a value; returns whether it has changed, or another one had. */
static bool store_integer(int64_t *place, int64_t value, bool news)
… 6 lines of helpers.py: {
static bool judge_e_r(small_monitor *m)
{
  const small_verdict verdict = truth_of(m->v_known, (m->v >= -INT64_C(3)) && (m->v < INT64_C(5)));
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}

static bool observe_v(small_monitor *m, int64_t data)
{
  /* 2 lines of smallest */
  news = store_integer(&m->v, data, news);
  return news;
}
