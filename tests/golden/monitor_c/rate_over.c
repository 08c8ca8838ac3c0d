/* action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v.rate(1 sec) > 2; } if e.r then { stop; }; */

/* The most samples that a rate over a span of time keeps, however fast messages come. */
#define SMALL_SAMPLES 9U

/* The samples of a rate over a span of time, the oldest first, and the latest stamp. */
typedef struct
{
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
static int64_t between(int64_t earlier, int64_t later)
{
  int64_t elapsed = 0;
  if ((0 <= earlier) && (earlier < later)) {
    elapsed = later - earlier;
  }
  return elapsed;
}

/* The time of a header; negative if it is zero, which means that it has no stamp. */
static int64_t stamp_of(int64_t sec, int64_t nanosec)
{
  const int64_t billion = INT64_C(1000000000);
  int64_t stamp = -1;
  if ((0 <= sec) && (sec <= INT32_MAX) && (0 <= nanosec) && (nanosec < billion)) {
    stamp = (sec * billion) + nanosec;
  }
  return (stamp > 0) ? stamp : -1;
}

/* The newest sample that is at least the span old; else the oldest one. */
static uint32_t base_of(const small_window *w, int64_t stamp, int64_t span)
{
  uint32_t base = 0U;
  /*@ loop invariant 1 <= i && (w->count >= 1 ==> i <= w->count);
      loop invariant base == 0 || base < i;
      loop invariant base == 0 || (base < w->count && time_between(w->stamps[base], stamp) >= span);
      loop invariant \forall integer k; base < k < i && k < w->count
        ==> time_between(w->stamps[k], stamp) < span;
      loop assigns i, base;
      loop variant w->count - i; */
  for (uint32_t i = 1U; i < w->count; ++i) {
    if (between(w->stamps[i], stamp) >= span) {
      base = i;
    }
  }
  return base;
}

/* Drops the samples before one. */
static void drop(small_window *w, uint32_t first)
{
  /*@ loop invariant first <= i <= w->count;
      loop invariant \forall integer k; first <= k < i
        ==> w->stamps[k - first] == \at(w->stamps[k], Pre);
      loop invariant \forall integer k; 0 <= k < i - first
        ==> same(w->values[k], \at(w->values[k + first], Pre));
      loop invariant \forall integer k; i - first <= k < SMALL_SAMPLES
        ==> w->stamps[k] == \at(w->stamps[k], Pre);
      loop invariant \forall integer k; i - first <= k < SMALL_SAMPLES
        ==> same(w->values[k], \at(w->values[k], Pre));
      loop assigns i, w->stamps[0 .. SMALL_SAMPLES - 1], w->values[0 .. SMALL_SAMPLES - 1];
      loop variant w->count - i; */
  for (uint32_t i = first; i < w->count; ++i) {
    w->stamps[i - first] = w->stamps[i];
    w->values[i - first] = w->values[i];
  }
  w->count -= first;
}

/* Keeps a message as a sample if it lies an eighth of the span after the newest one. */
static void keep(small_window *w, double value, int64_t stamp, int64_t span)
{
  const uint32_t count = w->count;
  bool apart = (count == 0U);
  if ((count > 0U) && (count < SMALL_SAMPLES)) {
    apart = (between(w->stamps[count - 1U], stamp) >= ((span + 7) / 8));
  }
  if (apart) {
    w->stamps[count] = stamp;
    w->values[count] = value;
    w->count = count + 1U;
  }
  w->latest = stamp;
}

/* The change per second since the newest sample at least the span old; NaN without one. */
static double rate_over(double value, int64_t stamp, int64_t span, small_window *w)
{
  double change = NAN;
  if (!is_number(value) || ((w->count > 0U) && (0 <= stamp) && (stamp < w->latest))) {
    w->count = 0U;
  }
  if (is_number(value) && (0 <= stamp) && ((w->count == 0U) || (stamp > w->latest))) {
    const uint32_t base = base_of(w, stamp, span);
    if ((w->count > 0U) && (between(w->stamps[base], stamp) >= span)) {
      const double elapsed = (double)between(w->stamps[base], stamp);
      change = (value - w->values[base]) / (elapsed / 1e9);
    }
    drop(w, base);
    keep(w, value, stamp, span);
  }
  return change;
}

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
