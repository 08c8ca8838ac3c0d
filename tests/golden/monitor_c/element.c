/* action stop; input v = topic /diagnostics.status[1].level entity e { r: v > 1; } if e.r then { stop; }; */

static bool observe_v(small_monitor *m, int64_t status_1_level, bool status_1_level_given)
{
  bool news = false;
  if (status_1_level_given) {
    news = store_truth(&m->v_known, true, news);
    news = store_integer(&m->v, status_1_level, news);
  /* 4 lines of comparison */
}
