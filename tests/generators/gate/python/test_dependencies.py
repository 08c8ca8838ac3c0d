"""Dependencies of a gate in each language: whichever fails, no command passes unmonitored."""

from __future__ import annotations

import itertools
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from subprocess import Popen
from typing import Any

import pytest

from tests.support.gate_nodes import GATE, SAFETY_NODE, STILL, Stranger, World
from tests.support.gate_runners import RunGate
from tests.support.processes import freeze, thaw
from tests.support.ros import LIMIT, Peer, set_parameter

pytestmark = pytest.mark.ros

# States and heartbeat ---------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.usefixtures("gate")
def test_undecodable_state_stops(world: World) -> None:
    """Invalid bytes count as active until a valid state of the safety node arrives."""
    world.beating.callback = world.beat  # so that no state is repeated
    before = len(world.heard)
    world.stop_publisher.publish(b"\x00\x01\x00\x00")
    world.wish_until(0.3, lambda: world.last == STILL)
    world.assert_stands(0.5)
    assert len(world.heard) > before
    world.beating.callback = world.live
    world.until_driving()


def commands_without_states(world: World) -> set[tuple[float, float, float]]:
    """Return the commands at the drive during a second with heartbeats but without states.

    If the machine delays the heartbeats for so long that they are lost, another second is used.
    """
    beats: list[float] = []

    def beat() -> None:
        beats.append(time.monotonic())
        world.beat()

    for _ in range(10):
        world.beating.callback = world.live
        world.until_driving()
        beats.clear()
        world.beating.callback = beat
        commands = set(world.wish_for(1.0))
        if max(after - before for before, after in itertools.pairwise(beats)) < 0.2:
            break
    return commands


