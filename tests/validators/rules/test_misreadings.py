"""Rules that can be misread (``tests/data/misreadings.md``): what the check says of each."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.support.checks import checked_rules
from tests.support.tables import rows

TOPICS = """\
odom : nav_msgs.Odometry
p : std_msgs.Bool
q : std_msgs.Bool
left : std_msgs.Bool
right : std_msgs.Bool
button : std_msgs.Bool
scan : sensor_msgs.LaserScan
front : sensor_msgs.Range
rear : sensor_msgs.Range
battery : sensor_msgs.BatteryState
motor : sensor_msgs.Temperature
air : sensor_msgs.Temperature
mode : std_msgs.UInt8
count : std_msgs.UInt8
big : std_msgs.UInt64
raw : std_msgs.Float64
half : std_msgs.Float32
heading : std_msgs.Float64 { data [rad] }
imu : sensor_msgs.Imu
status : diagnostic_msgs.DiagnosticStatus
stop : std_msgs.Bool
"""
SYSTEM = "system Robot\ntopics\n" + "".join(
    f"  external topic /{each}\n" for each in TOPICS.splitlines()
)

INPUTS = {
    "speed": "/odom.twist.twist.linear.x",
    "turn": "/odom.twist.twist.angular.z",
    "x": "/odom.pose.pose.position.x",
    "p": "/p.data",
    "q": "/q.data",
    "left": "/left.data",
    "right": "/right.data",
    "button": "/button.data",
    "scan": "/scan",
    "front": "/front.range",
    "rear": "/rear.range",
    "charge": "/battery.percentage",
    "volt": "/battery.voltage",
    "T": "/motor.temperature",
    "T0": "/air.temperature",
    "mode": "/mode.data",
    "count": "/count.data",
    "big": "/big.data",
    "raw": "/raw.data",
    "half": "/half.data",
    "heading": "/heading.data",
    "orientation": "/imu.orientation",
    "level": "/status.level",
}

BEHAVIOURS = {
    "": "if e.r or e.lost then { stop; };",
    "only": "if e.r then { stop; };",
    "opposite": "if not e.r or e.lost then { stop; };",
    "releases": "if e.bad or e.lost then { stop; }; if e.r then { release; };",
    "logs": 'if e.r then { stop; }; if e.lost then { log_state("lost"); };',
    "nests": "if e.r then { if e.lost then { stop; }; };",
}
"""The behaviours, by their name in the column ``then``."""


class Row(NamedTuple):
    """A rule ``r`` that can be misread, in a program that needs nothing else.

    Attributes:
        rule: its condition; ``failsafe r:`` may stand before it.
        it_means: what it means; where nothing is found, why that is all right, or what is not.
        found: the codes of ``check --strict``.
        then: the behaviours, which read ``e.r`` and ``e.lost``.
        lost: what ``e.lost`` asks of each input; nothing if empty.
        more: other rules of the entity.
        timeout: that of each input.
    """

    rule: str
    it_means: str
    found: str
    then: str
    lost: str
    more: str
    timeout: str

    def program(self) -> str:
        """Return the whole text; inputs are those that it names."""
        text = f"{self.rule} {self.more}"
        names = [each for each in INPUTS if re.search(rf"(?<![\w./]){each}\b", text)]
        release = "release" in self.then
        lines = [
            'use "robot.system" import Robot',
            "action stop publishes true on /stop : std_msgs.Bool "
            + ("reset_by release; action release;" if release else "latched;"),
            *(f"input {each} = topic {INPUTS[each]} {self.timeout}" for each in names),
            "entity e {",
            f"  {self.rule if 'r:' in self.rule else 'r: ' + self.rule}; {self.more}",
        ]
        if self.lost:
            lines.append(f"  lost: {' or '.join(f'{each}.{self.lost}' for each in names)};")
        return "\n".join([*lines, "}", self.then, ""])


def _row(cells: Mapping[str, str]) -> Row:
    then, lost = cells.get("then", ""), cells.get("lost") or "unknown()"
    return Row(
        cells["rule"],
        cells["it means"],
        cells["found"],
        BEHAVIOURS.get(then, then),
        "" if lost == "-" else lost,
        cells.get("more", ""),
        "" if cells.get("timeout") == "-" else "timeout 0.5 sec",
    )


ROWS = tuple(map(_row, rows("misreadings")))


def codes(program: str, folder: Path) -> list[str]:
    """Return the codes of all findings of a program, in the order of the file."""
    return [each.code.name for each in checked_rules(program, SYSTEM, folder)]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row.rule}; {row.it_means}")
def test_check_says_so(row: Row, tmp_path: Path) -> None:
    """The findings are these, and no others."""
    assert sorted(codes(row.program(), tmp_path)) == sorted(row.found.split())


def test_there_are_enough_of_them() -> None:
    """No row is lost, and no two are equal."""
    assert len(ROWS) >= 60
    assert len({each.program() for each in ROWS}) == len(ROWS)
