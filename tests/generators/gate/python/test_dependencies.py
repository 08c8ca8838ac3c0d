"""What a gate depends on, in each language: whatever of it fails, nothing passes unwatched."""

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

PROMPT = 1.0
"""What a busy machine may add, in s."""

# States and heartbeat ---------------------------------------------------------------------------


@pytest.mark.usefixtures("gate")
def test_a_state_that_cannot_be_read_stops(world: World) -> None:
    """Bytes that are no state count as active, until the safety node is understood again."""
    world.beating.callback = world.beat  # which repeats no state
    before = len(world.heard)
    world.stop_publisher.publish(b"\x00\x01\x00\x00")
    world.wish_until(0.3, lambda: world.last == STILL)
    world.assert_stands(0.5)
    assert len(world.heard) > before
    world.beating.callback = world.live
    world.until_driving()


def told_without_states(world: World) -> set[tuple[float, float, float]]:
    """Return what the drive is told for a second in which the safety node only beats.

    If the machine holds up the beats for long enough to be a loss, it is another second.
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
        told = set(world.wish_for(1.0))
        if max(after - before for before, after in itertools.pairwise(beats)) < 0.2:
            break
    return told


def test_a_state_counts_from_when_it_comes_and_holds(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """Late states are believed when they come; one that is not repeated holds with the beat."""
    with run_gate(GATE, ros_env):
        world.meet()
        world.assert_stands(1.0)  # the heartbeat alone opens nothing
        world.stop(False)
        world.mode(0)
        told = told_without_states(world)
        assert told == {(0.3, 0.0, 0.0)}
        world.stop(True)
        world.wish_until(0.3, lambda: world.last == STILL)
        world.assert_stands(1.0)


@pytest.mark.usefixtures("gate")
def test_whoever_takes_the_place_of_the_safety_node_is_obeyed(
    world: World, ros_env: dict[str, str]
) -> None:
    """Alone with the heartbeat and the states, a stranger is the safety node: names are public."""
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


@pytest.mark.usefixtures("gate")
def test_a_safety_node_that_starts_again_may_say_its_states_first(
    world: World, ros_env: dict[str, str]
) -> None:
    """As one with a grace does: its first heartbeat comes long after it has said what is active."""
    from std_msgs.msg import UInt8

    world.peer.node.destroy_timer(world.beating)
    for publisher in (world.stop_publisher, world.mode_publisher, world.heartbeat):
        world.peer.node.destroy_publisher(publisher)
    reports = world.reports
    world.wish_until(0.3, lambda: world.reports >= reports + 3)  # it has looked who is there
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
def test_a_drive_that_goes_and_one_that_comes_late_hold_nothing_up(world: World) -> None:
    """The gate runs on without a listener; a new one gets what comes from then on."""
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


def test_a_gate_that_hangs_is_silent_and_begins_with_zero(gate: Popen[str], world: World) -> None:
    """No time passes for a process that is stopped; the loss that it slept through counts."""
    freeze(gate.pid)
    world.silence(0.1)  # what was on its way
    assert world.silence(1.0) == 0
    before = len(world.heard)
    thaw(gate.pid)
    world.hear_after(before)
    assert world.speeds(world.heard[before][1]) == STILL
    world.until_driving()


# Clocks -----------------------------------------------------------------------------------------


@contextmanager
def simulated_time(peer: Peer, seconds: int) -> Iterator[Any]:
    """Publish a /clock that stands at a time; give its publisher."""
    from rosgraph_msgs.msg import Clock  # type: ignore[import-untyped]

    message = Clock()
    message.clock.sec = seconds
    clock = peer.node.create_publisher(Clock, "/clock", 10)
    timer = peer.node.create_timer(0.02, lambda: clock.publish(message))
    yield clock
    peer.node.destroy_timer(timer)


def test_a_wrong_clock_stamps_zeros_and_hides_no_loss(
    run_gate: RunGate, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """Zeros bear whatever time /clock tells; that the heartbeat is lost is known all the same."""
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


def test_a_second_clock_of_a_gate_is_a_fault(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """Both are believed, which concerns the stamps of zeros alone; the strangers are named."""
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
    """Return what the parameters of the gate are."""
    from rcl_interfaces.srv import GetParameters
    from rclpy.parameter import parameter_value_to_python

    client = peer.node.create_client(GetParameters, f"/{GATE}/get_parameters")
    values = peer.call(client, GetParameters.Request(names=list(DEFAULTS))).values
    return dict(zip(DEFAULTS, map(parameter_value_to_python, values), strict=True))


@pytest.mark.usefixtures("gate")
def test_nobody_changes_the_parameters_of_a_gate(world: World, ros_env: dict[str, str]) -> None:
    """It runs with what it was started with, or the defaults; whoever asks later is refused."""
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
def test_a_wrong_parameter_ends_the_start_of_a_gate(
    run_gate: RunGate, ros_env: dict[str, str], world: World, wrong: str
) -> None:
    """It ends with 1 and says which, and nothing has passed."""
    with run_gate(GATE, ros_env, wrong) as process:
        output, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == 1
    assert wrong.partition(":")[0] in output
    assert "terminate called" not in output
    assert world.heard == []


def test_of_two_values_of_a_parameter_the_last_holds(
    run_gate: RunGate, ros_env: dict[str, str], world: World
) -> None:
    """As for every node of ROS 2; two gates or a mixture do not come of it."""
    twice = ("garbage_collection:=true", "garbage_collection:=false")
    with run_gate(GATE, ros_env, *twice):
        world.meet()
        assert parameters(world.peer) == {**DEFAULTS, "garbage_collection": False}


# The lock ---------------------------------------------------------------------------------------


def locks(env: dict[str, str]) -> Path:
    """Return the folder of the locks below a temporary folder of the test's own."""
    return Path(env["TMPDIR"]) / f"deros-{os.getuid()}"


def test_a_folder_of_locks_that_is_not_its_own_is_not_used(
    run_gate: RunGate, ros_env: dict[str, str], world: World, tmp_path: Path
) -> None:
    """One in which others may write could hold any lock: a fault, and the gate runs without."""
    env = {**ros_env, "TMPDIR": str(tmp_path)}
    locks(env).mkdir()
    locks(env).chmod(0o777)
    with run_gate(GATE, env):
        world.meet()
        world.release()
        world.until_fault("others may write in")
    assert list(locks(env).iterdir()) == []


def test_a_second_gate_is_found_when_the_lock_was_deleted(
    run_gate: RunGate, ros_env: dict[str, str], world: World, tmp_path: Path
) -> None:
    """The second takes a lock that is nobody's, finds the first by the graph, and gives way."""
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
def test_whoever_reads_the_reports_of_a_gate_is_not_heard(
    world: World, ros_env: dict[str, str]
) -> None:
    """Nobody has to read them, any number may, and what they say changes nothing."""
    from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

    found = world.peer.node.get_subscriptions_info_by_topic("/diagnostics")
    assert GATE not in [each.node_name for each in found]
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
