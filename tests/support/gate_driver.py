"""A reference gate of velocity commands, driven in milliseconds, for tests."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from deros.rules.gates.gate_engine import GateEngine, Output
from deros.rules.program.commands import Message
from tests.support.rules import embedded_store, program

MS = 1_000_000
ACTIONS = """
action stop publishes true on /stop : std_msgs.Bool latched;
action low_speed publishes true on /low_speed : std_msgs.Bool latched;
"""
STOP = "stop: zero;"
LOW = "low_speed: limit linear.x to [-0.1, 0.1] m/s, angular.z to [-0.2, 0.2] rad/s;"
HEARTBEAT = "lost heartbeat for 0.3 sec: zero;"
INPUT = "lost input for 0.5 sec: zero;"

Shown = list[tuple[float, str, float]]


class Driver:
    """A gate of velocity commands, with times in milliseconds."""

    def __init__(
        self,
        *lines: str,
        kind: str = "geometry_msgs.Twist",
        declared: str = "",
        constants: Mapping[str, float] | None = None,
    ) -> None:
        """Start at 0 a gate of these lines, with what else is declared."""
        gate = f"gate /nav -> /cmd_vel : {kind} rate 20 Hz {{ {' '.join(lines)} }}"
        built = program(f"{ACTIONS}{declared}{gate}")
        store = embedded_store()
        self.engine = GateEngine(built.gates[0], built.actions, store, constants=constants)
        self.beats = 0

    @property
    def reported(self) -> list[str]:
        """The reports that hold."""
        table = self.engine.table
        return [t for t, holds in zip(table.reports, self.engine.applying, strict=True) if holds]

    def drive(self, t_ms: float, speed: float, turn: float = 0.0) -> Shown:
        """Command a speed."""
        return shown(self.engine.command(at(t_ms), twist(speed, turn)))

    def stand(self, t_ms: float) -> Shown:
        """Command zero, in all numbers."""
        return shown(self.engine.command(at(t_ms), zero_twist()))

    def reset(self, t_ms: float) -> tuple[int, ...]:
        """Reset the gate; return the indices of the lines that stand against it."""
        return self.engine.reset(at(t_ms))

    def state(self, t_ms: float, action: str, active: bool, *, is_trusted: bool = True) -> Shown:
        """Say what an action is."""
        message = {"data": active}
        return shown(self.engine.state(at(t_ms), f"/{action}", message, is_trusted=is_trusted))

    def beat(self, t_ms: float, counter: int | None = None) -> Shown:
        """Publish a heartbeat, with the next counter unless another one is given."""
        self.beats = self.beats + 1 if counter is None else counter
        return shown(self.engine.heartbeat(at(t_ms), self.beats))

    def lose(self, t_ms: float) -> Shown:
        """Have no node, or more than one, that can be the safety node."""
        return shown(self.engine.no_safety_node(at(t_ms)))

    def wait(self, t_ms: float) -> Shown:
        """Let time pass, deadline by deadline, as an idle node does."""
        found: list[Output] = []
        while (due_ns := self.engine.next_deadline) is not None and due_ns <= at(t_ms):
            found += self.engine.advance(due_ns)
        return shown([*found, *self.engine.advance(at(t_ms))])

    def open(self) -> Driver:
        """Let everything be known and well at 0."""
        self.beat(0)
        self.beat(0)
        self.state(0, "stop", False)
        self.state(0, "low_speed", False)
        self.drive(0, 0.0)
        return self


def at(t_ms: float) -> int:
    """Return milliseconds as nanoseconds."""
    return round(t_ms * MS)


def twist(speed: Any, turn: float = 0.0) -> Message:
    """Return a command; its other numbers are such that a limit would show."""
    return {
        "linear": {"x": speed, "y": 7.0, "z": 0.0},
        "angular": {"x": 0.0, "y": 0.0, "z": turn},
    }


def zero_twist() -> Message:
    """Return the command to stand."""
    return {name: dict.fromkeys("xyz", 0.0) for name in ("linear", "angular")}


def shown(outputs: list[Output]) -> Shown:
    """Return when, what and how fast."""
    return [(each.t_ns / MS, each.kind, each.message["linear"]["x"]) for each in outputs]
