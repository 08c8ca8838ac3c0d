"""Faults in user code of actions: the stop comes first, and lasts."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from tests.support.faults import NODE, PROMPT, Robot
from tests.support.profiles import slow
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
"""Modes of failure, and a part of the reason that the node prints."""


@pytest.mark.parametrize("how", ["throw", *map(slow, sorted(FAILURES.keys() - {"throw"}))])
def test_user_code_that_ends_the_node_loses_neither_stop_nor_latch(robot: Robot, how: str) -> None:
    """The stop after the code is published, the node exits with 1, and the latch is stored."""
    with robot.safety_node() as node:
        robot.interfere(how)
        robot.until_stopped(limit=PROMPT)
        assert node.popen.wait(LIMIT) == 1
        assert f"interference: {how}" in node.output()
        assert FAILURES[how] in node.output()
        seen = len(robot.states["/stop"])
        robot.restart()
        assert all(state.value for state in robot.states["/stop"][seen:]), (
            "a restart undid the stop"
        )


@pytest.mark.slow
def test_failed_node_leaves_the_graph_at_once(robot: Robot) -> None:
    """After a restart its remains do not count as a second publisher."""
    with robot.safety_node() as node:
        robot.until(lambda: robot.peer.node.count_publishers(HEARTBEAT) == 1)
        robot.interfere("throw")
        assert node.popen.wait(LIMIT) == 1
        robot.until(lambda: robot.peer.node.count_publishers(HEARTBEAT) == 0, limit=PROMPT)
        robot.restart()


@pytest.mark.slow
@pytest.mark.parametrize("how", [slow("exit at once"), "kill"])
def test_user_code_that_ends_the_process_loses_neither_stop_nor_latch(
    robot: Robot, how: str
) -> None:
    """The node cannot survive it, but the stop was published and stored as pending before."""
    with robot.safety_node() as node:
        robot.interfere(how)
        robot.until_stopped(limit=PROMPT)
        node.popen.wait(LIMIT)
        seen = len(robot.states["/stop"])
        robot.restart()
        assert all(state.value for state in robot.states["/stop"][seen:]), (
            "a restart undid the stop"
        )


@pytest.mark.slow
def test_slow_user_code_does_not_delay_a_stop(robot: Robot) -> None:
    """A stop after code that never returns does not wait for it."""
    with robot.safety_node() as node:
        robot.interfere("wait")
        robot.until_stopped(limit=PROMPT)
        robot.until(lambda: "interference: wait" in node.output())
        robot.spin(0.5)
        beats = len(robot.beats)
        robot.spin(0.5)
        assert len(robot.beats) == beats, "the heartbeat continues although the code hangs"
        robot.let_go_on()
        robot.until_alive()


@pytest.mark.slow
@pytest.mark.parametrize("how", ["wait", slow("exit")])
def test_user_code_repeated_at_the_start_runs_after_the_states(
    robot: Robot, tmp_path: Path, how: str
) -> None:
    """A latched action with user code neither delays a latched stop nor loses it by a failure."""
    file = tmp_path / "state"
    with robot.safety_node(f"state_file:={file}") as node:
        node.end()
        robot.spin(0.3)  # time for its earlier messages to arrive
        file.write_bytes(b"")  # damaged: all latched actions are active
        (robot.folder / "interference").write_text(how, encoding="ascii")
        beats = len(robot.beats)
        node = robot.start(NODE, [f"state_file:={file}"])
        if how == "wait":
            robot.until_stopped()
            assert len(robot.beats) == beats, "the stop waited for the code"
            robot.let_go_on()
            robot.until_alive()
            node.end()
        else:
            assert robot.until(lambda: node.popen.poll() is not None)
            assert node.popen.returncode == 1
        assert f"interference: {how}" in node.output()
        robot.restart()
        assert robot.is_active("/stop")


@pytest.mark.slow
def test_user_code_without_effect_is_not_detected(robot: Robot) -> None:
    """Code that only claims to act looks like code that acts; bound actions need no such trust."""
    with robot.safety_node() as node:
        robot.interfere("claim")
        robot.until_stopped(limit=PROMPT)
        robot.until(lambda: "interference: claim" in node.output())
        robot.until_alive()
        assert robot.faults == {}


def test_each_order_runs_the_code_once_in_sequence(robot: Robot) -> None:
    """Two violations are two calls, each once, in their order."""
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
    """Return the actions reported by the code, in order."""
    return re.findall(r"interference: (\w+)$", node.output(), re.MULTILINE)


@pytest.mark.slow
def test_user_code_has_the_privileges_of_the_node(robot: Robot) -> None:
    """It runs in the process of the node: its author may do anything that the node may."""
    with robot.safety_node() as node:
        robot.interfere("who")
        robot.until_stopped(limit=PROMPT)
        who = f"process {node.popen.pid} of user {os.geteuid()}"
        robot.until(lambda: who in node.output())
