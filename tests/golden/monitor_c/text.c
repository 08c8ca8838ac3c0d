/* action stop; input v = topic /state.data entity e { r: v = "säge" or v != "\"??/"; } if e.r then { stop; }; */

  /* 6 lines of smallest */
  uint32_t v;  /* as of the last message */
  /* 3 lines of smallest */
  bool started;  /* whether there has been an event */
} small_monitor;

/* Returns whether a text is the expected one. */
… 15 lines of helpers.py: static bool is_text(
/* Stores a value; returns whether it has changed, or another one had. */
static bool store_text(uint32_t *place, uint32_t value, bool news)
… 6 lines of helpers.py: {
/* The position of a text among those that v is compared with; 0 if it is none of them. */
static uint32_t which_v(const char *text, size_t length)
{
  uint32_t place = 0U;
  if (is_text(text, length, "s\303\244" "ge", 5U)) {
    place = 1U;
  }
  if (is_text(text, length, "\"\?\?/", 4U)) {
    place = 2U;
… 4 lines of body.c.j2: }
static bool judge_e_r(small_monitor *m)
{
  const small_verdict verdict = either(
    truth_of(m->v_known, m->v == 1U),
    truth_of(m->v_known, m->v != 2U));
  return turned(verdict, &m->e_r, &m->e_r_turned, m->now);
}

static bool observe_v(small_monitor *m, const char *data, size_t data_length)
{
  /* 2 lines of smallest */
  news = store_text(&m->v, which_v(data, data_length), news);
  return news;
}
