"""The texts of the functions that read laser scans; see :mod:`.function_texts`."""

from __future__ import annotations

SCANS_IN_PYTHON: dict[str, str] = {
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
    "points_in": '''\
def scan_points_in(
    ranges: Sequence[float], angle_min: float, angle_increment: float, range_min: float,
    range_max: float, start: float, end: float, zero_is_free: bool, reach: float,
    are_inside: Callable[[np.ndarray, np.ndarray], np.ndarray],
) -> int | None:
    """Return how many beams show a point in a zone; None where most beams to it are blind."""
    beams = scan_beams(len(ranges), angle_min, angle_increment, start, end)
    measured = np.asarray(ranges, dtype=float)[beams]
    if not measured.size:
        return None
    near = measured <= reach
    if not measured.min() > 0.0:
        blind = blind_beams(measured, range_min, zero_is_free)
        if 2 * np.count_nonzero(blind) > measured.size:
            return None
        near &= ~blind & (measured != 0.0) if zero_is_free else ~blind
    if range_max < reach:
        near &= (measured <= max(range_max, 0.0)) | (measured < range_min)
    found = near.nonzero()[0]
    if not found.size:
        return 0
    cosines, sines = scan_directions(len(ranges), angle_min, angle_increment)
    shown = np.maximum(measured[found], 0.0)  # -inf is too near to measure (REP 117)
    x, y = shown * cosines[beams][found], shown * sines[beams][found]
    return int(np.count_nonzero(are_inside(x, y)))
''',
    "points": '''\
def scan_points(
    ranges: Sequence[float], angle_min: float, angle_increment: float, range_min: float,
    range_max: float, start: float, end: float, zero_is_free: bool,
) -> int | None:
    """Return how many beams from bearing start to end show a point; None without a beam."""
    beams = scan_beams(len(ranges), angle_min, angle_increment, start, end)
    measured = np.asarray(ranges, dtype=float)[beams]
    if not measured.size:
        return None
    shown = ~blind_beams(measured, range_min, zero_is_free) & (measured < math.inf)
    shown &= (measured <= max(range_max, 0.0)) | (measured < range_min)
    if zero_is_free:
        shown &= measured != 0.0
    return int(np.count_nonzero(shown))
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
    "scan_directions": '''\
@functools.lru_cache(maxsize=8)
def scan_directions(
    count: int, angle_min: float, angle_increment: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the cosines and sines of all beams; cached for scans of the same form."""
    bearings = [angle_min + index * angle_increment for index in range(count)]
    bearings = [each if math.isfinite(each) else 0.0 for each in bearings]  # which none looks into
    return np.array(list(map(math.cos, bearings))), np.array(list(map(math.sin, bearings)))
''',
}
"""Definitions in Python by the function's name."""

SCANS_IN_C: dict[str, str] = {
    "in_sector": """\
static bool in_sector(double bearing, double start, double end)
{
  const double turn = 6.283185307179586;
  double width = end - start;
  double offset = bearing - start;
  if (end < start) {
    width += turn;
  }
  if (!((offset > -turn) && (offset < turn))) {  /* rarely: it is the slowest step */
    offset = fmod(offset, turn);
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
    "points": """\
static double points(
  const float *ranges, size_t count, double angle_min, double angle_increment, double range_min,
  double range_max, double start, double end, bool zero_is_free)
{
  size_t beams = 0U;
  size_t found = 0U;
  for (size_t i = 0U; i < count; ++i) {
    const double bearing = angle_min + ((double)i * angle_increment);
    if (in_sector(bearing, start, end)) {
      beams += 1U;
      if (beam((double)ranges[i], range_min, range_max, zero_is_free) < INFINITY) {
        found += 1U;
      }
    }
  }
  return (beams > 0U) ? (double)found : NAN;
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
"""Definitions in C by the function's name."""
