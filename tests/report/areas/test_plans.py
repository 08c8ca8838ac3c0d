"""What pictures of zones show: from where each is measured, in metres, and who asks for it."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from deros.models.rules import Rules
from deros.pipeline.workspace import load
from deros.report.areas.plans import Plan, Scanner, outline, plans
from deros.rules.program.zones import Circle, Polygon, Rectangle

SYSTEM = """system Base
topics
  external topic /scan : sensor_msgs.LaserScan
  external topic /rear : sensor_msgs.LaserScan
  external topic /odom : nav_msgs.Odometry
"""
RULES = """use "base.system" import Base
action stop;
unit shoe = 0.3 m
input scan = topic /scan mounted (20, 0, 10) cm timeout 0.5 sec
input rear = topic /rear mounted (-1, 0.5, 0) shoe yaw -90 deg timeout 0.5 sec
input own = topic /rear timeout 0.5 sec
input place = topic /odom.pose.pose.position timeout 0.5 sec
zone front = polygon (20, -30) (90, 0)  // the nose
  (20, 30) cm "until it stands"
zone around = circle (0, 0) 2 shoe
zone near = circle (0.5, 0) 0.25 m
zone yard = rectangle (4, 3) (0, 0) m
entity way {
  blocked: scan.points_in(front) >= 2 or rear.points_in(around) > 1;
  close: scan.points_in(around) >= 2 and own.points_in(near) > 3;
  left: not place.inside(yard) for 1 sec;
  muddy: scan.blind(-180 deg, 180 deg) > 0.3;
}
if way.blocked or way.close or way.left or way.muddy then { stop; };
"""


def plans_of(folder: Path, text: str = RULES) -> tuple[Plan, ...]:
    """Return the plans of rules."""
    (folder / "base.system").write_text(SYSTEM, encoding="utf-8")
    rules = folder / "base.deros"
    rules.write_text(text, encoding="utf-8")
    workspace = load([str(rules)])
    (loaded,) = workspace.files
    assert isinstance(loaded.model, Rules)
    program = workspace.builds.of(loaded.model).program
    assert program is not None
    return plans(loaded.model, program)


def test_each_origin_has_a_plan(tmp_path: Path) -> None:
    """A zone stands in the plan from whose origin rules measure it, in the order declared."""
    robot, scanner, position = plans_of(tmp_path)
    assert (robot.title, robot.is_of_robot, robot.is_map) == ("On the robot", True, False)
    assert [each.name for each in robot.areas] == ["front", "around"]
    assert (scanner.title, scanner.is_of_robot) == ("From the scanner of /rear", False)
    assert [each.name for each in scanner.areas] == ["near"]
    assert scanner.scanners == [Scanner("own", 0.0, 0.0, 0.0)]
    assert (position.title, position.is_map) == ("Where place is", True)
    assert [each.name for each in position.areas] == ["yard"]
    assert position.scanners == []


def test_shapes_are_in_metres_as_declared(tmp_path: Path) -> None:
    """Not turned as the scanner is; units of one's own count, too."""
    robot, _, position = plans_of(tmp_path)
    front, around = robot.areas
    assert front.shape == Polygon(((0.2, -0.3), (0.9, 0.0), (0.2, 0.3)))
    assert front.written == "polygon (20, -30) (90, 0) (20, 30) cm"
    assert front.description == "until it stands"
    assert front.rules == ("way.blocked",)
    assert around.shape == Circle((0.0, 0.0), 0.6)
    assert around.rules == ("way.blocked", "way.close")
    assert position.areas[0].shape == Rectangle((0.0, 0.0), (4.0, 3.0))
    assert position.areas[0].rules == ("way.left",)


def test_scanners_are_where_they_are_mounted(tmp_path: Path) -> None:
    """Each once, however many zones it looks into."""
    robot = plans_of(tmp_path)[0]
    scan, rear = robot.scanners
    assert scan == Scanner("scan", 0.2, 0.0, 0.0)
    assert (rear.name, rear.x, rear.y) == ("rear", -0.3, 0.15)
    assert rear.yaw == pytest.approx(-math.pi / 2.0)


def test_zones_that_no_rule_asks_for_are_not_drawn(tmp_path: Path) -> None:
    """There may be no plan at all."""
    bare = RULES[: RULES.index("entity")] + "entity e { r: scan.missing(); } if e.r then { stop; };"
    assert plans_of(tmp_path, bare) == ()


def test_outline_is_written_as_a_zone() -> None:
    """In any unit of length."""
    assert outline("circle (0, 0) 20 cm").shape == Circle((0.0, 0.0), 0.2)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "box",
        "circle (0, 0) 2",
        "circle (0, 0) 2 s",
        "circle (0, 0) 2 blobs",
        "circle (0, 0) 0 m",
        "circle (0, 0) 2 m zone b = circle (0, 0) 1 m",
        "circle (0, 0) 2 m action stop",
    ],
)
def test_what_is_no_shape_is_no_outline(text: str) -> None:
    """The message repeats what was written."""
    with pytest.raises(ValueError, match=r"shape|area"):
        outline(text)
