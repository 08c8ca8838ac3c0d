/* action stop; input v = topic /levels.data entity e { r: v.max() > 1 or v.min() < 1 or v.count() = 0; } if e.r then { stop; }; */

static int64_t least_int16(const int16_t *values, size_t count)
{
  int64_t found = 0;
  /* 9 lines of few_numbers */
}

static int64_t greatest_int16(const int16_t *values, size_t count)
{
  int64_t found = 0;
  /*@ loop invariant 0 <= i <= count;
  /* 8 lines of numbers */
}

static bool observe_v(small_monitor *m, const int16_t *data, size_t data_count)
{
  bool news = false;
  if ((data_count <= SMALL_MOST_ELEMENTS)) {
    news = store_integer(&m->v_max, greatest_int16(data, data_count), news);
    news = store_truth(&m->v_max_known, (data_count > 0U), news);
    news = store_integer(&m->v_min, least_int16(data, data_count), news);
    news = store_truth(&m->v_min_known, (data_count > 0U), news);
    news = store_integer(&m->v_count, (int64_t)data_count, news);
    news = store_truth(&m->v_count_known, true, news);
  /* 4 lines of element */
}
