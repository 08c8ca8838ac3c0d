"""Zones of rules: in the unit and in the numbers of the point, unknown as the point is."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from deros.generators.monitor.python.run import GeneratedMonitor
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import BuildResult, build
from deros.rules.engine.engine import Engine
from deros.rules.program import walk
from deros.rules.program.bounds import as_float32
from deros.rules.program.ir import Compute, Program
from tests.support.rules import embedded_store

MS = 10**6
SYSTEM = """system Yard
topics
  external topic /pose : geometry_msgs.PoseStamped
  external topic /beacon : geometry_msgs.Point32
  external topic /plane : geometry_msgs.Pose2D
  external topic /own : geometry_msgs.Vector3
  external topic /mm : geometry_msgs.Vector3 { x [mm], y [mm] }
  external topic /mixed : geometry_msgs.Vector3 { x [mm], y [m] }
"""
RULES = """use "yard.system" import Yard
input position = topic /pose.pose.position timeout 0.5 sec
input beacon = topic /beacon
input plane = topic /plane
input own = topic /own
input mm = topic /mm
input mixed = topic /mixed
zone yard = polygon (0, 0) (40, 0) (40, 30) (25, 15) (0, 30) dm "where the robot may drive"
zone tenth = rectangle (0.1, 0.1) (0.3, 0.3) m
"""
monitors = pytest.mark.parametrize("monitor", [Engine, GeneratedMonitor])
Monitor = Callable[..., Engine]


def built(folder: Path, condition: str) -> BuildResult:
    """Build one rule about the zones."""
    (folder / "yard.system").write_text(SYSTEM, encoding="utf-8")
    text = f"{RULES}entity e {{ r: {condition}; }}"
    model = Repository().load_text(folder / "rules.deros", text).model
    assert isinstance(model, Rules)
    return build(model, embedded_store())


def program(folder: Path, condition: str) -> Program:
    """Build one rule, which has no error."""
    found = built(folder, condition)
    assert found.program is not None, found.diagnostics
    return found.program


def verdicts(monitor: Monitor, rules: Program, *places: tuple[float, float]) -> list[bool | None]:
    """Return the verdict of the rule at each place."""
    running = monitor(rules)
    found = []
    for number, place in enumerate(places, 1):
        x, y, *others = (each.index for each in rules.leaves)
        leaves = dict(zip((x, y), place, strict=True)) | dict.fromkeys(others, 0.0)
        running.message(number * MS, rules.inputs[0].topic, leaves)
        found.append(running.explain().rules[0].value)
    return found


@monitors
def test_a_zone_is_converted_into_the_unit_of_the_point(tmp_path: Path, monitor: Monitor) -> None:
    """Its decimetres are held against metres, and against millimetres."""
    metres = program(tmp_path, "position.inside(yard)")
    assert verdicts(monitor, metres, (4.0, 3.0), (4.001, 3.0), (2.5, 1.5), (2.5, 1.6)) == [
        True,
        False,
        True,
        False,
    ]
    millimetres = program(tmp_path, "mm.inside(yard)")
    assert verdicts(monitor, millimetres, (4000.0, 3000.0), (4001.0, 0.0)) == [True, False]


@monitors
def test_corners_are_rounded_as_the_fields_are(tmp_path: Path, monitor: Monitor) -> None:
    """0.1 as a float32 is less than 0.1 as a double for 0.3, and more for 0.1: both are inside."""
    rules = program(tmp_path, "beacon.inside(tenth)")
    least, greatest = as_float32(0.1), as_float32(0.3)
    beyond = as_float32(0.30000004)
    places = (least, least), (greatest, greatest), (least, greatest), (beyond, least)
    assert verdicts(monitor, rules, *places) == [True, True, True, False]


@monitors
def test_a_heading_does_not_count(tmp_path: Path, monitor: Monitor) -> None:
    """A pose in the plane is a point with an angle."""
    rules = program(tmp_path, "plane.inside(tenth)")
    assert [leaf.path for leaf in rules.leaves] == [("x",), ("y",)]
    assert verdicts(monitor, rules, (0.2, 0.2), (0.2, 0.4)) == [True, False]


@monitors
def test_unknown_is_neither_inside_nor_outside(tmp_path: Path, monitor: Monitor) -> None:
    """A NaN in either coordinate, and silence; infinity is outside."""
    for condition, known in (("position.inside(yard)", True), ("not position.inside(yard)", False)):
        rules = program(tmp_path, condition)
        running = monitor(rules)
        found = [running.explain().rules[0].value]
        for number, place in enumerate(((1.0, 1.0), (math.nan, 1.0), (1.0, math.nan)), 1):
            leaves = dict(zip((each.index for each in rules.leaves), place, strict=True))
            running.message(number * MS, "/pose", leaves)
            found.append(running.explain().rules[0].value)
        running.advance(1000 * MS)
        assert [*found, running.explain().rules[0].value] == [None, known, None, None, None]
    outside = program(tmp_path, "not position.inside(yard)")
    assert verdicts(monitor, outside, (math.inf, 1.0), (1.0, -math.inf)) == [True, True]


@monitors
def test_causes_name_the_place_and_the_zone(tmp_path: Path, monitor: Monitor) -> None:
    """In the unit of the point, with the shortest decimals of its numbers."""
    for condition, topic, place, cause in (
        (
            "not position.inside(yard)",
            "/pose",
            (4.2, 1.0),
            "position (4.2, 1.0) m is outside yard",
        ),
        ("mm.inside(yard)", "/mm", (10.0, 0.5), "mm (10.0, 0.5) mm is inside yard"),
        (
            "beacon.inside(tenth)",
            "/beacon",
            (as_float32(0.1), as_float32(0.2)),
            "beacon (0.1, 0.2) m is inside tenth",
        ),
    ):
        rules = program(tmp_path, condition)
        running = monitor(rules)
        leaves = dict(zip((each.index for each in rules.leaves), place, strict=True))
        running.message(MS, topic, leaves)
        (rule,) = running.explain().rules
        assert rule.causes == (cause,)


def test_a_point_without_a_unit_is_in_that_of_the_zone(tmp_path: Path) -> None:
    """It is so in the whole program: another unit elsewhere is an error."""
    assert built(tmp_path, "own.inside(yard) and own.x > 20 dm").program is not None
    found = built(tmp_path, "own.inside(yard) and own.x > 2 m")
    assert [each.code.name for each in found.diagnostics] == ["DRS371"]
    assert "in dm" in found.diagnostics[0].message


def test_coordinates_have_one_unit(tmp_path: Path) -> None:
    """A circle in two units would be something else."""
    (found,) = built(tmp_path, "mixed.inside(yard)").diagnostics
    assert (found.code.name, found.span.text) == ("DRS306", "mixed")


def test_what_is_unknown_of_a_point_in_a_zone_is_so_of_the_point(tmp_path: Path) -> None:
    """The zone is always known."""
    first, second = (
        program(tmp_path, f"{each}.unknown() or position.inside(yard)").rules[0].condition
        for each in ("position.inside(yard)", "position")
    )
    assert next(walk.parts(first)) == next(walk.parts(second))


def test_two_zones_of_one_shape_stay_two(tmp_path: Path) -> None:
    """Each has its name in causes and in emitted code."""
    rules = program(tmp_path, "position.inside(yard) or position.inside(tenth)")
    names = [
        each.zone.name
        for each in walk.values(walk.conditions(rules))
        if isinstance(each, Compute) and each.zone is not None
    ]
    assert names == ["yard", "tenth"]
