"""Speeds that rules compare one way round only."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from tests.support.checks import checked_rules, found_in_rules

SYSTEM = """\
system Robot
topics
  external topic /odom : nav_msgs.Odometry
  external topic /cmd_vel : geometry_msgs.TwistStamped
  external topic /imu : sensor_msgs.Imu
  external topic /joints : sensor_msgs.JointState
  external topic /accel : geometry_msgs.Accel
  external topic /raw : std_msgs.Float64 { data [m/s] }
  external topic /front : sensor_msgs.Range
  external topic /door : std_msgs.Bool
  external topic /stop : std_msgs.Bool
"""
HEAD = """\
use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool reset_by release;
action release;
const limit = 1 m/s
const most = 1 m/s tunable in [0.5, 2] m/s
input v = topic /odom.twist.twist.linear.x
input again = topic /odom.twist.twist.linear.x
input y = topic /odom.twist.twist.linear.y
input z = topic /odom.twist.twist.linear.z
input wish = topic /cmd_vel.twist.linear.x
input w = topic /imu.angular_velocity.z
input roll = topic /imu.angular_velocity.x
input arm = topic /joints.velocity[2]
input place = topic /joints.position[2]
input push = topic /accel.linear.x
input raw = topic /raw.data
input front = topic /front.range
input door = topic /door.data
"""
STOPS = "if e.r then { stop; };"


def found(rules: str, then: str, folder: Path) -> list[Diagnostic]:
    """Return the findings of this kind, of the rules of an entity ``e`` and of behaviours."""
    text = f"{HEAD}entity e {{ {rules} }}\n{then}\n"
    return found_in_rules("DRS381", text, SYSTEM, folder)


@pytest.mark.parametrize(
    ("rules", "place", "verdict", "hint"),
    [
        ("r: v > 0.5 m/s;", "v > 0.5 m/s", "false at any speed backwards", "v.abs() > 0.5 m/s"),
        ("r: v >= 1 for 2 sec;", "v >= 1", "false at any speed backwards", "v.abs() >= 1"),
        ("r: 1 < v;", "1 < v", "false at any speed backwards", "1 < v.abs()"),
        ("r: v > limit;", "v > limit", "false at any speed backwards", "v.abs() > limit"),
        ("r: v > most;", "v > most", "false at any speed backwards", "v.abs() > most"),
        ("r: not v <= most;", "v <= most", "true at any speed backwards", "v.abs() <= most"),
        ("r: y > limit;", "y > limit", "false at any speed to the right", "y.abs() > limit"),
        ("r: wish > 1;", "wish > 1", "false at any speed backwards", "wish.abs() > 1"),
        ("r: w > 1;", "w > 1", "false at any speed clockwise", "w.abs() > 1"),
        ("r: roll > 1;", "roll > 1", "false at any speed the other way round", "roll.abs() > 1"),
        ("r: arm > 1;", "arm > 1", "false at any speed the other way round", "arm.abs() > 1"),
        ("r: not v <= 1;", "v <= 1", "true at any speed backwards", "v.abs() <= 1"),
        ("ok: v < 1; r: not ok;", "v < 1", "true at any speed backwards", "v.abs() < 1"),
        ("r: door and v > 1;", "v > 1", "false at any speed backwards", "v.abs() > 1"),
        ("r: v >= 1 since v > 2;", "v >= 1", "false at any speed backwards", "v.abs() >= 1"),
        ("r: v > 1 or front < 1;", "v > 1", "false at any speed backwards", "v.abs() > 1"),
        ("r: v > 1 or v = v.previous();", "v > 1", "false at any speed", "v.abs() > 1"),
        ("r: v > 1 or v.rate() > 2;", "v > 1", "false at any speed", "v.abs() > 1"),
        ("r: v > 1; unused: v < -1;", "v > 1", "false at any speed", "v.abs() > 1"),
        (
            "r: /odom.twist.twist.linear.x > 1;",
            "/odom.twist.twist.linear.x > 1",
            "false at any speed backwards",
            "/odom.twist.twist.linear.x.abs() > 1",
        ),
    ],
)
def test_one_way_is_reported(
    rules: str, place: str, verdict: str, hint: str, tmp_path: Path
) -> None:
    """The finding stands at the comparison, says what is not seen, and proposes ``abs()``."""
    (finding,) = found(rules, STOPS, tmp_path)
    assert finding.span.text == place
    assert finding.message.startswith(f"'{place}' is {verdict}")
    assert finding.hint.endswith(f"write '{hint}'")
    assert not found(rules.replace(place, hint), STOPS, tmp_path)


@pytest.mark.parametrize(
    "rules",
    [
        "r: v.abs() > 1;",
        "r: abs(v) > 1;",
        "r: v not in [-1, 1];",
        "r: not v in [-1, 1];",
        "r: v > 1 or v < -0.2;",
        "r: v > 1 or again < -0.2;",
        "r: v > 1 or reverse; reverse: v <= -0.2;",
        "r: v > 1 or again.abs() > 2;",
        "r: v > 1 or v * v > 4;",
        "r: v > 1 or hypot(v, y) > 2;",
        "r: v > 1 or v != 0;",
        "r: v > 0;",
        "r: v < 0.1;",
        "r: v > 1 or v < 0.1;",
        "r: v not in [0.1, 1];",
        "r: v in [0.1, 1];",
        "r: v < -0.2;",
        "r: v > 0.1 and front < 1;",
        "r: fast and near; fast: v > 0.1; near: front < 1;",
        "r: v > 0.1 since front < 1;",
        "r: v > front / (1 sec);",
        "r: v > wish;",
        "r: z > 1;",
        "r: push > 1;",
        "r: raw > 1;",
        "r: place > 1;",
        "r: door; unused: v > 1;",
    ],
)
def test_other_looks_are_silent(rules: str, tmp_path: Path) -> None:
    """Whoever looks at the sign, at a distance too, or at another field, means what it says."""
    assert not found(rules, STOPS, tmp_path)


def test_one_finding_per_field(tmp_path: Path) -> None:
    """All comparisons of a field are one finding, at the first of them."""
    (finding,) = found("r: v > limit or v > 2; s: again > 3;", STOPS + STOPS, tmp_path)
    assert finding.span.text == "v > limit"
    assert [each.span.text for each in finding.related] == ["v > 2", "const limit = 1 m/s"]
    (finding,) = found("r: v > limit; s: again > 3;", "if e.r or e.s then { stop; };", tmp_path)
    assert [each.span.text for each in finding.related] == ["again > 3", "const limit = 1 m/s"]


def test_what_releases_is_seen_the_other_way_round(tmp_path: Path) -> None:
    """To be slow, which releases, is no look backwards: it is as if nothing looked there."""
    releases = "if e.r then { stop; }; if e.slow then { release; };"
    fast, slow = "r: v > 2;", "slow: v < 0.5;"
    (finding,) = found(f"{fast} {slow}", releases, tmp_path)
    assert finding.span.text == "v > 2"
    assert [each.span.text for each in finding.related] == ["v < 0.5"]
    assert not found(f"{fast} {slow}", "if e.r or e.slow then { stop; };", tmp_path)


def test_nested_behaviours_count_together(tmp_path: Path) -> None:
    """A speed beside a distance, one inside the other, is a speed towards something."""
    rules = "r: v > 0.1; near: front < 1;"
    assert not found(rules, "if e.r then { if e.near then { stop; }; };", tmp_path)
    assert not found(rules, "if e.near then { if e.r then { stop; }; };", tmp_path)
    assert found(rules, "if e.near then { stop; }; if e.r then { stop; };", tmp_path)


def test_long_chain_of_rules(tmp_path: Path) -> None:
    """Rules that name one another are followed however many they are."""
    chain = " ".join(f"r{at}: r{at + 1};" for at in range(2000))
    assert found(f"{chain} r2000: v > 1;", "if e.r0 then { stop; };", tmp_path)


@pytest.mark.parametrize(("lost", "is_found"), [("v < ", False), ("w < ", True)])
def test_lost_statement_may_look_the_other_way(lost: str, is_found: bool, tmp_path: Path) -> None:
    """What could not be read may be the comparison that is missed."""
    text = f"{HEAD}entity e {{ r: v > 1; s: {lost}; }}\n{STOPS}\n"
    codes = {each.code.name for each in checked_rules(text, SYSTEM, tmp_path)}
    assert "DRS003" in codes
    assert ("DRS381" in codes) == is_found
