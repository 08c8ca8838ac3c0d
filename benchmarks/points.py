"""How long ``points_in()`` takes for a laser scan of 2,000 ranges, in Python and in C.

The functions are those of a generated monitor, for a field before the robot. Beside each stands a
loop written by hand, which knows neither blind beams nor limits of the scanner: in Python over
tables of cosines and sines that numpy has made before, in C with a cosine and a sine for each beam.
All run in turns in one process for each language, and the least of many runs counts. In an open
place hardly a beam ends near the field; in a crowd each one ends within its reach. Wanted, in an
open place: 60 microseconds in Python, 10 in C.
"""

from __future__ import annotations

import argparse
import array
import json
import math
import random
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table
from support.compiling import c_compiler, compile_c
from support.processes import run

from deros.generators.monitor.c.interface import render_monitor as render_c
from deros.generators.monitor.python.render import MONITOR
from deros.generators.monitor.python.render import render_monitor as render_python
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.program import walk
from deros.rules.program.ir import Apply, Const, Program

COUNT = 2000
ANGLE_MIN, ANGLE_INCREMENT = -math.pi, 2.0 * math.pi / COUNT
LIMITS_US = {"Python": 60.0, "C": 10.0}
PLACES = {"open": (1.5, 8.0), "crowd": (0.2, 0.8)}
"""Between which ranges the beams end, in metres."""

_SYSTEM = "system Base\ntopics\n  external topic /scan : sensor_msgs.LaserScan\n"
_RULES = """\
use "base.system" import Base
action stop;
input scan = topic /scan mounted (0.2, 0, 0.1) m timeout 1 sec
zone front = rectangle (0.3, -0.4) (1.2, 0.4) m
entity e { failsafe blocked: scan.points_in(front) >= 4; }
if e.blocked then { stop; };
"""


@dataclass(frozen=True, slots=True)
class Row:
    """One place in one language: microseconds of the monitor's function, and of the loop."""

    language: str
    place: str
    generated: float
    by_hand: float


def _program(folder: Path) -> Program:
    (folder / "base.system").write_text(_SYSTEM, encoding="utf-8")
    model = Repository().load_text(folder / "scan.deros", _RULES).model
    assert isinstance(model, Rules)
    found = build(model, InterfaceStore()).program
    assert found is not None
    return found


def _sector(program: Program) -> tuple[float, float]:
    (value,) = (
        each
        for each in walk.values(walk.conditions(program))
        if isinstance(each, Apply) and each.zone is not None
    )
    start, end = (each.value for each in value.arguments[5:7] if isinstance(each, Const))
    assert isinstance(start, float)
    assert isinstance(end, float)
    return start, end


def _ranges(place: str) -> array.array[float]:
    drawn = random.Random(1)
    least, greatest = PLACES[place]
    return array.array("f", (drawn.uniform(least, greatest) for _ in range(COUNT)))


def in_python(program: Program, turns: int) -> list[Row]:
    """Return the rows of Python.

    Raises:
        ValueError: the two count differently.
    """
    module: dict[str, Any] = {}
    exec(render_python(program)[MONITOR], module)
    start, end = _sector(program)
    bearings = ANGLE_MIN + np.arange(COUNT) * ANGLE_INCREMENT
    cosines, sines = np.cos(bearings), np.sin(bearings)
    rows = []
    for place in PLACES:
        ranges = _ranges(place)
        look = (ranges, ANGLE_MIN, ANGLE_INCREMENT, 0.05, 12.0, start, end, False)

        def generated(look: tuple[Any, ...] = look) -> int:
            found: int = module["scan_points_in"](*look, 1.08, module["_is_in_front_0"])
            return found

        def by_hand(ranges: array.array[float] = ranges) -> int:
            measured = np.asarray(ranges)
            x, y = measured * cosines, measured * sines
            return int(np.count_nonzero((x >= 0.1) & (x <= 1.0) & (y >= -0.4) & (y <= 0.4)))

        if generated() != by_hand():
            raise ValueError(f"{generated()} points generated, {by_hand()} by hand")
        rows.append(Row("Python", place, *_least((generated, by_hand), turns)))
    return rows


def _least(functions: Sequence[Callable[[], object]], turns: int) -> list[float]:
    """Return the least microseconds of each of some functions, called in turns."""
    best = [math.inf] * len(functions)
    for _ in range(turns):
        for number, function in enumerate(functions):
            begun = time.perf_counter_ns()
            function()
            best[number] = min(best[number], (time.perf_counter_ns() - begun) / 1e3)
    return best


