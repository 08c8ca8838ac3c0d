"""Points of scans in zones: where the scanner is on the robot, and in which unit the zone is."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from deros.generators.monitor.python.run import GeneratedMonitor
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import BuildResult, build
from deros.rules.engine.engine import Engine
from deros.rules.engine.state import LeafValue
from deros.rules.program import ir, walk
from deros.rules.program.zones import Circle, Polygon, Rectangle, Shape
from tests.support.rules import embedded_store

MS = 10**6
SYSTEM = "system Base\ntopics\n  external topic /scan : sensor_msgs.LaserScan\n"
monitors = pytest.mark.parametrize("monitor", [Engine, GeneratedMonitor])
Monitor = Callable[..., Engine]


def built(folder: Path, mounting: str, zone: str, condition: str) -> BuildResult:
    """Build one rule about a scan and a zone."""
    (folder / "base.system").write_text(SYSTEM, encoding="utf-8")
    text = (
        f'use "base.system" import Base\ninput scan = topic /scan {mounting} timeout 1 sec\n'
        f"zone z = {zone}\nentity e {{ r: {condition}; }}"
    )
    model = Repository().load_text(folder / "rules.deros", text).model
    assert isinstance(model, Rules)
    return build(model, embedded_store())


def program(folder: Path, mounting: str, zone: str, condition: str) -> ir.Program:
    """Build one rule, which has no error."""
    found = built(folder, mounting, zone, condition)
    assert found.program is not None, found.diagnostics
    return found.program


def shape_of(rules: ir.Program) -> Shape:
    """Return the zone in the coordinates of the scanner."""
    (value,) = (
        each
        for each in walk.values(walk.conditions(rules))
        if isinstance(each, ir.Apply) and each.zone is not None
    )
    assert value.zone is not None
    return value.zone.shape


def state(monitor: Monitor, rules: ir.Program, ranges: Sequence[float]) -> tuple[object, ...]:
    """Return the verdict and the causes at a scan of four beams: ahead, left, behind, right."""
    running = monitor(rules)
    form = {
        "angle_min": 0.0,
        "angle_increment": math.pi / 2.0,
        "range_min": 0.1,
        "range_max": 10.0,
    }
    leaves: dict[int, LeafValue] = {
        each.index: form.get(str(each.path[-1]), list(ranges)) for each in rules.leaves
    }
    running.message(MS, "/scan", leaves)
    (rule,) = running.explain().rules
    return rule.value, rule.causes


RECTANGLE = "rectangle (0.3, -0.4) (1.2, 0.8) m"


@pytest.mark.parametrize(
    ("mounting", "least", "greatest"),
    [
        ("", (0.3, -0.4), (1.2, 0.8)),
        ("mounted (0, 0) m", (0.3, -0.4), (1.2, 0.8)),
        ("mounted (0.2, 0.1, 0.3) m", (0.1, -0.5), (1.0, 0.7)),
        ("mounted (20, 10, 30) cm", (0.1, -0.5), (1.0, 0.7)),
        ("mounted (0.2, 0.1) m yaw 90 deg", (-0.5, -1.0), (0.7, -0.1)),
        ("mounted (0.2, 0.1) m yaw -270 deg", (-0.5, -1.0), (0.7, -0.1)),
        ("mounted (0.2, 0.1) m yaw 180 deg", (-1.0, -0.7), (-0.1, 0.5)),
        ("mounted (0.2, 0.1) m yaw -90 deg", (-0.7, 0.1), (0.5, 1.0)),
        ("mounted (0.2, 0.1) m yaw 360 deg", (0.1, -0.5), (1.0, 0.7)),
    ],
)
def test_a_quarter_turn_is_exact(
    tmp_path: Path, mounting: str, least: tuple[float, float], greatest: tuple[float, float]
) -> None:
    """Each side is a decimal, rounded once; no sine of a half turn has a part in it."""
    rules = program(tmp_path, mounting, RECTANGLE, "scan.points_in(z) > 1")
    assert shape_of(rules) == Rectangle(least, greatest)


def test_other_turns_make_a_polygon_of_a_rectangle(tmp_path: Path) -> None:
    """Its corners go on in their order; a circle remains one."""
    mounting = "mounted (1, 0) m yaw 45 deg"
    turned = program(tmp_path, mounting, "rectangle (1, 0) (2, 1) m", "scan.points_in(z) > 1")
    root = math.sqrt(0.5)
    expected = [(0.0, 0.0), (root, -root), (2 * root, 0.0), (root, root)]
    shape = shape_of(turned)
    assert isinstance(shape, Polygon)
    assert [each for place in shape.corners for each in place] == pytest.approx(
        [each for place in expected for each in place], abs=1e-15
    )
    round_ = shape_of(program(tmp_path, mounting, "circle (200, 0) 50 cm", "scan.points_in(z) > 1"))
    assert isinstance(round_, Circle)
    assert round_.radius == 0.5
    assert round_.centre == pytest.approx((root, -root))


@monitors
def test_each_beam_is_where_the_scanner_puts_it(tmp_path: Path, monitor: Monitor) -> None:
    """A scanner ahead that looks left sees what is before the robot on its own right.

    Its beams are at 90, 180, -90 and 0 degrees of the robot.
    """
    rules = program(
        tmp_path,
        "mounted (1, 0) m yaw 90 deg",
        "rectangle (2, -1) (4, 1) m",
        "scan.points_in(z) >= 1",
    )
    far = 9.0
    assert state(monitor, rules, (2.0, 2.0, 2.0, far))[0] is False
    assert state(monitor, rules, (far, far, far, 0.9))[0] is False
    verdict, causes = state(monitor, rules, (far, far, far, 1.0))
    assert verdict is True
    assert causes == ("scan.points_in(z) 1 of 1 points >= 1",)
    assert state(monitor, rules, (far, far, far, 3.0))[0] is True
    assert state(monitor, rules, (far, far, far, 3.5))[0] is False
    # The one beam that looks there is blind.
    assert state(monitor, rules, (2.0, 2.0, 2.0, math.nan))[0] is None


@monitors
def test_causes_tell_of_how_many_points(tmp_path: Path, monitor: Monitor) -> None:
    """And how many beams are blind, of those that look to the zone."""
    rules = program(tmp_path, "", "circle (0, 0) 2 m", "scan.points_in(z) >= 2")
    assert state(monitor, rules, (1.0, 2.0, 3.0, math.nan)) == (
        True,
        ("scan.points_in(z) 2 of 3 points >= 2 (25 % of its beams blind)",),
    )


def test_a_zone_that_vanishes_is_reported(tmp_path: Path) -> None:
    """Two corners that are one double on the robot are no area."""
    found = built(
        tmp_path,
        "mounted (100, 0) m",
        "polygon (0, 0) (1e-15, 0) (0, 1) m",
        "scan.points_in(z) > 1",
    )
    assert [each.code.name for each in found.diagnostics] == ["DRS601"]
