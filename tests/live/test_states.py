"""``deros state``: reports of safety nodes and gates, from messages and at a running robot."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

import pytest

from deros.cli.commands.state import show
from deros.generators import runtime
from deros.live.observer import Observer
from deros.live.states import ActiveAction, NodeState, Reports, RobotState, robot_state
from tests.support.drawn_diagnostics import array
from tests.support.faults import GATE, NODE, WHEELS_GATE, Robot
from tests.support.played import scan
from tests.support.ros import LIMIT
from tests.support.shell import deros_at, deros_until

OK, WARN, ERROR = 0, 1, 2
BLOCKED = 0.1
"""A distance ahead, in m, at which the robot may not drive."""


WATCHING = ("/guard", OK, "watching 2 rules", {"state": "watching"})
STOPPED = (
    "/guard: action stop",
    WARN,
    "active",
    {"runs": "1", "cause": "near", "because": "space.blocked: x < 1", "since": "2.000 s ago"},
)
RELEASED = ("/guard: action stop", OK, "inactive", {"runs": "1"})
PASSING = ("/gate", OK, "commands pass", {"refused": "0", "since": "1.000 s ago", "since_ns": "1"})


def test_gate_is_complete_with_one_status() -> None:
    """A gate reports all in one status."""
    reports = Reports()
    reports.take(array(PASSING))
    assert reports.states() == (NodeState("/gate", "gate", "ok", "commands pass", "1.000 s ago"),)


def test_safety_node_is_complete_when_its_next_report_begins() -> None:
    """Until then an action may be missing: nothing is said about the node."""
    reports = Reports()
    reports.take(array(STOPPED))  # the rest of a report whose beginning was missed
    assert not reports.incomplete()
    reports.take(array(WATCHING))
    assert not reports.states()
    assert reports.incomplete() == {"/guard"}
    reports.take(array(STOPPED))
    reports.take(array(WATCHING))
    stop = ActiveAction("stop", "near", "space.blocked: x < 1", "2.000 s ago")
    state = NodeState("/guard", "safety node", "ok", "watching 2 rules", "", (stop,))
    assert reports.states() == (state,)
    assert not state.is_clear


def test_last_report_of_an_action_counts() -> None:
    """An action that was reset is not shown."""
    reports = Reports()
    reports.take(array(WATCHING, STOPPED))
    reports.take(array(WATCHING, RELEASED))
    assert [state.actions for state in reports.states()] == [()]
    assert RobotState(reports.states(), ()).is_clear


def test_other_diagnostics_are_left_out() -> None:
    """Drivers and aggregators publish on the same topic."""
    reports = Reports()
    for hardware in ("", "none", "motor-4711"):
        reports.take(
            array(("motor: temperature", ERROR, "hot", {"state": "hot"}), hardware_id=hardware)
        )
        reports.take(
            array(("/battery", OK, "charging", {"state": "charging"}), hardware_id=hardware)
        )
        reports.take(array(PASSING, hardware_id=hardware))
    reports.take(array(("/Robot/Other/ guard", OK, "watching 2 rules", {"state": "watching"})))
    assert (reports.complete(), reports.incomplete()) == (frozenset(), frozenset())


@pytest.mark.parametrize("source", ["python/deros_runtime/*.py", "cpp/src/*.cpp"])
def test_nodes_in_both_languages_name_the_hardware(source: str) -> None:
    """It is what their reports are known by."""
    texts = [path.read_text() for path in Path(runtime.__file__).parent.glob(source)]
    for hardware in ("deros safety node", "deros gate"):
        assert (
            sum(
                f"HARDWARE_ID = {quote}{hardware}{quote}" in text
                for text in texts
                for quote in "'\""
            )
            == 1
        )


def test_table_has_a_row_for_each_node_and_active_action(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Brackets of a gate's limits are no markup, and nothing is wrapped outside of a terminal."""
    limit = "slow: limit linear.x to [-0.1, 0.1] m/s (robot.deros:7)" + " and more" * 20
    stop = ActiveAction("stop", "active before the start", "", "")
    nodes = (
        NodeState("/gate", "gate", "warning", limit, "1.000 s ago"),
        NodeState("/guard", "safety node", "ok", "watching 2 rules", "", (stop,)),
    )
    show(RobotState(nodes, ("/third",)), "text")
    header, *rows = (line.split() for line in capsys.readouterr().out.splitlines())
    assert header == ["NODE", "LEVEL", "STATE", "SINCE"]
    assert rows == [
        ["/gate", "warning", *limit.split(), "1.000", "s", "ago"],
        ["/guard", "ok", "watching", "2", "rules"],
        ["action", "stop", "active", "active", "before", "the", "start"],
        ["/third", "unknown", "runs,", "but", "has", "not", "reported", "in", "time"],
    ]


