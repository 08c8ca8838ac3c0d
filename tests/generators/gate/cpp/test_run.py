"""The C++ gate in place of the Python one, in its own process and in a container.

Behaviour common to both languages is tested with the Python gate, in tests that run with each.
"""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from tests.support import gate_cpp_nodes
from tests.support.containers import running_container
from tests.support.cpp import overlay
from tests.support.gate_nodes import World
from tests.support.gate_runners import RunGate, in_cpp, in_python
from tests.support.needs import needs
from tests.support.ros import LIMIT, Peer

pytestmark = [pytest.mark.ros, needs("rclcpp")]

GATE = "cmd_vel_gate"


@pytest.fixture
def gates(tmp_path: Path) -> tuple[RunGate, RunGate]:
    """Return functions that run the gates in Python and in C++."""
    return in_python(tmp_path), in_cpp(tmp_path)


@pytest.fixture
def world(ros_peer: Peer) -> World:
    """Return the simulated surroundings of the gate."""
    return World(ros_peer)


def test_gates_of_both_languages_exclude_each_other(
    gates: tuple[RunGate, RunGate], ros_env: dict[str, str], world: World
) -> None:
    """They share one lock: the second exits at once and names the first, which continues."""
    for first, second in (gates, reversed(gates)):
        with first(GATE, ros_env) as guarding:
            world.meet()
            with second(GATE, ros_env) as refused:
                output, _ = refused.communicate(timeout=LIMIT)
            assert refused.returncode == 1
            assert f"as process {guarding.pid}: this second one ends now" in output
            world.release()
        world.heard.clear()


def test_gates_of_both_languages_replace_each_other(
    gates: tuple[RunGate, RunGate], ros_env: dict[str, str], world: World
) -> None:
    """After a kill, the other one publishes zero until everything is known again."""
    for run_gate in (*gates, *gates):
        with run_gate(GATE, ros_env) as process:
            world.meet()
            assert world.speeds(world.heard[0][1]) == (0.0, 0.0, 0.0)
            world.release()
            process.kill()
            process.wait(LIMIT)
            process.returncode = 0  # as expected
        world.heard.clear()


def test_both_languages_report_the_same_statuses(
    gates: tuple[RunGate, RunGate], ros_env: dict[str, str], world: World
) -> None:
    """Name, level, message and refusals of every status are the same."""
    seen: list[list[dict[str, str]]] = []
    for run_gate in gates:
        statuses: list[dict[str, str]] = []
        with run_gate(GATE, ros_env) as process:
            world.meet()
            for happens in (
                world.release,
                lambda: world.mode(1),
                lambda: world.stop(True),
                lambda: world.wish(float("nan")),
                lambda: world.wish_bytes(b"\x00\x01\x00\x00"),
            ):
                happens()
                settled = world.reports
                # A status follows a change within 50 ms, so the second one from here on includes
                # it.
                world.wish_until(0.3, lambda settled=settled: world.reports >= settled + 2)
                status = dict(world.status)
                del status["since"], status["since_ns"]
                statuses.append(status)
            process.send_signal(signal.SIGTERM)
            output, _ = process.communicate(timeout=LIMIT)
        assert process.returncode == 0, output
        seen.append(statuses)
        world.heard.clear()
        world.stop(False)
    assert seen[0] == seen[1]


def test_garbage_collection_parameter_has_no_effect(
    gates: tuple[RunGate, RunGate], ros_env: dict[str, str], world: World
) -> None:
    """Parameter files of the Python gate also work for the C++ gate."""
    with gates[1](GATE, ros_env, "garbage_collection:=false"):
        world.meet()
        world.release()
        world.wish_until(0.3, lambda: world.status.get("level") == "0")


@needs("ros2")
def test_gate_runs_as_a_component(ros_env: dict[str, str], world: World) -> None:
    """In a container with intra-process communication, commands pass and a stop is zero too."""
    env = overlay(gate_cpp_nodes.installed_gates(), ros_env)
    package = gate_cpp_nodes.PACKAGE
    with running_container(env, world.peer) as container:
        container.load(package, f"{package}::CmdVelGate", "-e", "use_intra_process_comms:=true")
        world.meet()
        world.release()
        before = len(world.heard)
        data = world.wish(0.2, y=-0.0)
        world.hear_after(before)
        assert world.heard[before][1] == data
        world.stop(True)
        world.peer.until(lambda: world.last == (0.0, 0.0, 0.0))
