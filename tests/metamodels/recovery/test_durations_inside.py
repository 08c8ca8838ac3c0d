"""A condition that goes on behind a duration gives one finding, whose hint is a condition."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from tests.support.checks import checked
from tests.support.tables import rows

SYSTEM = """\
system Courier
topics
  external topic /imu : sensor_msgs.Imu
  external topic /odom : nav_msgs.Odometry
  external topic /release : std_msgs.Bool
"""
RULES = """\
use "c.system" import Courier
action stop;
input orientation = topic /imu.orientation timeout 0.2 sec
input speed = topic /odom.twist.twist.linear.x timeout 0.2 sec
input button = topic /release.data timeout 1 sec
entity e {
  a: orientation.roll() > 0.2;
  b: speed.abs() > 0.5 m/s;
  c: button;
  blind: orientation.roll().unknown() or speed.unknown() or button.missing();
  d: button;
}
if e.a or e.b or e.c or e.blind then { stop; };
if e.d then { log_state("pressed"); };
"""


def _found(folder: Path, old: str, new: str) -> list[Diagnostic]:
    assert old in RULES
    (folder / "c.system").write_text(SYSTEM, encoding="utf-8")
    (folder / "c.deros").write_text(RULES.replace(old, new), encoding="utf-8")
    return checked(folder / "c.deros")


BEHAVIOUR = "e.a or e.b or e.c or e.blind"
RULE = "d: button;"


PLACES = {"behaviour": BEHAVIOUR, "rule": RULE}
CASES = [
    (PLACES[each["in place of"]], each["written"], each["hint"])
    for each in rows("durations_inside")
]


@pytest.mark.parametrize(("old", "new", "hint"), CASES)
def test_condition_behind_a_duration(tmp_path: Path, old: str, new: str, hint: str) -> None:
    """One finding at the statement, and none that only follows from it."""
    findings = _found(tmp_path, old, new)
    first = findings[0]
    assert (first.code.name, first.hint) == ("DRS003", hint)
    assert "closes a condition" in first.message
    assert all(each.code.name == "DRS003" for each in findings), findings
    if "since" not in new:
        assert len(findings) == 1


@pytest.mark.parametrize(
    "new",
    [
        "e.a for 0.4 sec or e.b or e.c or e.blind",
        "e.a or e.b for 1 sec or e.c or e.blind",
        "e.a within 1 sec and e.b for 2 sec or e.c or e.blind",
    ],
)
def test_hint_checks_clean(tmp_path: Path, new: str) -> None:
    """What each hint says to write, in place of what it shows, is a condition without findings."""
    (finding,) = _found(tmp_path, BEHAVIOUR, new)
    readings = re.findall(r"'([^']*)'", finding.hint)
    assert readings
    for reading in readings:
        shown = reading.replace("(", "").replace(")", "")
        assert _found(tmp_path, BEHAVIOUR, new.replace(shown, reading)) == []


@pytest.mark.parametrize(
    ("new", "hint"),
    [
        ("e.a) for 1 sec or e.b or e.c or e.blind", ""),
        ("e.blind and e.b or e.c or e.a for 1 sec or", "write '(e.blind and e.b or e.c or e.a"),
        ("e.blind for 1 sec or", "write '(e.blind for 1 sec) or …'"),
        ("for 1 sec or e.blind", ""),
    ],
)
def test_other_faults_beside_a_duration(tmp_path: Path, new: str, hint: str) -> None:
    """A condition that is broken elsewhere, too, is an error as any other."""
    findings = _found(tmp_path, BEHAVIOUR, new)
    errors = [each for each in findings if each.code.name == "DRS003"]
    assert errors
    assert errors[0].hint.startswith(hint)


def test_findings_inside_the_condition_keep_their_places(tmp_path: Path) -> None:
    """The parentheses that the repair puts in are not counted."""
    slip = "d: speed > 1 m/s  since\n    speed > 0.5 m/s for 1 sec;"
    found = _found(tmp_path, RULE, slip)
    assert [(each.code.name, each.span.text) for each in found] == [
        ("DRS373", "speed > 1 m/s  since\n    speed > 0.5 m/s"),
        ("DRS003", "speed > 1 m/s  since\n    speed > 0.5 m/s "),
    ]
