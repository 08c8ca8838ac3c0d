"""The demo of the wheeled robots' faults, without ROS: its usage, what it reads, what it draws."""

from __future__ import annotations

import subprocess
import sys

import pytest

from deros.metamodels.load import Repository
from deros.models.system import System
from tests.support.examples import EXAMPLES, example_module

example_module("feeding_robot", "demonstration.chart")
robots = example_module("faults", "shown.robots")
run = example_module("faults", "shown.run")
picture = example_module("faults", "shown.picture")
KOBUKI = next(each for each in robots.ROBOTS if each.name == "kobuki")
IN_PHYSICS = [robots.in_physics(each, simulated=True) for each in robots.ROBOTS]

LOG = """\
[INFO] [100.25] [kobuki_gate]: stop: zero (kobuki.deros:40)
[WARN] [107.50] [base]: fault: runaway
[WARN] [107.90] [safety]: stop: too fast, by too_fast
[WARN] [108.40] [safety]: stop: outside the yard
"""


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["kobuki", "--fault", "wings"], "no fault wings; there are throttle, spin, load, astray"),
        (["kobuki", "--clock", "simulated"], "--clock needs --physics"),
        (["tank"], "invalid choice: 'tank'"),
        (["tank"], "intelligent_one,feeding_robot}"),
        (["feeding_robot"], "feeding_robot has another demo without --physics: make demo"),
    ],
)
def test_what_it_does_not_know_is_refused(arguments: list[str], message: str) -> None:
    """With what there is, before anything is generated."""
    command = [sys.executable, str(EXAMPLES / "faults/demo.py"), *arguments]
    outcome = subprocess.run(command, capture_output=True, text=True, check=False)
    assert outcome.returncode == 2
    assert message in outcome.stderr


@pytest.mark.parametrize(
    "robot", [*robots.ROBOTS, *IN_PHYSICS], ids=lambda each: each.system.rpartition("/")[2]
)
def test_each_robot_has_the_faults_that_its_system_takes(robot: object) -> None:
    """A fault that is misspelled in the table would start a robot without one."""
    assert isinstance(robot, robots.Robot)
    system = Repository().load(str(EXAMPLES / robot.system)).model
    assert isinstance(system, System)
    taken = {str(each.name): each for each in system.arguments}
    assert set(robot.arguments) <= set(taken)
    if robot.argument:
        assert set(robot.faults) <= set(taken[robot.argument].choices or ())


def test_reasons_are_those_of_the_safety_node_after_the_fault() -> None:
    """What a gate says at its start is none; the first reason counts."""
    outcome = run.Outcome("runaway", "stop: too fast")
    run._read(LOG, outcome)
    assert outcome.said == ["stop: too fast, by too_fast", "stop: outside the yard"]
    assert outcome.seconds == pytest.approx(0.4)
    assert outcome.passed


@pytest.mark.parametrize(
    ("said", "overdue"),
    [([], "it was not stopped"), (["stop: it spins"], ""), (["stop: too fast"], "no rest")],
)
def test_other_reason_or_none_fails(said: list[str], overdue: str) -> None:
    """So does a robot that does not come to rest."""
    outcome = run.Outcome("runaway", "stop: too fast", said=said, overdue=overdue)
    assert not outcome.passed


def test_picture_has_the_way_the_yard_and_the_place_of_the_stop() -> None:
    """The way ends within the frame, and the stop is where the robot was then."""
    motions = [run.Motion(t * 0.1, t * 0.02, 0.0, 0.2, 0.0) for t in range(50)]
    outcome = run.Outcome("runaway", "stop: ", ["stop: <fast>"], 0.4, 2.5, motions)
    zones = picture.areas(KOBUKI)
    assert [each.name for each in zones] == ["yard"]
    text = picture.page(KOBUKI, [outcome], zones)
    assert "stop: &lt;fast&gt;" in text
    reach = 1.2 * 1.1
    assert f'cx="{(1 + 0.5 / reach) * picture.SIDE / 2:.1f}" cy="150.0"' in text
    assert "1 of 1" in text
