/* action stop; input v = topic /mode.data entity e { r: v.abs() > 2; } if e.r then { stop; }; */

… 5 lines of function_texts.py: static int64_t magnitude(int64_t value)
static bool observe_v(small_monitor *m, int64_t data)
{
  bool news = false;
  news = store_integer(&m->v_abs, magnitude(data), news);
  news = store_truth(&m->v_abs_known, true, news);
  return news;
}
