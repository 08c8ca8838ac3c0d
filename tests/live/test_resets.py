"""``deros reset`` at a running robot: the node decides, and its answer is printed."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from deros.live.graph import nodes_of_heartbeats, reporting_nodes
from deros.live.observer import Observer
from deros.live.resets import NoAnswerError, Resettable, reset
from tests.support.cli import Outcome
from tests.support.drawn_diagnostics import array
from tests.support.faults import GATE, NODE, WHEELS_GATE, Robot
from tests.support.played import scan
from tests.support.ros import LIMIT, Peer
from tests.support.shell import DEROS, deros_at, deros_until

BLOCKED, CLEAR = 0.1, 5.0
"""Distances ahead, in m, at which the robot may not drive, and may."""


def granted_by(robot: Robot, node: str) -> str:
    """Reset a node until that is granted; return its answer."""
    return deros_until(robot.env, lambda outcome: outcome.code == 0, "reset", node).out


@pytest.mark.ros
def test_safety_node_refuses_and_then_grants_a_reset(robot: Robot) -> None:
    """While the obstacle is there the reason is printed, with 1; after it the reset, with 0."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        sensors.play("/scan", scan(BLOCKED))
        robot.until_stopped()
        refused = deros_at(robot.env, "reset", NODE)
        assert (refused.code, refused.err) == (1, "")
        assert refused.out.startswith("stop stays active, called for by racing")
        assert robot.is_active("/stop")
        sensors.play("/scan", scan(CLEAR))
        assert granted_by(robot, f"/{NODE}") == "stop is reset\n"
        robot.until(lambda: not robot.is_active("/stop"))


@pytest.mark.ros
def test_gate_is_reset_after_the_safety_node(robot: Robot) -> None:
    """The gate names the lines that refuse, and then what it still waits for."""
    with robot.safety_node(), robot.wheels_gate(), robot.sensors() as sensors:
        refused = deros_at(robot.env, "reset", WHEELS_GATE)
        assert refused.code == 1
        assert "halt: zero" in refused.out
        sensors.drive()
        robot.until_free()
        assert granted_by(robot, WHEELS_GATE) == "reset: waits for a zero command\n"
        robot.until(lambda: robot.waiting == "waits for a zero command")


@pytest.mark.ros
def test_nodes_with_a_reset_are_listed(robot: Robot) -> None:
    """A gate in which nothing latches is not, and asking for its reset says why there is none."""
    with robot.safety_node(), robot.gate(), robot.wheels_gate():
        both = Outcome(0, f"/{NODE}\n/{WHEELS_GATE}\n", "")
        deros_until(robot.env, lambda outcome: outcome == both, "reset")
        none = deros_at(robot.env, "reset", GATE, "--timeout", "3")
        assert none.code == 2
        assert f"/{GATE} runs, but nothing of it can be reset" in none.err


@pytest.mark.ros
def test_name_that_no_node_has_is_answered_with_near_ones(robot: Robot) -> None:
    """A mistyped name, and one without its namespace."""
    with robot.safety_node():
        missing = deros_at(robot.env, "reset", "faulty_safty_node", "--timeout", "3")
        assert (missing.code, missing.out) == (2, "")
        assert "no node /faulty_safty_node was found within 3 s" in missing.err
        assert f"did you mean '/{NODE}'?" in missing.err
        moved = deros_at(robot.env, "reset", f"/front/{NODE}", "--timeout", "3")
        assert f"did you mean '/{NODE}'?" in moved.err


@pytest.mark.ros
def test_node_that_hangs_gives_no_answer(robot: Robot, monkeypatch: pytest.MonkeyPatch) -> None:
    """A node that hangs after it was found: nothing is claimed about what it will do later."""
    monkeypatch.setenv("ROS_DOMAIN_ID", robot.env["ROS_DOMAIN_ID"])
    with robot.safety_node() as node, Observer() as observer:
        resettable = Resettable(observer)
        observer.until(
            lambda: resettable.nodes() and nodes_of_heartbeats(observer), time.monotonic() + LIMIT
        )
        node.freeze()
        with pytest.raises(NoAnswerError, match="did not answer within 2 s"):
            reset(observer, f"/{NODE}", timeout=2)
        node.thaw()


@pytest.mark.ros
def test_service_of_another_node_is_not_called(
    ros_env: dict[str, str], ros_peer: Peer, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A driver that publishes diagnostics and has a reset: it is no safety node."""
    from diagnostic_msgs.msg import DiagnosticArray
    from std_srvs.srv import Trigger

    driver = ros_peer.node
    calls: list[Any] = []

    def answer(request: Any, response: Any) -> Any:
        calls.append(request)
        return response

    driver.create_service(Trigger, "~/reset", answer)
    publisher = driver.create_publisher(DiagnosticArray, "/diagnostics", 10)
    name = driver.get_fully_qualified_name()
    charging = array((name, 0, "charging", {"state": "charging"}), hardware_id="none")
    driver.create_timer(0.1, lambda: publisher.publish(charging))
    monkeypatch.setenv("ROS_DOMAIN_ID", ros_env["ROS_DOMAIN_ID"])
    with Observer() as observer:
        resettable, end = Resettable(observer), time.monotonic() + 3
        ros_peer.until(lambda: observer.until(resettable.nodes, 0) or time.monotonic() > end)
        assert name in reporting_nodes(observer)
        assert resettable.nodes() == ()
        with pytest.raises(NoAnswerError, match="nothing of it can be reset"):
            reset(observer, name, timeout=0.5)
    assert not calls


@pytest.mark.ros
def test_empty_domain_has_nothing_to_reset(ros_env: dict[str, str]) -> None:
    """Neither a list nor a name is a success then."""
    for arguments in (["reset"], ["reset", "gate"]):
        outcome = deros_at(ros_env, *arguments, "--timeout", "2")
        assert (outcome.code, outcome.out) == (2, "")
        assert "found within 2 s" in outcome.err


@pytest.mark.parametrize("name", ["~", "~/gate", "a b", "/", "gate/", "a//b", ""])
def test_name_that_no_node_can_have_is_a_usage_error(name: str) -> None:
    """Nothing is started for it."""
    done = subprocess.run([DEROS, "reset", name], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "Invalid value for '[NODE]'" in done.stderr


def test_environment_without_rclpy_says_what_to_install(tmp_path: Path) -> None:
    """It is a usage error like any other, without a traceback."""
    script = (
        "import sys; sys.modules['rclpy'] = None; from deros.cli.main import main; main(['reset'])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, cwd=tmp_path
    )
    assert done.returncode == 2
    assert "source the setup file of ROS 2" in done.stderr
    assert "deros[ros]" in done.stderr
