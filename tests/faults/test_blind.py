"""Sensors that publish without information: a covered lidar, an attitude of zeros."""

from __future__ import annotations

import math
import shutil
from pathlib import Path

import pytest

from tests.faults.conftest import RULES
from tests.faults.test_gate import assert_zeros_only, is_stopped
from tests.support.faults import CppRobot, PythonRobot, Robot, Software
from tests.support.needs import needs
from tests.support.played import imu, scan
from tests.support.victims import Sensors

pytestmark = pytest.mark.ros

WATCHFUL = {
    "input scan = topic /scan\n": "input scan = topic /scan timeout 0.5 sec\n",
    "entity space { blocked:": "entity space { failsafe blocked:",
    "numb: orientation.missing();": "numb: orientation.tilt().unknown();",
}
"""Replacements in the rules of the other tests that make the robot react to unknown values."""

NEAREST = "scan.nearest(-0.523599, 0.523599)"
CLEAR = 5.0
blind = pytest.mark.parametrize(
    "ahead",
    [
        pytest.param(0.0, id="zero"),
        pytest.param(math.nan, id="nan", marks=pytest.mark.slow),
        pytest.param(0.03, id="below_range_min", marks=pytest.mark.slow),
    ],
)


@pytest.fixture(scope="module", params=["python", pytest.param("cpp", marks=needs("rclcpp"))])
def software(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Software:
    """Return the nodes of the robot with failsafe rules, in each language."""
    folder = tmp_path_factory.mktemp("watchful")
    models = shutil.copytree(RULES.parent, folder / "models")
    robot_class = PythonRobot if request.param == "python" else CppRobot
    return robot_class(_failsafe_rules(models), folder / "package")


def _failsafe_rules(models: Path) -> Path:
    """Rewrite the rules in a folder, and return their path."""
    rules = models / RULES.name
    text = rules.read_text(encoding="utf-8")
    for now, then in WATCHFUL.items():
        assert text.count(now) == 1
        text = text.replace(now, then)
    rules.write_text(text, encoding="utf-8")
    return rules


def _drive(robot: Robot, sensors: Sensors) -> None:
    """Let all sensors see, reset the initial stop, and drive."""
    sensors.drive()
    robot.until_free()
    robot.until(lambda: robot.reset()[0])
    robot.until_driving()


@blind
def test_lidar_covered_ahead_stops_the_robot(robot: Robot, ahead: float) -> None:
    """Its scans arrive and other beams measure; the robot must not drive into a blind sector."""
    with robot.safety_node(), robot.gate(), robot.sensors() as sensors:
        _drive(robot, sensors)
        sensors.play("/scan", scan(CLEAR, ahead=ahead), rate=10.0)
        robot.until_stopped(limit=0.5 + 1.0)
        told = "0.03" if ahead > 0.0 else "unknown"  # below range_min is near, not blind
        robot.until(lambda: robot.event("trigger", "stop")[f"value {NEAREST}"] == told)
        robot.until(lambda: is_stopped(robot))
        stopped = len(robot.commands)
        success, why = robot.reset()
        assert not success
        assert "racing (faulty.deros:" in why
        assert_zeros_only(robot, stopped)
        sensors.play("/scan", scan(CLEAR), rate=10.0)
        robot.until(lambda: robot.reset()[0])
        robot.until_driving()


@pytest.mark.slow
@blind
def test_lidar_covered_all_around_stops_the_robot(robot: Robot, ahead: float) -> None:
    """A scan without a valid beam does not count, but the rule is unknown at once."""
    with robot.safety_node(), robot.gate(), robot.sensors() as sensors:
        _drive(robot, sensors)
        sensors.play("/scan", scan(ahead), rate=10.0)
        robot.until_stopped(limit=0.5 + 1.0)
        robot.until(lambda: is_stopped(robot))


@pytest.mark.slow
def test_lidar_covered_from_the_start_keeps_the_robot_stopped(robot: Robot) -> None:
    """Its first scan ends the waiting, and the stop follows."""
    with robot.safety_node(), robot.gate(), robot.sensors() as sensors:
        sensors.drive()
        sensors.play("/scan", scan(CLEAR, ahead=0.0), rate=10.0)
        robot.until_free()
        robot.until_stopped()
        assert not robot.reset()[0]
        robot.until(lambda: is_stopped(robot))


@pytest.mark.slow
def test_attitude_of_zeros_stops_the_robot(robot: Robot) -> None:
    """A quaternion of zeros is not an attitude; it arrives in time, so the input is not missing."""
    with robot.safety_node(), robot.gate(), robot.sensors() as sensors:
        _drive(robot, sensors)
        nowhere = imu()
        nowhere.orientation.w = 0.0
        sensors.play("/imu", nowhere)
        robot.until_stopped("/halt", limit=0.5 + 1.0)
        robot.until(lambda: is_stopped(robot))
        sensors.play("/imu", imu())
        robot.until_free()
