"""Single beams of a laser scan."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from tests.support.checks import found_in_rules

SYSTEM = """\
system Robot
topics
  external topic /scan : sensor_msgs.LaserScan
  external topic /rear : sensor_msgs.LaserScan
  external topic /data : std_msgs.Float32MultiArray
  external topic /stop : std_msgs.Bool
"""
HEAD = """\
use "robot.system" import Robot
action stop;
input scan = topic /scan
input first = topic /scan.ranges[0]
input all = topic /scan.ranges
input rear = topic /rear
input data = topic /data.data
"""


def found(condition: str, folder: Path) -> list[Diagnostic]:
    """Return the findings of this kind of a rule."""
    text = f"{HEAD}entity e {{ r: {condition}; }}\nif e.r then {{ stop; }};\n"
    return found_in_rules("DRS382", text, SYSTEM, folder)


@pytest.mark.parametrize(
    ("condition", "where"),
    [
        ("scan.ranges[0] < 0.5 m", "at 'angle_min'"),
        ("scan.ranges[180] < 0.5 m", "180 steps from 'angle_min'"),
        ("first < 0.5 m", "at 'angle_min'"),
        ("all[3] < 0.5 m", "3 steps from 'angle_min'"),
        ("/scan.ranges[0] < 0.5 m", "at 'angle_min'"),
        ("first not in [0.5 m, 9 m]", "at 'angle_min'"),
        ("first < rear.ranges.min()", "at 'angle_min'"),
        ("first * 2 < 1 m", "at 'angle_min'"),
        ("min(first, scan.ranges[1]) < 1 m", "at 'angle_min'"),
    ],
)
def test_single_beam_is_reported(condition: str, where: str, tmp_path: Path) -> None:
    """The finding stands at the comparison, and says which beam it is."""
    (finding,) = found(condition, tmp_path)
    assert finding.span.text == condition
    assert f"one beam, {where}:" in finding.message


@pytest.mark.parametrize(
    "condition",
    [
        "scan.nearest(-10 deg, 10 deg) < 0.5 m",
        "all.min() < 0.5 m",
        "scan.ranges.count() < 10",
        "scan.intensities[0] > 100",
        "scan.range_min > 1 m",
        "first = first.previous()",
        "data[0] < 0.5",
    ],
)
def test_other_fields_are_silent(condition: str, tmp_path: Path) -> None:
    """Sectors, whole arrays, intensities, frozen scanners and other arrays are no single beams."""
    assert not found(condition, tmp_path)


def test_hint_names_a_whole_scan(tmp_path: Path) -> None:
    """``nearest()`` is a function of the whole message."""
    (finding,) = found("scan.ranges[0] < 0.5 m", tmp_path)
    assert finding.hint == "write 'scan.nearest(-10 deg, 10 deg)' for a sector"
    (finding,) = found("first < 0.5 m", tmp_path)
    assert "'input scan = topic /scan'" in finding.hint


def test_one_finding_per_scan(tmp_path: Path) -> None:
    """More beams of one scan are places of one finding."""
    one = "scan.ranges[0] < 1 m or scan.ranges[1] < 1 m"
    (finding,) = found(one, tmp_path)
    assert [each.span.text for each in finding.related] == ["scan.ranges[1] < 1 m"]
    assert len(found(f"{one} or rear.ranges[0] < 1 m", tmp_path)) == 2
