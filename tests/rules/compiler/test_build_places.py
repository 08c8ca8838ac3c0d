"""Spans of findings: the faulty part, not the text around it."""

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
def test_span_is_exactly_the_faulty_part(statements: str, code: str, place: str) -> None:
    """The finding does not mark the text around the fault."""
    reported = {name: text for name, text, _ in findings(statements)}
    assert reported[code] == place


def test_unknown_field_below_an_input_is_marked_in_the_rule() -> None:
    """The wrong field is in the rule, not in the input."""
    statements = """
        input imu = topic /imu timeout 1 sec
        entity e { r: imu.angular_velocity.w > 1; }
    """
    reported = {name: (place, message) for name, place, message in findings(statements)}
    assert reported["DRS302"] == ("w", "geometry_msgs.Vector3 has no field 'w'")


def test_fault_is_reported_once() -> None:
    """Consequences of a reported fault are not reported."""
    statements = """
        action stop;
        const limit = 3 blah
        input v = topic /sped.data timeout 1 sec
        entity e { r: v > limit and v.abs() < 3; s: limit < v; }
        if e.r or e.s then { stop; };
    """
    assert [code for code, _, _ in findings(statements)] == ["DRS301", "DRS006"]