def test_json_has_all_that_is_known(capsys: pytest.CaptureFixture[str]) -> None:
    """The keys are those of the data."""
    reports = Reports()
    reports.take(array(PASSING, WATCHING, STOPPED, WATCHING))
    show(RobotState(reports.states(), ("/third",)), "json")
    shown = json.loads(capsys.readouterr().out)
    assert shown["silent"] == ["/third"]
    gate, guard = shown["nodes"]
    assert (gate["kind"], gate["message"], gate["actions"]) == ("gate", "commands pass", [])
    assert guard["actions"][0]["because"] == "space.blocked: x < 1"


def test_text_of_a_node_cannot_control_the_terminal() -> None:
    """Anybody can publish diagnostics under the name of a gate."""
    reports = Reports()
    reports.take(array(("/gate", OK, "\x1b[2Jfine", {"refused": "0", "since_ns": "1"})))
    assert reports.states()[0].message == "?[2Jfine"


def state_of(robot: Robot) -> tuple[int, dict[str, Any]]:
    """Return the exit code of ``deros state``, and each node that reported, by its name."""
    outcome = deros_at(robot.env, "state", "--format", "json")
    shown = json.loads(outcome.out)
    assert shown["silent"] == []
    return outcome.code, {node["node"]: node for node in shown["nodes"]}


@pytest.mark.ros
def test_state_of_a_stopped_robot(robot: Robot) -> None:
    """The latched stop is shown with its cause, and of each gate what it applies or waits for."""
    with (
        robot.safety_node(),
        robot.gate(),
        robot.wheels_gate(),
        robot.sensors() as sensors,
    ):
        sensors.drive()
        robot.until_free()
        sensors.play("/scan", scan(BLOCKED))
        robot.until_stopped()
        code, nodes = state_of(robot)
        assert code == 1
        assert set(nodes) == {f"/{NODE}", f"/{GATE}", f"/{WHEELS_GATE}"}
        (stop,) = nodes[f"/{NODE}"]["actions"]
        assert (stop["name"], stop["behaviour"]) == ("stop", "racing")
        assert stop["because"].startswith("space.blocked: ")
        assert nodes[f"/{GATE}"]["message"].startswith("stop: zero")
        assert "waits for a reset" in nodes[f"/{WHEELS_GATE}"]["message"]


@pytest.mark.ros
def test_gate_that_lets_commands_pass_is_clear(robot: Robot) -> None:
    """Named alone, only it is waited for, whatever other nodes report."""
    with robot.safety_node(), robot.gate(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_driving()
        arguments = ("state", GATE, "--format", "json")
        outcome = deros_until(robot.env, lambda outcome: outcome.code == 0, *arguments)
        (gate,) = json.loads(outcome.out)["nodes"]
        assert (gate["node"], gate["message"]) == (f"/{GATE}", "commands pass")


@pytest.mark.ros
def test_node_that_hangs_is_unknown(robot: Robot, monkeypatch: pytest.MonkeyPatch) -> None:
    """A node that is known by its heartbeat and says nothing makes the state not clear."""
    monkeypatch.setenv("ROS_DOMAIN_ID", robot.env["ROS_DOMAIN_ID"])
    with robot.safety_node() as node, robot.gate():
        with Observer() as observer:
            everybody = {f"/{NODE}", f"/{GATE}"}
            found = robot_state(observer, None, LIMIT)
            assert {state.node for state in found.nodes} == everybody
            node.freeze()
            time_out = 4.0
            began = time.monotonic()
            hung = robot_state(observer, None, time_out)
            assert time.monotonic() - began >= time_out
            node.thaw()
        assert hung.silent == (f"/{NODE}",)
        assert not hung.is_clear


@pytest.mark.ros
def test_domain_without_reports_is_no_success(ros_env: dict[str, str]) -> None:
    """Silence does not show that nothing holds the robot."""
    for arguments in (["state"], ["state", "gate"]):
        outcome = deros_at(ros_env, *arguments, "--timeout", "1")
        assert (outcome.code, outcome.out) == (2, "")
        assert "reported within 1 s" in outcome.err
