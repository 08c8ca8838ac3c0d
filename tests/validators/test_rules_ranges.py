"""Comparisons decided by the range of a type are reported, and no others."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.profiles import scaled
from tests.support.rules import findings

DECLARED = """
action stop;
input mode = topic /mode.data timeout 1 sec
input v = topic /speed.data timeout 1 sec
input q = topic /imu.orientation timeout 1 sec
input scan = topic /scan timeout 1 sec
input odom = topic /odom timeout 1 sec
input joints = topic /joints timeout 1 sec
input bytes = topic /bytes timeout 1 sec
"""


def decided(condition: str) -> list[tuple[str, str]]:
    """Return code and place of the decided parts of a condition."""
    inputs = ("mode", "v", "q", "scan", "odom", "joints", "bytes")
    used = " or ".join(f"{each}.missing()" for each in inputs)
    statements = f"""{DECLARED} entity e {{ failsafe r: {condition}; s: {used}; }}
        if e.r or e.s then {{ stop; }};"""
    results = ((code, place) for code, place, _ in findings(statements))
    return [each for each in results if each[0] != "DRS367"]  # the finding on rate() itself


UNDECIDED = (
    "mode > 254",
    "mode = 255",
    "mode in [255, 300]",
    "mode in (1, 3)",
    "v > 1e38",
    "v > 5 or v < 3",
    "v > 5 and not v < 3",
    "v > 5 and mode < 3",
    "v.abs() <= 0",
    "q.roll() > 179 deg",
    "(v > 5 for 1 sec) and v < 3",
    "v > 5 and v.abs() < 3",
    "scan.nearest(-1.0, 1.0) > 0",
    "scan.nearest(-1.0, 1.0) <= 0",
    "scan.nearest(-1.0, 1.0) in (0, 5 m]",
    "mode.abs() > 254",
    "mode.rate() < -300",
    "q.roll().abs() > 179 deg",
    "odom.pose.pose.position.norm() > 1e300",
    "v.age() > 0.5 sec",
    "v.age() in [0.1 sec, 0.5 sec]",
    "q.roll() > q.tilt()",
    "q.tilt() > q.roll().abs()",
    "joints.name.count() > joints.position.count()",
    "mode < joints.name.count()",
    "odom.pose.covariance.count() < mode.abs()",
)


def test_undecided_condition_is_not_reported() -> None:
    """A condition that some values satisfy and others do not gives no finding."""
    for condition in UNDECIDED:
        assert decided(condition) == [], condition


DECIDED = (
    ("mode > 255", "DRS308", "mode > 255"),
    ("scan.nearest(-1.0, 1.0) < -0.4 m", "DRS308", "scan.nearest(-1.0, 1.0) < -0.4 m"),
    ("scan.nearest(-1.0, 1.0) >= 0 m", "DRS309", "scan.nearest(-1.0, 1.0) >= 0 m"),
    ("scan.nearest(-1.0, 1.0) in [-2, -1]", "DRS308", "scan.nearest(-1.0, 1.0) in [-2, -1]"),
    (
        "scan.nearest(-1.0, 1.0) not in [0, 2] or v > 1 and scan.nearest(-1.0, 1.0) < 0",
        "DRS308",
        "scan.nearest(-1.0, 1.0) < 0",
    ),
    ("mode.abs() > 255", "DRS308", "mode.abs() > 255"),
    ("q.pitch().abs() > 91 deg", "DRS308", "q.pitch().abs() > 91 deg"),
    ("q.tilt().abs() >= 0", "DRS309", "q.tilt().abs() >= 0"),
    ("joints.name.count().abs() < 0", "DRS308", "joints.name.count().abs() < 0"),
    ("joints.position.count() > -1", "DRS309", "joints.position.count() > -1"),
    ("odom.pose.covariance.count() = 35", "DRS308", "odom.pose.covariance.count() = 35"),
    ("bytes.data.max() > 255", "DRS308", "bytes.data.max() > 255"),
    ("bytes.data.min() < 0", "DRS308", "bytes.data.min() < 0"),
    (
        "odom.pose.pose.position.norm() < -1 m",
        "DRS308",
        "odom.pose.pose.position.norm() < -1 m",
    ),
    ("v.age() >= 0 sec", "DRS309", "v.age() >= 0 sec"),
    ("v.age() < 0 sec", "DRS308", "v.age() < 0 sec"),
    ("v.age() > 2 sec and v.age() < 1 sec", "DRS308", "v.age() > 2 sec and v.age() < 1 sec"),
    ("v.age() <= 2 sec or v.age() >= 1 sec", "DRS309", "v.age() <= 2 sec or v.age() >= 1 sec"),
    ("v > v", "DRS308", "v > v"),
    ("v <= v", "DRS309", "v <= v"),
    ("q.tilt() < q.tilt()", "DRS308", "q.tilt() < q.tilt()"),
    (
        "odom.pose.covariance.count() <= odom.twist.covariance.count()",
        "DRS309",
        "odom.pose.covariance.count() <= odom.twist.covariance.count()",
    ),
    ("q.roll() > q.pitch() and mode > 255", "DRS308", "mode > 255"),
    ("300 < mode", "DRS308", "300 < mode"),
    ("mode <= 255", "DRS309", "mode <= 255"),
    ("mode in (254.5, 254.9)", "DRS308", "mode in (254.5, 254.9)"),
    ("mode = -1 and v > 1", "DRS308", "mode = -1"),
    ("v > 1 and v > 2 and v < 2", "DRS308", "v > 1 and v > 2 and v < 2"),
    ("v = 1 and v != 1", "DRS308", "v = 1 and v != 1"),
    ("mode < 3 or mode > 2", "DRS309", "mode < 3 or mode > 2"),
    ("not (v > 5 and v < 3) for 1 sec", "DRS308", "v > 5 and v < 3"),
    ("q.tilt() < 0", "DRS308", "q.tilt() < 0"),
    ("q.pitch() > 91 deg", "DRS308", "q.pitch() > 91 deg"),
)


def test_decided_condition_is_reported_once() -> None:
    """The finding names the smallest decided condition."""
    for condition, code, place in DECIDED:
        results = [each for each in decided(condition) if each[0] != "DRS330"]
        assert results == [(code, place)], condition


@settings(max_examples=scaled(40))
@given(st.integers(-20, 280), st.integers(-20, 280), st.booleans())
def test_decided_pairs_agree_with_enumeration(low: int, high: int, both: bool) -> None:
    """A pair of comparisons is reported exactly if all 256 values give one verdict."""
    parts = [[mode >= low for mode in range(256)], [mode <= high for mode in range(256)]]
    combine = all if both else any
    verdicts = {combine(pair) for pair in zip(*parts, strict=True)}
    word = "and" if both else "or"
    results = decided(f"mode >= {low} {word} mode <= {high}")
    assert bool(results) == any(len(set(each)) == 1 for each in [*parts, verdicts])
