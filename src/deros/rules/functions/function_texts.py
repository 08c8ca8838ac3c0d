"""The texts of the functions in Python and C99: short, as whoever certifies a node reads them.

Property tests hold them equal to :mod:`.function_values`.
"""

from __future__ import annotations

from deros.rules.functions.scan_texts import SCANS_IN_C, SCANS_IN_PYTHON

PYTHON_OF_UNIT: dict[str, tuple[str, ...]] = {
    "roll": (
        "sine = 2.0 * (uw * ux + uy * uz)",
        "cosine = 1.0 - 2.0 * (ux * ux + uy * uy)",
        "math.atan2(sine, cosine)",
    ),
    "pitch": (
        "sine = 2.0 * (uw * uy - uz * ux)",
        "if not -1.0 <= sine <= 1.0:",
        "    sine = math.copysign(1.0, sine)",
        "math.asin(sine)",
    ),
    "yaw": (
        "sine = 2.0 * (uw * uz + ux * uy)",
        "cosine = 1.0 - 2.0 * (uy * uy + uz * uz)",
        "math.atan2(sine, cosine)",
    ),
    "tilt": ("2.0 * math.atan2(math.sqrt(ux * ux + uy * uy), math.sqrt(uz * uz + uw * uw))",),
}
"""Lines by the function's name, on a quaternion of length 1 with the parts ux, uy, uz, uw.

The last one is the result, an expression.
"""

PYTHON: dict[str, str] = {
    "norm": '''\
def vector_norm(x: float, y: float, z: float) -> float:
    """Return the length of a vector."""
    return math.sqrt(x * x + y * y + z * z)
''',
    "rate": '''\
def rate_per_second(value: float, previous: float, elapsed_ns: int) -> float | None:
    """Return the change per second; None for two messages of one instant."""
    if elapsed_ns == 0:
        return None
    change = (value - previous) / (elapsed_ns / 1e9)
    return None if math.isnan(change) else change
''',
    "rate_over": '''\
class RateWindow:
    """The samples, nine at most, that a rate over a span of time needs."""

    __slots__ = ('latest', 'stamps', 'values')

    def __init__(self) -> None:
        """Start without samples."""
        self.stamps: list[int] = []
        self.values: list[float] = []
        self.latest = 0

    def rate(self, value: float, stamp: int | None, span: int) -> float | None:
        """Return the change per second since the newest sample that lies the span back."""
        stamps, values = self.stamps, self.values
        unknown = value != value
        if unknown or (stamp is not None and stamps and stamp < self.latest):
            stamps.clear()
            values.clear()
        if unknown or stamp is None or (stamps and stamp == self.latest):
            return None
        while len(stamps) > 1 and stamp - stamps[1] >= span:
            del stamps[0], values[0]
        change = None
        if stamps and stamp - stamps[0] >= span:
            change = rate_per_second(value, values[0], stamp - stamps[0])
        if not stamps or stamp - stamps[-1] >= -(-span // 8):
            stamps.append(stamp)
            values.append(value)
        self.latest = stamp
        return change
''',
    "stamp_of": '''\
def stamp_of(sec: int, nanosec: int) -> int | None:
    """Return the time of a header; None for zero, which means that it has no stamp."""
    if sec < 0 or not 0 <= nanosec < 1_000_000_000:
        return None
    return (sec * 1_000_000_000 + nanosec) or None
''',
    "latency": '''\
def latency_of(received: int, sec: int, nanosec: int) -> float | None:
    """Return the seconds from a header's stamp to the receipt; None without a stamp."""
    stamp = stamp_of(sec, nanosec)
    return None if stamp is None or received < 0 else (received - stamp) / 1e9
''',
    "unwrapped": '''\
def unwrapped(value: float, turn: float, previous: float, total: float) -> float:
    """Return an unwrapped angle: the total changes by the shortest way."""
    change = value - previous
    return total + math.remainder(change, turn) if math.isfinite(change) else float(value)
''',
    "min": '''\
def array_min(values: Sequence[float]) -> float | None:
    """Return the least element; None for an empty array."""
    if isinstance(values, np.ndarray) and len(values):
        return values[values.argmin()].item()
    return min(values, default=None)
''',
    "max": '''\
def array_max(values: Sequence[float]) -> float | None:
    """Return the greatest element; None for an empty array."""
    if isinstance(values, np.ndarray) and len(values):
        return values[values.argmax()].item()
    return max(values, default=None)
''',
    **SCANS_IN_PYTHON,
}
"""Definitions in Python by the function's name; ``None`` is *unknown*."""

