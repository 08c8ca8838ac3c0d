"""How the robot is brought to drive, and the levers of the world that break its rules."""

from __future__ import annotations

import contextlib
import math
import time
from collections.abc import Callable, Mapping

from tests.support.chaos.bench import Bench, NotReadyError
from tests.support.chaos.links import (
    CONTROLLER_OK,
    GATE,
    HEARTBEAT,
    MOTOR_STOP,
    PEDAL,
    PLANT,
    SAFETY,
    STOP,
)

DRIVING = 0.2
"""The pedal from which the robot counts as driving."""

STEERED = 0.2
"""What the joystick commands, in m/s."""


def prepare(bench: Bench, attempts: int = 3) -> None:
    """Undo what was before, as an operator does, and let the robot drive; try again if it stops.

    Raises:
        NotReadyError: if it does not drive.
    """
    for _ in range(attempts - 1):
        with contextlib.suppress(NotReadyError):
            return _prepare(bench)
    return _prepare(bench)


def _prepare(bench: Bench) -> None:
    for undo in LEVERS.values():
        undo(bench, False)
    bench.pull("/panel/ignition", "std_msgs/Bool", False)
    bench.pull("/mission/order", "std_msgs/Bool", False)
    for node in ("safety", "gate"):
        bench.process_of(node)
    since = time.monotonic()
    bench.until(
        "the safety node's heartbeat",
        lambda: bench.fresh("arrived", GATE, HEARTBEAT.name, since),
    )
    _take_over(bench)
    _reset_gate(bench)
    bench.pull("/panel/ignition", "std_msgs/Bool", True)
    bench.until("the engine", lambda: bench.value("sent", PLANT, "/plc/engine_running") is True)
    bench.pull("/panel/ignition", "std_msgs/Bool", False)
    bench.pull("/mission/order", "std_msgs/Bool", True)
    bench.pull("/panel/mode", "std_msgs/UInt8", 2)

    def drives() -> bool:
        pedal = bench.value("sent", PLANT, PEDAL.name)
        return pedal is not None and pedal > DRIVING

    bench.until("the robot to drive", drives, 8.0)


def _take_over(bench: Bench) -> None:
    """Turn the switch to manual, and reset what is latched; again, if it is refused."""
    end = time.monotonic() + 40.0
    while time.monotonic() < end:
        for mode in (1, 0):  # a mode that does not change is not an event
            _switch_to(bench, mode)
        if bench.value("sent", SAFETY, MOTOR_STOP.name) is not False and not bench.reset():
            continue
        if bench.record.until(lambda: _is_free(bench), 1.0):
            return
    raise NotReadyError("the safety node did not let its actions be reset")


def _reset_gate(bench: Bench) -> None:
    """Reset the gate, which holds the robot since its start, or since a loss of the heartbeat."""
    end = time.monotonic() + 40.0
    while not bench.reset(GATE):
        if time.monotonic() > end:
            raise NotReadyError("the gate did not let itself be reset")
        time.sleep(0.2)  # the answer asks to try again, and no event says when


def _switch_to(bench: Bench, mode: int) -> None:
    """Turn the switch, and wait until the safety node has a report of the PLC that says so."""
    bench.pull("/panel/mode", "std_msgs/UInt8", mode)
    bench.until(f"mode {mode}", lambda: bench.value("arrived", SAFETY, "/plc/mode") == mode)
    since = time.monotonic()
    bench.until("the PLC", lambda: bench.fresh("arrived", SAFETY, "/plc/keep_alive", since))


def _is_free(bench: Bench) -> bool:
    off = [bench.value("sent", SAFETY, topic.name) is False for topic in (STOP, MOTOR_STOP)]
    known = bench.value("arrived", PLANT, CONTROLLER_OK.name) is True
    return all(off) and known


# The levers of the world --------------------------------------------------------------------------

Lever = Callable[[Bench, bool], None]


def _obstacle(distance: float) -> Lever:
    return lambda bench, on: bench.pull(
        "/world/obstacle", "std_msgs/Float64", distance if on else math.inf
    )


def _switch(topic: str) -> Lever:
    return lambda bench, on: bench.pull(topic, "std_msgs/Bool", on)


def _pedal(position: float) -> Lever:
    return lambda bench, on: bench.pull(
        "/world/pedal_override", "std_msgs/Float64", position if on else math.nan
    )


LEVERS: Mapping[str, Lever] = {
    "obstacle in the stop zone": _obstacle(1.9),
    "obstacle in the collision zone": _obstacle(0.6),
    "front bumper": _switch("/contact/front_bumper"),
    "stop button": _switch("/panel/stop_button"),
    "rollover": lambda bench, on: bench.pull(
        "/world/slope", "geometry_msgs/Vector3", math.radians(15.0) if on else 0.0
    ),
    "joystick": lambda bench, on: bench.steer(STEERED if on else None),
    "far too fast": _pedal(1.0),
    "too fast": _pedal(0.5),
}
