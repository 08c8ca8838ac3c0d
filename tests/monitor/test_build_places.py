"""Findings point at what is wrong, not at all that stands around it."""

from __future__ import annotations

import pytest

from tests.support.rules import findings


@pytest.mark.parametrize(
    ("statements", "code", "place"),
    [
        ("input v = topic /imu.orientatoin.x", "DRS302", "orientatoin"),
        ("input v = topic /imu.\n  orientation.\n  q", "DRS302", "q"),
        ("input v = topic /imu.orientation_covariance[ 12 ]", "DRS302", "[ 12 ]"),
        ("input v = topic /imu. /* a. */ orientatoin", "DRS302", "orientatoin"),
        ("input v = topic /sped.data", "DRS301", "/sped"),
        ("input v = topic /speed.data timeout 1 secc", "DRS006", "secc"),
        ("input v = topic /speed.data timeout 1 deg", "DRS306", "deg"),
        ("entity e { r: topic /imu.orientation.rol() > 1; }", "DRS305", "rol"),
        ("entity e { r: topic /speed.data in [3, 2]; }", "DRS307", "[3, 2]"),
        ("entity e { r: topic /speed.data > limit; }", "DRS310", "limit"),
        ("entity e { r: topic /odom.twist.twist.linear.x > 3 deg; }", "DRS306", "3 deg"),
        ("action stop reset_by okay;", "DRS312", "okay"),
    ],
)
def test_place(statements: str, code: str, place: str) -> None:
    """The span of the finding is exactly the faulty part."""
    found = {name: text for name, text, _ in findings(statements)}
    assert found[code] == place


def test_field_below_an_input() -> None:
    """A wrong field that a rule adds to an input is pointed at in the rule."""
    statements = """
        input imu = topic /imu timeout 1 sec
        entity e { r: imu.angular_velocity.w > 1; }
    """
    found = {name: (place, message) for name, place, message in findings(statements)}
    assert found["DRS302"] == ("w", "geometry_msgs.Vector3 has no field 'w'")


def test_a_fault_is_reported_once() -> None:
    """What follows from a reported fault is not reported again."""
    statements = """
        action stop;
        const limit = 3 blah
        input v = topic /sped.data timeout 1 sec
        entity e { r: v > limit and v.abs() < 3; s: limit < v; }
        if e.r or e.s then { stop; };
    """
    assert [code for code, _, _ in findings(statements)] == ["DRS301", "DRS006"]
