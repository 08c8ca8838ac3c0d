/* action stop; input v = topic /joints.name entity e { r: v.count() != 6; } if e.r then { stop; }; */

static bool observe_v(small_monitor *m, size_t name_count)
{
  bool news = false;
  news = store_integer(&m->v_count, (int64_t)name_count, news);
  news = store_truth(&m->v_count_known, true, news);
  return news;
}
