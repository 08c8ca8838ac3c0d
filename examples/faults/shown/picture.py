"""The picture of the runs: the way over ground, and the speed over time, of each fault."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path

import demonstration.chart as charts

from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.report.areas.plans import Area, plans
from deros.rules.compiler.build import build
from deros.rules.program.zones import Circle, Polygon, Rectangle
from shown.robots import EXAMPLES, Robot
from shown.run import Motion, Outcome

SIDE = 300.0
"""Width and height, in px, of the way over ground."""

_STYLE = (Path(charts.__file__).parent / "picture.css").read_text(encoding="utf-8")
_OWN_STYLE = """
.run { display: flex; gap: 24px; flex-wrap: wrap; }
svg .zone { fill: none; stroke: var(--faint); stroke-dasharray: 5 4; }
svg .end { fill: var(--orange); }
"""


def areas(robot: Robot) -> tuple[Area, ...]:
    """Return the zones of a robot's rules that are on the map."""
    model = Repository().load(str(EXAMPLES / robot.name / f"{robot.name}.deros")).model
    assert isinstance(model, Rules)
    program = build(model, InterfaceStore()).program
    assert program is not None
    return tuple(area for plan in plans(model, program) if plan.is_map for area in plan.areas)


def page(robot: Robot, outcomes: Sequence[Outcome], zones: Sequence[Area]) -> str:
    """Return a page of HTML that needs nothing but itself."""
    passed = sum(each.passed for each in outcomes)
    state = "good" if passed == len(outcomes) else "bad"
    figures = "".join(_figure(each, zones) for each in outcomes if each.motions)
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        f"<title>{escape(robot.name)}: {passed} of {len(outcomes)} faults</title>"
        f"<style>\n{_STYLE}{_OWN_STYLE}</style></head>\n<body><main>"
        f'<header><h1>{escape(robot.name)}</h1><p class="verdict {state}">'
        f"stopped as expected after {passed} of {len(outcomes)} faults</p></header>\n"
        f"{figures}</main></body></html>\n"
    )


def _figure(outcome: Outcome, zones: Sequence[Area]) -> str:
    said = outcome.said[0] if outcome.said else outcome.overdue
    return (
        f"<figure><figcaption>{escape(outcome.fault)}: {escape(said)}</figcaption>"
        f'<div class="run">{_way(outcome, zones)}{_speed(outcome)}</div></figure>\n'
    )


def _way(outcome: Outcome, zones: Sequence[Area]) -> str:
    """Return the way over ground, x to the right, with the zones and the place of the stop."""
    places = [(each.x, each.y) for each in outcome.motions]
    reach = max(0.5, *(max(abs(x), abs(y)) for x, y in [*places, *_corners(zones)])) * 1.1

    def pixels(x: float, y: float) -> str:
        return f"{(1 + x / reach) * SIDE / 2:.1f},{(1 - y / reach) * SIDE / 2:.1f}"

    parts = [
        f'<polygon class="zone" points="{" ".join(pixels(*corner) for corner in _outline(area))}">'
        f"<title>{escape(area.name)}</title></polygon>"
        for area in zones
    ]
    parts.append(
        f'<polyline class="curve speed" points="{" ".join(pixels(*place) for place in places)}"/>'
    )
    stop = _at(outcome.motions, outcome.stopped_at)
    if stop is not None:
        x, y = pixels(stop.x, stop.y).split(",")
        parts.append(f'<circle class="end" cx="{x}" cy="{y}" r="5"><title>stop</title></circle>')
    return (
        f'<svg viewBox="0 0 {SIDE:.0f} {SIDE:.0f}" width="{SIDE:.0f}" height="{SIDE:.0f}"'
        f' role="img" aria-label="way over ground, {2 * reach:.1f} m wide">'
        f'<rect class="frame" width="{SIDE:.0f}" height="{SIDE:.0f}"/>{"".join(parts)}</svg>'
    )


def _speed(outcome: Outcome) -> str:
    began, end = outcome.motions[0].time, outcome.motions[-1].time
    length = max(end - began, 1.0)
    chart = charts.Chart(charts.Scale(0.0, length, charts.LEFT, charts.LEFT + 640.0))
    curve = [(each.time - began, each.speed) for each in outcome.motions]
    most = max(0.5, *(abs(speed) for _, speed in curve)) * 1.1
    least = min(0.0, *(speed for _, speed in curve)) * 1.1
    limits = [(0.0, "0", "zero"), (0.5, "0.5", "none")]
    chart.plot("speed", "m/s", 170.0, (least, most), [("speed", curve)], limits)
    stopped = outcome.stopped_at
    chart.lane("stop", [] if stopped is None else [(stopped - began, length)], "stop")
    step = next((each for each in (1.0, 2.0, 5.0, 10.0) if length / each <= 15), 30.0)
    chart.axis([number * step for number in range(math.floor(length / step) + 1)], "seconds")
    return chart.svg(f"speed with the fault {outcome.fault}")


def _at(motions: Sequence[Motion], time: float | None) -> Motion | None:
    if time is None:
        return None
    return min(motions, key=lambda each: abs(each.time - time))


def _corners(zones: Iterable[Area]) -> list[tuple[float, float]]:
    return [corner for area in zones for corner in _outline(area)]


def _outline(area: Area) -> list[tuple[float, float]]:
    match area.shape:
        case Polygon(corners):
            return [(float(x), float(y)) for x, y in corners]
        case Rectangle() as shape:
            (x, y), (to_x, to_y) = shape.least, shape.greatest
            return [(x, y), (to_x, y), (to_x, to_y), (x, to_y)]
        case Circle((x, y), radius):
            angles = [math.tau * number / 72 for number in range(72)]
            return [(x + radius * math.cos(each), y + radius * math.sin(each)) for each in angles]
