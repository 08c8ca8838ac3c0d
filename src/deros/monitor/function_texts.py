"""The texts of the functions, as the targets emit them: Python, and C99.

They are held equal to :mod:`deros.monitor.function_values` by property tests, and are kept short,
because whoever certifies a safety node reads them.
"""

from __future__ import annotations


def _c_of_quaternion(name: str, value: str) -> str:
    return f"""\
static double deros_{name}(double x, double y, double z, double w)
{{
  const double length = hypot(hypot(x, y), hypot(z, w));
  if (!(length > 0.0 && length < INFINITY)) {{
    return NAN;
  }}
  x /= length, y /= length, z /= length, w /= length;
  return {value};
}}
"""


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
    "tilt": ("2.0 * math.atan2(math.hypot(ux, uy), math.hypot(uz, uw))",),
}
"""Lines by the function's name, on a quaternion of length 1 with the parts ux, uy, uz, uw.

The last one is the result, an expression.
"""

PYTHON: dict[str, str] = {
    "rate": '''\
def rate_per_second(value: float, previous: float, elapsed_ns: int) -> float | None:
    """Return the change per second; None for two messages of one instant."""
    if elapsed_ns == 0:
        return None
    change = (value - previous) / (elapsed_ns / 1e9)
    return None if math.isnan(change) else change
''',
    "min": '''\
def array_min(values: Sequence[float]) -> float | None:
    """Return the least element; None for an empty array."""
    return np.min(values).item() if len(values) else None
''',
    "max": '''\
def array_max(values: Sequence[float]) -> float | None:
    """Return the greatest element; None for an empty array."""
    return np.max(values).item() if len(values) else None
''',
    "nearest": '''\
@functools.lru_cache(maxsize=64)
def scan_beams(
    count: int, angle_min: float, angle_increment: float, start: float, end: float,
) -> slice | np.ndarray:
    """Return which beams lie from bearing start to end; kept for further scans of this form."""
    turn = 2.0 * math.pi
    width = end - start if end >= start else end - start + turn
    with np.errstate(all='ignore'):
        offsets = (angle_min + np.arange(count) * angle_increment - start) % turn
        beams = np.flatnonzero((offsets <= width + 1e-6) | (offsets >= turn - 1e-6))
    if beams.size and beams[-1] - beams[0] < beams.size:
        return slice(int(beams[0]), int(beams[-1]) + 1)
    return beams


def scan_nearest(
    ranges: Sequence[float], angle_min: float, angle_increment: float, range_min: float,
    range_max: float, start: float, end: float,
) -> float | None:
    """Return the least valid range from bearing start to end; None without a valid beam."""
    beams = scan_beams(len(ranges), angle_min, angle_increment, start, end)
    measured = np.asarray(ranges)[beams]
    if not measured.size:
        return None
    least = float(np.fmin.reduce(measured))  # not NaN, if any is not
    if least == -math.inf:  # too near to measure (REP 117)
        return range_min
    if not least >= range_min:  # invalid, as may be others
        valid = measured[measured >= range_min]
        if not valid.size:
            return None
        least = float(valid.min())
    return least if least <= range_max else math.inf
''',
    "scan_usable": '''\
def scan_usable(ranges: Sequence[float], range_min: float) -> bool:
    """Tell whether any beam of the scan is valid."""
    measured = np.asarray(ranges)
    if not measured.size:
        return False
    return bool(np.fmax.reduce(measured) >= range_min or np.fmin.reduce(measured) == -math.inf)
''',
}
"""Definitions in Python by the function's name; ``None`` is *unknown*."""

C: dict[str, str] = {
    "roll": _c_of_quaternion("roll", "atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))"),
    "pitch": _c_of_quaternion("pitch", "asin(fmax(-1.0, fmin(1.0, 2.0 * (w * y - z * x))))"),
    "yaw": _c_of_quaternion("yaw", "atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))"),
    "tilt": _c_of_quaternion("tilt", "2.0 * atan2(hypot(x, y), hypot(z, w))"),
    "norm": """\
static double deros_norm(double x, double y, double z)
{
  return hypot(hypot(x, y), z);
}
""",
    "rate": """\
static double deros_rate(double value, double previous, long long elapsed_ns)
{
  return elapsed_ns == 0 ? NAN : (value - previous) / ((double)elapsed_ns / 1e9);
}
""",
    "min": """\
static double deros_min(const double * values, size_t count)
{
  double least = count ? values[0] : NAN;
  for (size_t i = 1; i < count; ++i) {
    least = fmin(least, values[i]);
  }
  return least;
}
""",
    "max": """\
static double deros_max(const double * values, size_t count)
{
  double greatest = count ? values[0] : NAN;
  for (size_t i = 1; i < count; ++i) {
    greatest = fmax(greatest, values[i]);
  }
  return greatest;
}
""",
    "count": """\
static double deros_count(const void * values, size_t count)
{
  (void)values;
  return (double)count;
}
""",
    "nearest": """\
static double deros_nearest(
  const double * ranges, size_t count, double angle_min, double angle_increment,
  double range_min, double range_max, double start, double end)
{
  const double turn = 6.283185307179586;
  const double width = end >= start ? end - start : end - start + turn;
  double shortest = NAN;
  for (size_t i = 0; i < count; ++i) {
    double distance = ranges[i];
    if (distance == -INFINITY) {  /* too near to measure (REP 117) */
      distance = range_min;
    } else if (!(distance >= range_min)) {  /* invalid */
      continue;
    } else if (distance > range_max) {
      distance = INFINITY;
    }
    double offset = fmod(angle_min + (double)i * angle_increment - start, turn);
    offset += offset < 0.0 ? turn : 0.0;
    if (offset <= width + 1e-6 || offset >= turn - 1e-6) {
      shortest = fmin(shortest, distance);
    }
  }
  return shortest;
}
""",
    "scan_usable": """\
static int deros_scan_usable(const double * ranges, size_t count, double range_min)
{
  for (size_t i = 0; i < count; ++i) {
    if (ranges[i] >= range_min || ranges[i] == -INFINITY) {
      return 1;
    }
  }
  return 0;
}
""",
}
"""Definitions in C99 by the function's name; ``NAN`` is *unknown*."""
