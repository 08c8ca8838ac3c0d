"""The texts of the functions, as the targets emit them: Python, and C99.

They are held equal to :mod:`deros.monitor.function_values` by property tests, and are kept short,
because whoever certifies a safety node reads them.
"""

from __future__ import annotations


def _c_of_unit(name: str, value: str) -> str:
    return f"""\
static double {name}(double ux, double uy, double uz, double uw)
{{
  return {value};
}}
"""


def _c_extreme(name: str, relation: str) -> str:
    return f"""\
static RESULT {name}_BASE(const ELEMENT *values, size_t count)
{{
  RESULT found = NONE;
  for (size_t i = 0U; i < count; ++i) {{
    if ((i == 0U) || (values[i] {relation} found)) {{
      found = values[i];
    }}
  }}
  return found;
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
    "roll": _c_of_unit(
        "roll", "atan2(2.0 * ((uw * ux) + (uy * uz)), 1.0 - (2.0 * ((ux * ux) + (uy * uy))))"
    ),
    "pitch": _c_of_unit("pitch", "asin(clamped(2.0 * ((uw * uy) - (uz * ux))))"),
    "yaw": _c_of_unit(
        "yaw", "atan2(2.0 * ((uw * uz) + (ux * uy)), 1.0 - (2.0 * ((uy * uy) + (uz * uz))))"
    ),
    "tilt": _c_of_unit(
        "tilt", "2.0 * atan2(sqrt((ux * ux) + (uy * uy)), sqrt((uz * uz) + (uw * uw)))"
    ),
    "length_of": """\
static double length_of(double x, double y, double z, double w)
{
  const double length = sqrt((((x * x) + (y * y)) + (z * z)) + (w * w));
  return ((length > 0.0) && (length < INFINITY)) ? length : NAN;
}
""",
    "clamped": """\
static double clamped(double sine)
{
  return (sine > 1.0) ? 1.0 : ((sine < -1.0) ? -1.0 : sine);
}
""",
    "norm": """\
static double norm(double x, double y, double z)
{
  return sqrt(((x * x) + (y * y)) + (z * z));
}
""",
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
    "magnitude": """\
static int64_t magnitude(int64_t value)
{
  return (value < 0) ? -value : value;
}
""",
    "min": _c_extreme("least", "<"),
    "max": _c_extreme("greatest", ">"),
    "beam": """\
static double beam(
  double measured, double bearing, double range_min, double range_max, double start, double end)
{
  const double turn = 6.283185307179586;
  double width = end - start;
  double offset = fmod(bearing - start, turn);
  double distance = NAN;
  if (end < start) {
    width += turn;
  }
  if (offset < 0.0) {
    offset += turn;
  }
  const bool inside = (offset <= (width + 1e-6)) || (offset >= (turn - 1e-6));
  if (inside && (measured == -INFINITY)) {  /* too near to measure (REP 117) */
    distance = range_min;
  } else if (inside && (measured >= range_min)) {
    distance = (measured > range_max) ? INFINITY : measured;
  } else {
    /* beside the sector, or invalid */
  }
  return distance;
}
""",
    "nearest": """\
static double nearest(
  const float *ranges, size_t count, double angle_min, double angle_increment,
  double range_min, double range_max, double start, double end)
{
  double shortest = NAN;
  for (size_t i = 0U; i < count; ++i) {
    const double bearing = angle_min + ((double)i * angle_increment);
    const double distance = beam((double)ranges[i], bearing, range_min, range_max, start, end);
    if (is_number(distance) && !(shortest <= distance)) {
      shortest = distance;
    }
  }
  return shortest;
}
""",
    "valid_range": """\
static bool valid_range(double measured, double range_min)
{
  return (measured >= range_min) || (measured == -INFINITY);
}
""",
    "scan_usable": """\
static bool scan_usable(const float *ranges, size_t count, double range_min)
{
  bool usable = false;
  for (size_t i = 0U; i < count; ++i) {
    if (valid_range((double)ranges[i], range_min)) {
      usable = true;
    }
  }
  return usable;
}
""",
}
"""Definitions in C99 by the function's name; ``NAN`` is *unknown*.

They need ``<math.h>``, the fixed-width integers and ``bool``, and of each other: ``pitch`` needs
``clamped``. Those of quaternions take the parts divided by ``length_of`` them, which is NaN for a
quaternion that has no attitude. ``nearest`` needs ``beam``, which gives the distance that one beam
of a scan shows in the sector, and ``is_number``, which says of a number that it is no NaN;
``scan_usable`` needs ``valid_range``. Of those of arrays there is one per type of element: ``BASE``
stands for the name of the type in ROS 2, ``ELEMENT`` for that in C, ``RESULT`` for the type of the
result and ``NONE`` for what an empty array gives (``abs`` of an integer is ``magnitude``).
"""
