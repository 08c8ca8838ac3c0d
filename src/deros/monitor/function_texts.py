"""The texts of the functions, as the targets emit them: Python, and C99.

They are held equal to :mod:`deros.monitor.function_values` by property tests, and are kept short,
because whoever certifies a safety node reads them.
"""

from __future__ import annotations


def _python_of_quaternion(name: str, meaning: str, value: str) -> str:
    return f'''\
def quaternion_{name}(x: float, y: float, z: float, w: float) -> float | None:
    """Return {meaning} in radians; None for a quaternion without length."""
    length = math.hypot(x, y, z, w)
    if not 0.0 < length < math.inf:
        return None
    x, y, z, w = x / length, y / length, z / length, w / length
    return {value}
'''


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


PYTHON: dict[str, str] = {
    "roll": _python_of_quaternion(
        "roll",
        "the rotation about the x axis",
        "math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))",
    ),
    "pitch": _python_of_quaternion(
        "pitch",
        "the rotation about the y axis",
        "math.asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x))))",
    ),
    "yaw": _python_of_quaternion(
        "yaw",
        "the rotation about the z axis",
        "math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))",
    ),
    "tilt": _python_of_quaternion(
        "tilt",
        "the angle of the z axis to the vertical",
        "2.0 * math.atan2(math.hypot(x, y), math.hypot(z, w))",
    ),
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
    return min(values) if len(values) else None
''',
    "max": '''\
def array_max(values: Sequence[float]) -> float | None:
    """Return the greatest element; None for an empty array."""
    return max(values) if len(values) else None
''',
    "nearest": '''\
def scan_nearest(
    ranges: Sequence[float],
    angle_min: float,
    angle_increment: float,
    range_min: float,
    range_max: float,
    start: float,
    end: float,
) -> float | None:
    """Return the least valid range from bearing start to end; None without a valid beam."""
    turn = 2.0 * math.pi
    width = end - start if end >= start else end - start + turn
    shortest = None
    for index, measured in enumerate(ranges):
        if measured == -math.inf:  # too near to measure (REP 117)
            distance = range_min
        elif not measured >= range_min:  # invalid
            continue
        else:
            distance = measured if measured <= range_max else math.inf
        offset = (angle_min + index * angle_increment - start) % turn
        inside = offset <= width + 1e-6 or offset >= turn - 1e-6
        if inside and (shortest is None or distance < shortest):
            shortest = distance
    return shortest
''',
    "scan_usable": '''\
def scan_usable(ranges: Sequence[float], range_min: float) -> bool:
    """Tell whether any beam of the scan is valid."""
    return any(measured >= range_min or measured == -math.inf for measured in ranges)
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
