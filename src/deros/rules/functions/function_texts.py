"""The texts of the functions in Python and C99: short, as whoever certifies a node reads them.

Property tests hold them equal to :mod:`.function_values`.
"""

from __future__ import annotations

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
    "nearest": '''\
def scan_nearest(
    ranges: Sequence[float], angle_min: float, angle_increment: float, range_min: float,
    range_max: float, start: float, end: float, zero_is_free: bool,
) -> float | None:
    """Return the least range from bearing start to end; None where most beams are blind."""
    beams = scan_beams(len(ranges), angle_min, angle_increment, start, end)
    measured = np.asarray(ranges)[beams]
    if not measured.size:
        return None
    least = float(measured.min())
    if not least > 0.0:  # then all are ranges
        blind = blind_beams(measured, range_min, zero_is_free)
        seen = measured[~blind]
        if seen.size < measured.size - seen.size:
            return None
        if zero_is_free:
            seen = seen[seen != 0.0]
        least = max(0.0, float(seen.min(initial=math.inf)))  # 0.0 is too near to measure (REP 117)
    return math.inf if least > max(range_max, 0.0) and least >= range_min else least
''',
    "blind": '''\
def scan_blind(
    ranges: Sequence[float], angle_min: float, angle_increment: float, range_min: float,
    range_max: float, start: float, end: float, zero_is_free: bool,
) -> float | None:
    """Return the share of beams from bearing start to end that are blind; None without a beam."""
    beams = scan_beams(len(ranges), angle_min, angle_increment, start, end)
    measured = np.asarray(ranges)[beams]
    if not measured.size:
        return None
    if measured.min() > 0.0:
        return 0.0
    return np.count_nonzero(blind_beams(measured, range_min, zero_is_free)) / measured.size
''',
    "blind_gap": '''\
def scan_blind_gap(
    ranges: Sequence[float], angle_min: float, angle_increment: float, range_min: float,
    range_max: float, start: float, end: float, zero_is_free: bool,
) -> float | None:
    """Return the widest run of blind beams from bearing start to end; None without a beam."""
    beams = scan_beams(len(ranges), angle_min, angle_increment, start, end)
    measured = np.asarray(ranges)
    if not measured[beams].size:
        return None
    blind = np.zeros(measured.size, dtype=bool)
    blind[beams] = blind_beams(measured[beams], range_min, zero_is_free)
    stops = np.flatnonzero(~blind)
    widest = measured.size
    if stops.size:
        head, tail = stops[0], measured.size - 1 - stops[-1]
        is_round = (measured.size + 1.5) * abs(angle_increment) > 2.0 * math.pi
        ends = head + tail if is_round else max(head, tail)
        widest = max(ends, np.diff(stops).max(initial=1) - 1)
    return float(widest) * abs(angle_increment)
''',
    "scan_usable": '''\
def scan_usable(
    ranges: Sequence[float], range_min: float, range_max: float, zero_is_free: bool,
) -> bool:
    """Return whether any beam of the scan sees."""
    measured = np.asarray(ranges)
    if not measured.size:
        return False
    is_seen = np.fmax.reduce(measured) > 0.0  # not NaN, if any is not
    return bool(is_seen or not blind_beams(measured, range_min, zero_is_free).all())
''',
    "scan_beams": '''\
@functools.lru_cache(maxsize=64)
def scan_beams(
    count: int, angle_min: float, angle_increment: float, start: float, end: float,
) -> slice | np.ndarray:
    """Return the beams from bearing start to end; cached for scans of the same form."""
    turn = 2.0 * math.pi
    width = end - start if end >= start else end - start + turn
    with np.errstate(all='ignore'):
        offsets = (angle_min + np.arange(count) * angle_increment - start) % turn
        beams = np.flatnonzero((offsets <= width + 1e-6) | (offsets >= turn - 1e-6))
    if beams.size and beams[-1] - beams[0] < beams.size:
        return slice(int(beams[0]), int(beams[-1]) + 1)
    return beams


def blind_beams(measured: np.ndarray, range_min: float, zero_is_free: bool) -> np.ndarray:
    """Return which beams say nothing: NaN, negative, and 0 unless it is a range, or free."""
    seen = measured >= 0.0 if zero_is_free or range_min <= 0.0 else measured > 0.0
    return ~(seen | (measured == -math.inf))
''',
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
    "in_sector": """\
static bool in_sector(double bearing, double start, double end)
{
  const double turn = 6.283185307179586;
  double width = end - start;
  double offset = fmod(bearing - start, turn);
  if (end < start) {
    width += turn;
  }
  if (offset < 0.0) {
    offset += turn;
  }
  return (offset <= (width + 1e-6)) || (offset >= (turn - 1e-6));
}
""",
    "beam": """\
static double beam(double measured, double range_min, double range_max, bool zero_is_free)
{
  double distance = NAN;
  if (measured == 0.0) {
    if (zero_is_free) {
      distance = INFINITY;
    } else if (range_min <= 0.0) {
      distance = 0.0;
    } else {
      /* blind */
    }
  } else if (measured == -INFINITY) {  /* too near to measure (REP 117) */
    distance = 0.0;
  } else if (measured > 0.0) {
    distance = ((measured > range_max) && (measured >= range_min)) ? INFINITY : measured;
  } else {
    /* blind */
  }
  return distance;
}
""",
    "nearest": """\
static double nearest(
  const float *ranges, size_t count, double angle_min, double angle_increment, double range_min,
  double range_max, double start, double end, bool zero_is_free)
{
  double shortest = NAN;
  size_t beams = 0U;
  size_t unseen = 0U;
  for (size_t i = 0U; i < count; ++i) {
    const double bearing = angle_min + ((double)i * angle_increment);
    if (in_sector(bearing, start, end)) {
      const double shown = beam((double)ranges[i], range_min, range_max, zero_is_free);
      beams += 1U;
      if (!is_number(shown)) {
        unseen += 1U;
      } else if (!(shortest <= shown)) {
        shortest = shown;
      } else {
        /* another one is nearer */
      }
    }
  }
  return (unseen > (beams - unseen)) ? NAN : shortest;
}
""",
    "blind": """\
static double blind(
  const float *ranges, size_t count, double angle_min, double angle_increment, double range_min,
  double range_max, double start, double end, bool zero_is_free)
{
  size_t beams = 0U;
  size_t unseen = 0U;
  for (size_t i = 0U; i < count; ++i) {
    const double bearing = angle_min + ((double)i * angle_increment);
    if (in_sector(bearing, start, end)) {
      const double shown = beam((double)ranges[i], range_min, range_max, zero_is_free);
      beams += 1U;
      if (!is_number(shown)) {
        unseen += 1U;
      }
    }
  }
  return (beams > 0U) ? ((double)unseen / (double)beams) : NAN;
}
""",
    "blind_gap": """\
static double blind_gap(
  const float *ranges, size_t count, double angle_min, double angle_increment, double range_min,
  double range_max, double start, double end, bool zero_is_free)
{
  const double step = (angle_increment < 0.0) ? -angle_increment : (angle_increment + 0.0);
  size_t beams = 0U;
  size_t head = 0U;
  size_t run = 0U;
  size_t widest = 0U;
  for (size_t i = 0U; i < count; ++i) {
    const double bearing = angle_min + ((double)i * angle_increment);
    const bool inside = in_sector(bearing, start, end);
    const double shown = beam((double)ranges[i], range_min, range_max, zero_is_free);
    run = (inside && !is_number(shown)) ? (run + 1U) : 0U;
    head = (run > i) ? run : head;
    widest = (run > widest) ? run : widest;
    beams += inside ? 1U : 0U;
  }
  if ((((double)count + 1.5) * step) > 6.283185307179586) {  /* the first follows the last */
    const size_t joined = (run > (count - head)) ? count : (run + head);
    widest = (joined > widest) ? joined : widest;
  }
  return (beams > 0U) ? ((double)widest * step) : NAN;
}
""",
    "scan_usable": """\
static bool scan_usable(
  const float *ranges, size_t count, double range_min, double range_max, bool zero_is_free)
{
  bool usable = false;
  for (size_t i = 0U; i < count; ++i) {
    if (is_number(beam((double)ranges[i], range_min, range_max, zero_is_free))) {
      usable = true;
    }
  }
  return usable;
}
""",
}
"""Definitions in C99 by the function's name; ``NAN`` is *unknown*.

They need ``<math.h>``, the fixed-width integers, ``bool`` and ``is_number``. Those of scans call
``in_sector`` and ``beam``, the distance that a beam shows; ``magnitude`` is ``abs`` of an integer.
"""