@pytest.mark.slow
def test_state_counts_from_its_arrival(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """Late states count on arrival; one that is not repeated remains valid with the heartbeat."""
    with run_gate(GATE, ros_env):
        world.meet()
        world.assert_stands(1.0)  # the heartbeat alone opens nothing
        world.stop(False)
        world.mode(0)
        commands = commands_without_states(world)
        assert commands == {(0.3, 0.0, 0.0)}
        world.stop(True)
        world.wish_until(0.3, lambda: world.last == STILL)
        world.assert_stands(1.0)


@pytest.mark.slow
@pytest.mark.usefixtures("gate")
def test_node_that_replaces_the_safety_node_is_obeyed(
    world: World, ros_env: dict[str, str]
) -> None:
    """A sole publisher of heartbeat and states is the safety node: names are public."""
    from std_msgs.msg import UInt8

    world.peer.node.destroy_timer(world.beating)
    for publisher in (world.stop_publisher, world.mode_publisher, world.heartbeat):
        world.peer.node.destroy_publisher(publisher)
    world.wish_until(0.3, lambda: world.last == STILL)
    with Stranger(ros_env) as stranger:
        beats = 0

        def live() -> bool:
            nonlocal beats
            beats += 1
            stranger.heartbeat(beats)
            stranger.stop(False)
            stranger.state("/mode", UInt8(data=0))
            return world.last == (0.3, 0.0, 0.0)

        world.wish_until(0.3, live)


@pytest.mark.slow
@pytest.mark.usefixtures("gate")
def test_restarted_safety_node_may_publish_states_first(
    world: World, ros_env: dict[str, str]
) -> None:
    """During its grace period the states come long before the first heartbeat."""
    from std_msgs.msg import UInt8

    world.peer.node.destroy_timer(world.beating)
    for publisher in (world.stop_publisher, world.mode_publisher, world.heartbeat):
        world.peer.node.destroy_publisher(publisher)
    reports = world.reports
    world.wish_until(0.3, lambda: world.reports >= reports + 3)  # it has checked the publishers
    assert world.last == STILL
    with Stranger(ros_env, "test_peer") as again:
        beats = 0
        grace = time.monotonic() + 0.5

        def say() -> None:
            again.stop(False)
            again.state("/mode", UInt8(data=0))

        def starting() -> bool:
            say()
            return time.monotonic() > grace

        def beating() -> bool:
            nonlocal beats
            beats += 1
            say()
            again.heartbeat(beats)
            return world.last == (0.3, 0.0, 0.0)

        world.wish_until(0.3, starting)
        assert world.last == STILL
        world.wish_until(0.3, beating)


# The drive and its gate -------------------------------------------------------------------------


@pytest.mark.usefixtures("gate")
def test_missing_and_late_drive_does_not_block_the_gate(world: World) -> None:
    """The gate runs without a subscriber; a new one gets the commands from then on."""
    world.peer.node.destroy_subscription(world.drive)
    heard, reports = len(world.heard), world.reports
    wishing = time.monotonic() + 0.5

    def wished() -> bool:
        world.wish(0.3)
        return time.monotonic() > wishing and world.reports > reports

    world.peer.until(wished)
    assert len(world.heard) == heard
    world.listen()
    world.wish_until(0.3, lambda: len(world.heard) > heard)
    assert {world.speeds(data) for _, data in world.heard[heard:]} == {(0.3, 0.0, 0.0)}
    world.stop(True)
    world.peer.until(lambda: world.last == STILL)


def test_hung_gate_is_silent_and_continues_with_zero(gate: Popen[str], world: World) -> None:
    """A stopped process does not notice time passing; the loss during the hang counts."""
    freeze(gate.pid)
    world.silence(0.1)  # messages still in transit
    assert world.silence(1.0) == 0
    before = len(world.heard)
    thaw(gate.pid)
    world.hear_after(before)
    assert world.speeds(world.heard[before][1]) == STILL
    world.until_driving()


# Clocks -----------------------------------------------------------------------------------------


@contextmanager
def simulated_time(peer: Peer, seconds: int) -> Iterator[Any]:
    """Publish a /clock that is paused at a time; return its publisher."""
    from rosgraph_msgs.msg import Clock  # type: ignore[import-untyped]

    message = Clock()
    message.clock.sec = seconds
    clock = peer.node.create_publisher(Clock, "/clock", 10)
    timer = peer.node.create_timer(0.02, lambda: clock.publish(message))
    yield clock
    peer.node.destroy_timer(timer)


def test_wrong_clock_stamps_zeros_but_hides_no_loss(
    run_gate: RunGate, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """Zeros have the time of /clock; a lost heartbeat is detected all the same."""
    from trajectory_msgs.msg import JointTrajectory  # type: ignore[import-untyped]

    heard: list[Any] = []
    ros_peer.node.create_subscription(JointTrajectory, "/arm/command", heard.append, 10)
    wish = ros_peer.node.create_publisher(JointTrajectory, "/arm/goal", 10)
    message = JointTrajectory()
    message.header.stamp.sec = 5
    with simulated_time(ros_peer, 4_000), run_gate("arm_command_gate", ros_env, ON_CLOCK):
        ros_peer.until(wish.get_subscription_count)

        def stamped() -> bool:
            wish.publish(message)
            return bool(heard) and heard[-1].header.stamp.sec == 4_000

        ros_peer.until(stamped)
        zeros = len(heard)
        ros_peer.until(lambda: len(heard) > zeros + 5)
    assert {each.header.stamp.sec for each in heard[zeros:]} == {4_000}


ON_CLOCK = "use_sim_time:=true"


def test_gate_without_a_clock_says_that_it_waits_for_it(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """The diagnostics name /clock until its first message, which need not come at all."""
    waits = "waits for /clock"
    with run_gate(GATE, ros_env, ON_CLOCK):
        world.peer.until(lambda: waits in world.status.get("message", ""))
        with simulated_time(world.peer, 1_000):
            world.peer.until(lambda: waits not in world.status["message"])


@pytest.mark.slow
def test_second_clock_is_a_fault(run_gate: RunGate, ros_env: dict[str, str], world: World) -> None:
    """Both are used, which affects only the stamps of zeros; the other publisher is named."""
    with simulated_time(world.peer, 1_000) as clock, run_gate(GATE, ros_env, ON_CLOCK):
        world.meet()
        world.peer.until(clock.get_subscription_count)
        world.release()
        with Stranger(ros_env) as stranger:
            from rosgraph_msgs.msg import Clock

            stranger.say("/clock", Clock())
            world.until_fault("2 publishers where one is expected: /stranger, /test_peer")
        world.wish_until(0.3, lambda: "stranger" not in world.status["message"])


# Parameters -------------------------------------------------------------------------------------

DEFAULTS = {
    "use_sim_time": False,
    "losses_in_simulated_time": False,
    "realtime_priority": 0,
    "lock_memory": False,
    "garbage_collection": True,
}
OTHERS = {
    "use_sim_time": True,
    "losses_in_simulated_time": True,
    "realtime_priority": 1,
    "lock_memory": True,
    "garbage_collection": False,
}


def parameters(peer: Peer) -> dict[str, Any]:
    """Return the values of the gate's parameters."""
    from rcl_interfaces.srv import GetParameters
    from rclpy.parameter import parameter_value_to_python

    client = peer.node.create_client(GetParameters, f"/{GATE}/get_parameters")
    values = peer.call(client, GetParameters.Request(names=list(DEFAULTS))).values
    return dict(zip(DEFAULTS, map(parameter_value_to_python, values), strict=True))


@pytest.mark.usefixtures("gate")
def test_parameters_of_a_running_gate_cannot_be_changed(
    world: World, ros_env: dict[str, str]
) -> None:
    """The gate keeps its initial values or the defaults; later requests are rejected."""
    stranger = Peer(int(ros_env["ROS_DOMAIN_ID"]), "stranger")
    assert parameters(stranger) == DEFAULTS
    for name, value in OTHERS.items():
        (result,) = set_parameter(stranger, GATE, **{name: value})
        assert not result.successful, name
        assert result.reason
    assert parameters(stranger) == DEFAULTS
    stranger.close()
    world.until_driving()


@pytest.mark.parametrize("wrong", ["realtime_priority:=100", "lock_memory:=perhaps"])
def test_invalid_parameter_prevents_the_start(
    run_gate: RunGate, ros_env: dict[str, str], world: World, wrong: str
) -> None:
    """The gate exits with 1 and names it, and no command has passed."""
    with run_gate(GATE, ros_env, wrong) as process:
        output, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == 1
    assert wrong.partition(":")[0] in output
    assert "terminate called" not in output
    assert world.heard == []


def test_last_value_of_a_parameter_counts(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """As for every ROS 2 node; neither two gates nor a mixture result."""
    twice = ("garbage_collection:=true", "garbage_collection:=false")
    with run_gate(GATE, ros_env, *twice):
        world.meet()
        assert parameters(world.peer) == {**DEFAULTS, "garbage_collection": False}


# The lock ---------------------------------------------------------------------------------------


def locks(env: dict[str, str]) -> Path:
    """Return the lock folder below a temporary folder of the test."""
    return Path(env["TMPDIR"]) / f"deros-{os.getuid()}"


def test_shared_lock_folder_is_not_used(
    run_gate: RunGate, ros_env: dict[str, str], world: World, tmp_path: Path
) -> None:
    """Others could hold any lock in it: the gate reports a fault and runs without a lock."""
    env = {**ros_env, "TMPDIR": str(tmp_path)}
    locks(env).mkdir()
    locks(env).chmod(0o777)
    with run_gate(GATE, env):
        world.meet()
        world.release()
        world.until_fault("others may write in")
    assert list(locks(env).iterdir()) == []


@pytest.mark.slow
def test_second_gate_is_found_after_the_lock_was_deleted(
    run_gate: RunGate, ros_env: dict[str, str], world: World, tmp_path: Path
) -> None:
    """The second gets the free lock, finds the first in the graph, and exits."""
    env = {**ros_env, "TMPDIR": str(tmp_path)}
    with run_gate(GATE, env):
        world.meet()
        world.release()
        (lock,) = locks(env).iterdir()
        lock.unlink()
        with run_gate(GATE, env) as second:
            world.wish_until(0.3, lambda: second.poll() is not None)
            output, _ = second.communicate(timeout=LIMIT)
        assert second.returncode == 1
        assert "this one started last" in output
        world.until_driving()


# Readers ----------------------------------------------------------------------------------------


@pytest.mark.usefixtures("gate")
def test_readers_of_the_reports_have_no_influence(world: World, ros_env: dict[str, str]) -> None:
    """None is required, any number may join, and their messages have no effect."""
    from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

    subscriptions = world.peer.node.get_subscriptions_info_by_topic("/diagnostics")
    assert GATE not in [each.node_name for each in subscriptions]
    strangers = [Stranger(ros_env, f"reader_{number}") for number in range(3)]
    heard: list[str] = []
    for stranger in strangers:
        stranger.node.create_subscription(DiagnosticArray, "/diagnostics", heard.append, 10)
        stranger.say(
            "/diagnostics", DiagnosticArray(status=[DiagnosticStatus(name=f"/{SAFETY_NODE}")])
        )
    reports = world.reports
    world.wish_until(0.3, lambda: world.reports > reports + 1)
    assert "reader" not in world.status["message"]
    world.until_driving()
    for stranger in strangers:
        stranger.__exit__()
