/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v.rate(1 sec) > 2; } if e.r then { stop; }; */

/* The most samples that a rate over a span of time keeps, however fast messages come. */
#define SMALL_SAMPLES 9U

… 3 lines of monitor.h.j2: /* The samples of a rate over a span of time, the oldest first, and the latest stamp. */
  int64_t stamps[SMALL_SAMPLES];
  double values[SMALL_SAMPLES];
  int64_t latest;
  uint32_t count;
} small_window;

  /* 2 lines of smallest */
  small_window v_window;  /* its samples */
  /* 3 lines of smallest */
  double v_rate_over;  /* as of the last message */
  /* 3 lines of smallest */
  bool v_rate_over_known;  /* whether it is known */
  bool v_rate_over_above_2;  /* how values compare */
  bool started;  /* whether there has been an event */
} small_monitor;

/* The time between two stamps; none if the second is not the later one. */
… 9 lines of function_texts.py: static int64_t between(int64_t earlier, int64_t later)
/* The time of a header; negative if it is zero, which means that it has no stamp. */
… 10 lines of function_texts.py: static int64_t stamp_of(int64_t sec, int64_t nanosec)
/* The newest sample that is at least the span old; else the oldest one. */
… 3 lines of function_texts.py: static uint32_t base_of(const small_window *w, int64_t stamp, int64_t span)
… 7 lines of windows.py: /*@ loop invariant 1 <= i && (w->count >= 1 ==> i <= w->count);
… 8 lines of function_texts.py: for (uint32_t i = 1U; i < w->count; ++i) {
/* Drops the samples before one. */
static void drop(small_window *w, uint32_t first)
{
… 11 lines of windows.py: /*@ loop invariant first <= i <= w->count;
… 7 lines of function_texts.py: for (uint32_t i = first; i < w->count; ++i) {
/* Keeps a message as a sample if it lies an eighth of the span after the newest one. */
… 15 lines of function_texts.py: static void keep(small_window *w, double value, int64_t stamp, int64_t span)
/* The change per second since the newest sample at least the span old; NaN without one. */
… 18 lines of function_texts.py: static double rate_over(double value, int64_t stamp, int64_t span, small_window *w)
static bool forget_v(small_monitor *m)
{
  bool news = false;
  news = store_truth(&m->v_rate_over_known, false, news);
  m->v_window.count = 0U;
  return news;
}

static bool observe_v(
  small_monitor *m, double twist_twist_linear_x, int64_t header_stamp_sec,
  int64_t header_stamp_nanosec)
{
  /* 2 lines of comparison */
    const double v_window_rate_over = rate_over(
      twist_twist_linear_x, stamp_of(header_stamp_sec, header_stamp_nanosec), INT64_C(1000000000),
      &m->v_window);
    m->v_rate_over = v_window_rate_over;
    news = store_truth(&m->v_rate_over_known, is_number(m->v_rate_over), news);
    news = store_truth(&m->v_rate_over_above_2, m->v_rate_over > 2.0, news);
  /* 4 lines of comparison */
}