_DRIVER = """\
#define _POSIX_C_SOURCE 200809L
#include "scan_monitor.c"
#include <stdio.h>
#include <time.h>
void scan_emit(void *owner, int64_t t, scan_kind kind, uint32_t site)
{ (void)owner; (void)t; (void)kind; (void)site; }
static size_t by_hand(const float *ranges, size_t count, double angle_min, double step)
{
  size_t found = 0U;
  for (size_t i = 0U; i < count; ++i) {
    const double bearing = angle_min + (double)i * step;
    const double x = (double)ranges[i] * cos(bearing), y = (double)ranges[i] * sin(bearing);
    if (x >= 0.1 && x <= 1.0 && y >= -0.4 && y <= 0.4) ++found;
  }
  return found;
}
static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec * 1e6 + (double)t.tv_nsec / 1e3;
}
static float ranges[COUNT];
int main(int count, char **arguments)
{
  FILE *file = (count == 2) ? fopen(arguments[1], "rb") : NULL;
  if (file == NULL || fread(ranges, sizeof(float), COUNT, file) != COUNT) return 1;
  double best = 1e9, other = 1e9, points = 0.0;
  size_t counted = 0U;
  for (int turn = 0; turn < TURNS; ++turn) {
    const double begun = now();
    points = points_in_front_0(ranges, COUNT, MIN, STEP, 0.05, 12.0, START, END, false);
    const double half = now();
    counted = by_hand(ranges, COUNT, MIN, STEP);
    const double done = now();
    if (half - begun < best) best = half - begun;
    if (done - half < other) other = done - half;
  }
  if (points != (double)counted) { fprintf(stderr, "%g and %zu\\n", points, counted); return 1; }
  printf("%.3f %.3f\\n", best, other);
  return 0;
}
"""


def in_c(program: Program, turns: int, folder: Path) -> list[Row]:
    """Return the rows of C, compiled in a folder; none without a compiler."""
    if c_compiler() is None:
        return []
    for name, text in render_c(program).items():
        (folder / name).write_text(text, encoding="utf-8")
    start, end = _sector(program)
    names = {"COUNT": f"{COUNT}U", "TURNS": turns, "MIN": ANGLE_MIN, "STEP": ANGLE_INCREMENT}
    names |= {"START": start, "END": end}
    defined = "".join(f"#define {name} ({value})\n" for name, value in names.items())
    (folder / "driver.c").write_text(defined + _DRIVER, encoding="utf-8")
    compile_c([folder / "driver.c"], folder / "driver", [folder])
    rows = []
    for place in PLACES:
        scan = folder / f"{place}.bin"
        scan.write_bytes(_ranges(place).tobytes())
        best, other = map(float, run([str(folder / "driver"), str(scan)]).split())
        rows.append(Row("C", place, best, other))
    return rows


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; return 1 if a bar has to hold and does not."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--turns", type=int, default=3000, help="of each (%(default)s)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all results there, too")
    parser.add_argument(
        "--assert", action="store_true", dest="strict", help="exit with 1 if a bar does not hold"
    )
    options = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="deros-benchmark-") as folder:
        program = _program(Path(folder))
        rows = in_python(program, options.turns) + in_c(program, options.turns, Path(folder))
    title = f"points_in() of {COUNT:,} ranges, microseconds"
    table = Table(title=title, title_justify="left", pad_edge=False)
    for head in ("", "", "generated", "by hand", "ratio", "wanted"):
        table.add_column(head, justify="right" if head else "left")
    for row in rows:
        wanted = f"{LIMITS_US[row.language]:.0f}" if row.place == "open" else ""
        times = (f"{row.generated:.1f}", f"{row.by_hand:.1f}")
        table.add_row(row.language, row.place, *times, f"{row.generated / row.by_hand:.2f}", wanted)
    Console(width=None if sys.stdout.isatty() else 100).print(table)
    if options.json is not None:
        result = {"benchmark": "points", "rows": list(map(asdict, rows))}
        options.json.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    held = all(row.generated < LIMITS_US[row.language] for row in rows if row.place == "open")
    return 1 if options.strict and not held else 0


if __name__ == "__main__":
    sys.exit(main())
