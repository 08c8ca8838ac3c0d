/* action stop; input v = topic /counters.data entity e { r: v.max() > 1; } if e.r then { stop; }; */

static uint64_t greatest_uint64(const uint64_t *values, size_t count)
{
  uint64_t found = 0;
  /* 9 lines of integers */
}

static bool observe_v(small_monitor *m, const uint64_t *data, size_t data_count)
{
  /* 2 lines of integers */
    news = store_unsigned(&m->v_max, greatest_uint64(data, data_count), news);
    news = store_truth(&m->v_max_known, (data_count > 0U), news);
  /* 4 lines of integers */
}