C: dict[str, str] = {
    "rate": """\
static double rate(double value, int64_t t, double *last, int64_t *last_t)
{
  const int64_t elapsed = t - *last_t;
  double change = NAN;
  if (elapsed != 0) {
    change = (value - *last) / ((double)elapsed / 1e9);
  }
  *last = value;
  *last_t = t;
  return change;
}
""",
    "rate_over": """\
static double rate_over(double value, int64_t stamp, int64_t span, @_window *w)
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
""",
    "base_of": """\
static uint32_t base_of(const @_window *w, int64_t stamp, int64_t span)
{
  uint32_t base = 0U;
  for (uint32_t i = 1U; i < w->count; ++i) {
    if (between(w->stamps[i], stamp) >= span) {
      base = i;
    }
  }
  return base;
}
""",
    "drop": """\
static void drop(@_window *w, uint32_t first)
{
  for (uint32_t i = first; i < w->count; ++i) {
    w->stamps[i - first] = w->stamps[i];
    w->values[i - first] = w->values[i];
  }
  w->count -= first;
}
""",
    "keep": """\
static void keep(@_window *w, double value, int64_t stamp, int64_t span)
{
  const uint32_t count = w->count;
  bool apart = (count == 0U);
  if ((count > 0U) && (count < $_SAMPLES)) {
    apart = (between(w->stamps[count - 1U], stamp) >= ((span + 7) / 8));
  }
  if (apart) {
    w->stamps[count] = stamp;
    w->values[count] = value;
    w->count = count + 1U;
  }
  w->latest = stamp;
}
""",
    "between": """\
static int64_t between(int64_t earlier, int64_t later)
{
  int64_t elapsed = 0;
  if ((0 <= earlier) && (earlier < later)) {
    elapsed = later - earlier;
  }
  return elapsed;
}
""",
    "stamp_of": """\
static int64_t stamp_of(int64_t sec, int64_t nanosec)
{
  const int64_t billion = INT64_C(1000000000);
  int64_t stamp = -1;
  if ((0 <= sec) && (sec <= INT32_MAX) && (0 <= nanosec) && (nanosec < billion)) {
    stamp = (sec * billion) + nanosec;
  }
  return (stamp > 0) ? stamp : -1;
}
""",
    "latency": """\
static double latency(int64_t received, int64_t sec, int64_t nanosec)
{
  const int64_t stamp = stamp_of(sec, nanosec);
  const bool known = (0 <= stamp) && (0 <= received);
  const int64_t delay = known ? (received - stamp) : 0;
  return known ? ((double)delay / 1e9) : NAN;
}
""",
    "unwrapped": """\
static double unwrapped(double value, double turn, double *last, double *total)
{
  const double way = remainder(value - *last, turn);
  if (is_number(way)) {
    *total += way;
  } else {
    *total = value;
  }
  *last = value;
  return *total;
}
""",
    "magnitude": """\
static int64_t magnitude(int64_t value)
{
  return (value < 0) ? -value : value;
}
""",
    **SCANS_IN_C,
}
"""Definitions in C99 by the function's name; ``NAN`` is *unknown*.

They need ``<math.h>``, the fixed-width integers, ``bool`` and ``is_number``. Those of scans call
``in_sector`` and ``beam``, the distance that a beam shows; ``magnitude`` is ``abs`` of an integer.
"""
