"""A running gate whose limits come in messages, and as parameters."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import closing
from typing import Any

import pytest

from tests.support.gate_nodes import STILL, World
from tests.support.gate_runners import RunGate
from tests.support.profiles import slow
from tests.support.rig import PROMPT
from tests.support.ros import Peer
from tests.support.victims import Sensors

pytestmark = pytest.mark.ros

TRACTOR = "tractor_command_gate"
LIMITS = "/tractor/limits"
TIMEOUT = 0.4
"""How long the last limit counts, in s; see the rules."""


@pytest.fixture
def tractor(ros_peer: Peer) -> World:
    """Return what is around the gate of the tractor, but for what publishes its limits."""
    return World(ros_peer, "/tractor/goal", "/tractor/command")


@pytest.fixture
def limiter(ros_env: dict[str, str]) -> Iterator[Sensors]:
    """Run the process that publishes the limits."""
    with closing(Sensors({LIMITS: "std_msgs/msg/Float32MultiArray"}, ros_env)) as process:
        yield process


def limit(*numbers: float) -> Any:
    """Return a message with limits, of which the second one is the greatest speed forward."""
    from std_msgs.msg import Float32MultiArray

    return Float32MultiArray(data=[0.0, *numbers])


def drive(world: World, limiter: Sensors, greatest: float) -> None:
    """Command a speed until it passes within the greatest one."""
    world.meet()
    limiter.match(LIMITS)
    world.stop(False)
    world.mode(0)
    limiter.play(LIMITS, limit(greatest), rate=50.0)
    world.wish_until(3.0, lambda: world.last == (greatest, 0.0, 0.25), turn=0.25)


@pytest.mark.parametrize("fault", [Sensors.kill, slow(Sensors.freeze)])
def test_limit_that_fails_is_zero_in_its_time(
    run_gate: RunGate,
    ros_env: dict[str, str],
    tractor: World,
    limiter: Sensors,
    fault: Callable[[Sensors], None],
) -> None:
    """The controller goes on commanding; within the timeout, the drive gets zero forward."""
    with run_gate(TRACTOR, ros_env):
        drive(tractor, limiter, 1.0)
        broken = time.time()
        fault(limiter)
        tractor.wish_until(3.0, lambda: tractor.last == (0.0, 0.0, 0.25), turn=0.25)
        first = next(
            sent for sent, data in tractor.heard if sent > broken and not _x(tractor, data)
        )
        assert first < broken + TIMEOUT + PROMPT
        tractor.peer.until(lambda: "input greatest is unknown" in tractor.status["message"])
        since = len(tractor.heard)
        tractor.wish_until(3.0, lambda: len(tractor.heard) > since + 20, turn=0.25)
        later = {tractor.speeds(data) for sent, data in tractor.heard if sent > first}
        assert later == {(0.0, 0.0, 0.25)}


def _x(world: World, data: bytes) -> float:
    return world.speeds(data)[0]


@pytest.mark.parametrize("message", [(float("nan"),), ()], ids=["nan", "too short"])
def test_limit_that_holds_no_number_is_zero(
    run_gate: RunGate,
    ros_env: dict[str, str],
    tractor: World,
    limiter: Sensors,
    message: tuple[float, ...],
) -> None:
    """At once, for the command in effect: the controller has no need to command again."""
    with run_gate(TRACTOR, ros_env):
        drive(tractor, limiter, 1.0)
        limiter.play(LIMITS, limit(*message), rate=50.0)
        tractor.peer.until(lambda: tractor.last == (0.0, 0.0, 0.25))


def test_held_command_is_limited_as_well(
    run_gate: RunGate, ros_env: dict[str, str], tractor: World, limiter: Sensors
) -> None:
    """A command that is held keeps to a limit that becomes narrower, and stays there."""
    with run_gate(TRACTOR, ros_env):
        drive(tractor, limiter, 1.0)
        tractor.mode(1)
        tractor.peer.until(lambda: "slow: hold" in tractor.status.get("message", ""))
        limiter.play(LIMITS, limit(0.5), rate=50.0)
        tractor.wish_until(2.0, lambda: tractor.last == (0.5, 0.0, 0.25))
        limiter.play(LIMITS, limit(2.0), rate=50.0)
        since = len(tractor.heard)
        tractor.wish_until(2.0, lambda: len(tractor.heard) > since + 10)
        heard = {tractor.speeds(data) for _, data in tractor.heard[since:]}
    # A machine that holds the limiter up for its whole timeout makes the limit zero.
    assert heard <= {(0.5, 0.0, 0.25), (0.0, 0.0, 0.25)}


def test_field_that_falls_goes_on_from_its_limit(
    run_gate: RunGate, ros_env: dict[str, str], tractor: World, limiter: Sensors
) -> None:
    """It gets no faster when the limit becomes wider again before it has got to zero."""
    with run_gate(TRACTOR, ros_env):
        drive(tractor, limiter, 1.0)
        before = len(tractor.heard)
        tractor.stop(True)
        tractor.wish_until(2.0, lambda: 0.0 < tractor.last[0] < 1.0)
        limiter.play(LIMITS, limit(0.25), rate=50.0)
        tractor.wish_until(2.0, lambda: tractor.last[0] <= 0.25)
        limiter.play(LIMITS, limit(2.0), rate=50.0)
        tractor.wish_until(2.0, lambda: tractor.last == STILL)
        falling = [_x(tractor, data) for _, data in tractor.heard[before:]]
    assert falling == sorted(falling, reverse=True)
    assert any(0.0 < x < 0.25 for x in falling)


def test_parameter_limits_and_is_checked(
    run_gate: RunGate, ros_env: dict[str, str], tractor: World, limiter: Sensors
) -> None:
    """A tunable constant is a parameter of the gate; outside its interval, the gate ends."""
    with run_gate(TRACTOR, ros_env, "turning:=0.125"):
        tractor.meet()
        limiter.match(LIMITS)
        tractor.stop(False)
        tractor.mode(0)
        limiter.play(LIMITS, limit(1.0), rate=50.0)
        tractor.wish_until(0.5, lambda: tractor.last == (0.5, 0.0, 0.125), turn=3.0)
    with run_gate(TRACTOR, ros_env, "turning:=1.5") as process:
        assert process.wait(30) != 0
