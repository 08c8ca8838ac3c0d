"""Faults in the code that users write into actions: the stop comes first, and stays."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from tests.support.faults import NODE, PROMPT, Robot
from tests.support.ros import LIMIT
from tests.support.victims import Process

pytestmark = pytest.mark.ros

HEARTBEAT = f"/{NODE}/heartbeat"

FAILURES = {
    "throw": "action interfere failed",
    "throw something else": "action interfere failed",
    "exit": "exit",
    "shutdown": "shut down",
    "start a thread and throw": "action interfere failed",
}
"""What the code does, and a part of the reason that the node prints."""


@pytest.mark.parametrize("how", FAILURES)
def test_code_that_ends_the_node_costs_neither_stop_nor_latch(robot: Robot, how: str) -> None:
    """The stop written after the code is out, the node ends with 1, and a restart finds it."""
    with robot.safety_node() as node:
        robot.interfere(how)
        robot.until_stopped(limit=PROMPT)
        assert node.popen.wait(LIMIT) == 1
        assert f"interference: {how}" in node.output()
        assert FAILURES[how] in node.output()
        seen = len(robot.states["/stop"])
        robot.restart()
        assert all(each.value for each in robot.states["/stop"][seen:]), "a restart undid the stop"


def test_a_node_that_fails_leaves_the_graph_at_once(robot: Robot) -> None:
    """Nobody takes what is left of it for a second publisher once it has been started again."""
    with robot.safety_node() as node:
        robot.until(lambda: robot.peer.node.count_publishers(HEARTBEAT) == 1)
        robot.interfere("throw")
        assert node.popen.wait(LIMIT) == 1
        robot.until(lambda: robot.peer.node.count_publishers(HEARTBEAT) == 0, limit=PROMPT)
        robot.restart()


@pytest.mark.parametrize("how", ["exit at once", "kill"])
def test_code_that_ends_the_process_costs_neither_stop_nor_latch(robot: Robot, how: str) -> None:
    """No node can survive it, but the stop was published and stored as pending before."""
    with robot.safety_node() as node:
        robot.interfere(how)
        robot.until_stopped(limit=PROMPT)
        node.popen.wait(LIMIT)
        seen = len(robot.states["/stop"])
        robot.restart()
        assert all(each.value for each in robot.states["/stop"][seen:]), "a restart undid the stop"


def test_slow_code_delays_no_stop(robot: Robot) -> None:
    """A stop that is written after code that takes for ever does not wait for it."""
    with robot.safety_node() as node:
        robot.interfere("wait")
        robot.until_stopped(limit=PROMPT)
        robot.until(lambda: "interference: wait" in node.output())
        robot.spin(0.5)
        beats = len(robot.beats)
        robot.spin(0.5)
        assert len(robot.beats) == beats, "the heartbeat hides that the code hangs"
        robot.let_go_on()
        robot.until_alive()


@pytest.mark.parametrize("how", ["wait", "exit"])
def test_code_that_is_run_again_at_the_start_comes_after_the_states(
    robot: Robot, tmp_path: Path, how: str
) -> None:
    """A latched action that is code keeps no latched stop back, nor loses it by its failure."""
    file = tmp_path / "state"
    with robot.safety_node(f"state_file:={file}") as node:
        node.end()
        robot.spin(0.3)  # in which what it has sent before is heard
        file.write_bytes(b"")  # damaged: all that is latched is active
        (robot.folder / "interference").write_text(how, encoding="ascii")
        beats = len(robot.beats)
        node = robot.start(NODE, [f"state_file:={file}"])
        if how == "wait":
            robot.until_stopped()
            assert len(robot.beats) == beats, "the stop has waited for the code"
            robot.let_go_on()
            robot.until_alive()
            node.end()
        else:
            assert robot.until(lambda: node.popen.poll() is not None)
            assert node.popen.returncode == 1
        assert f"interference: {how}" in node.output()
        robot.restart()
        assert robot.is_active("/stop")


def test_code_that_does_not_do_its_work_is_believed(robot: Robot) -> None:
    """A body that only says that it acted looks like one that did; bound actions do not need it."""
    with robot.safety_node() as node:
        robot.interfere("claim")
        robot.until_stopped(limit=PROMPT)
        robot.until(lambda: "interference: claim" in node.output())
        robot.until_alive()
        assert robot.faults == {}


def test_each_order_runs_the_code_once_and_in_turn(robot: Robot) -> None:
    """Two violations are two calls, each once, and in the order in which they came."""
    orders = ["first", "second"]
    with robot.safety_node() as node, robot.sensors() as sensors:
        sensors.drive()
        for order in orders:
            robot.interfere(order)
            robot.until_stopped(limit=PROMPT)
            robot.until(lambda: robot.reset()[0])
            robot.until(lambda: not robot.is_active("/stop"))
        robot.spin(0.5)
        assert _calls(node) == orders


def _calls(node: Process) -> list[str]:
    """Return what the code has said that it did, in order."""
    return re.findall(r"interference: (\w+)$", node.output(), re.MULTILINE)


def test_code_runs_with_the_rights_of_the_node(robot: Robot) -> None:
    """It is a part of the process: whoever writes it may do whatever the node may."""
    with robot.safety_node() as node:
        robot.interfere("who")
        robot.until_stopped(limit=PROMPT)
        who = f"process {node.popen.pid} of user {os.geteuid()}"
        robot.until(lambda: who in node.output())
