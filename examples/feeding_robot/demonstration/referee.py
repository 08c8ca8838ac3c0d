"""Judges a test case from what the robot's topics show. Nothing here knows ROS.

The referee is an observer of its own: it reads the sensors' messages, not the safety node's mind,
and tells when the case's condition was fulfilled and what the robot did about it.
"""

from __future__ import annotations

import enum
import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

STANDING = 0.02
"""Speed, in m/s, below which the robot counts as halted."""

CRAWL = 0.25
"""Speed, in m/s, that the robot keeps below under ``low_speed``."""

CYCLE = 0.03
"""A cycle of the sensors in s, and a little more: the player may see a message less than others."""

LATEST = 0.5
"""Reaction time, in s, beyond which a reaction does not count: another rule may have brought it."""


@dataclass(frozen=True)
class RobotState:
    """The last value of everything that is watched; before the first message, ``None``."""

    speed: float | None = None
    roll: float | None = None
    pitch: float | None = None
    nearest: float | None = None
    mode: int | None = None
    stop_button: bool | None = None
    front_bumper: bool | None = None
    rear_bumper: bool | None = None
    feeding_arm: bool | None = None
    engine_running: bool | None = None
    engine_enabled: bool | None = None
    low_speed: bool | None = None
    stop: bool | None = None
    motor_stop: bool | None = None
    controller_ok: bool | None = None
    heartbeat: int | None = None
    plc_keep_alive: int | None = None
    controller_keep_alive: int | None = None

    @property
    def halted(self) -> bool:
        """Whether the odometry shows a robot that does not move."""
        return self.speed is not None and abs(self.speed) < STANDING


@dataclass(frozen=True)
class Event:
    """One message: which value of :class:`RobotState` it sets, and when it was sent and received.

    Times are nanoseconds of one clock: the real one, or the simulated one where the case is played
    on that.
    """

    name: str
    value: Any
    sent: int
    received: int


class Reaction(enum.Enum):
    """What the robot can do about a violation, in the words of the report."""

    LOW_SPEED = "low speed"
    STOP = "stop"
    ENGINE_OFF = "engine off"


NOTHING: frozenset[Reaction] = frozenset()
Condition = Callable[[RobotState], bool]


def describe(reactions: frozenset[Reaction]) -> str:
    """Return reactions as a reader expects them: ``stop + engine off``, or ``none``."""
    return " + ".join(each.value for each in Reaction if each in reactions) or "none"


@dataclass
class Referee:
    """Watches one case from its provocation to its end.

    Attributes:
        condition: what the case provokes, as the sensors show it.
        hold: for how long, in s, the condition must last before a reaction is due.
        expected: the reactions that must come, and the only ones that may.
        acts: the names of the messages that carry the expected reaction.
        resolution: how exactly, in s, the player can tell when the condition began.
        silence_of: where the condition is a silence, the messages that are silent: it begins with
            the last of them.
        fulfilled: when the message that fulfilled the condition was sent, ``None`` while it does
            not hold.
        provoked: whether the condition has ever held.
        acted: when each of the ``acts`` was received.
    """

    condition: Condition
    hold: float
    expected: frozenset[Reaction]
    acts: frozenset[str]
    state: RobotState = field(default_factory=RobotState)
    silence_of: str | None = None
    resolution: float = CYCLE
    fulfilled: int | None = None
    provoked: bool = False
    observed: set[Reaction] = field(default_factory=set)
    acted: dict[str, int] = field(default_factory=dict)

    def feed(self, event: Event) -> None:
        """Take the next message."""
        before = self.state
        self.state = replace(before, **{event.name: event.value})
        if _shows_reaction(event.name, event.value) and not _shows_reaction(
            event.name, getattr(before, event.name)
        ):
            self._note(event)
        if Reaction.ENGINE_OFF in self.observed and self.state.halted:
            self.observed.add(Reaction.STOP)  # nobody may be left to say so
        # After the reaction the condition may end: that is what the reaction is for. Yet its
        # message may have overtaken that of the condition, which comes from another node.
        if not self.acted or (self.fulfilled is None and event.sent < min(self.acted.values())):
            self._follow(event)

    def _note(self, event: Event) -> None:
        if event.name in _SIGNS:
            self.observed.add(_SIGNS[event.name])
        if event.name in self.acts:
            self.acted.setdefault(event.name, event.received)

    def _follow(self, event: Event) -> None:
        if self.silence_of is not None:
            if event.name == self.silence_of:
                self.fulfilled = event.sent
        elif not self.condition(self.state):
            # Once it has lasted long enough the reaction is due, whatever happens then.
            if not self.held(event.sent, self.hold):
                self.fulfilled = None
        elif self.fulfilled is None:
            self.fulfilled = event.sent
            self.provoked = True

    def held(self, now: int, seconds: float) -> bool:
        """Whether at ``now`` the condition has lasted ``seconds``."""
        return self.fulfilled is not None and now - self.fulfilled >= seconds * 1e9

    @property
    def reaction_time(self) -> float | None:
        """Seconds from the instant a reaction was due until its last message was received."""
        if self.fulfilled is None or not self.acts or set(self.acted) != self.acts:
            return None
        return (max(self.acted.values()) - self.fulfilled) / 1e9 - self.hold

    @property
    def complete(self) -> bool:
        """Whether everything expected has been seen, the robot's slowing down included."""
        if self.reaction_time is None or not self.expected <= self.observed:
            return False
        if Reaction.STOP in self.expected:
            return self.state.halted
        return self.state.speed is not None and abs(self.state.speed) < CRAWL

    @property
    def verdict(self) -> str:
        """Why the case fails, or nothing when it is passed."""
        if self.observed != self.expected:
            return (
                f"expected {describe(self.expected)}, observed {describe(frozenset(self.observed))}"
            )
        if not self.acts and not self.provoked:
            return "what must bring no reaction has not come about"
        time = self.reaction_time
        if self.acts and time is None:
            return "the reaction came without its cause"
        if time is not None and time < -self.resolution:
            return f"the reaction came {-time:.3f} s too early"
        if time is not None and time > LATEST:
            return f"the reaction took {time:.3f} s"
        return ""


_SIGNS = {
    "low_speed": Reaction.LOW_SPEED,
    "stop": Reaction.STOP,
    "engine_running": Reaction.ENGINE_OFF,
}


def _shows_reaction(name: str, value: Any) -> bool:
    """Whether a message with this value shows a reaction; an engine reacts by going off."""
    if name in {"engine_running", "engine_enabled"}:
        return value is False
    return value is True


def nearest_ahead(ranges: list[float], angle_min: float, increment: float, view: float) -> float:
    """Return the shortest range (m) within ``view`` rad to either side; infinity if all is free."""
    return min(
        (
            r
            for i, r in enumerate(ranges)
            if abs(angle_min + i * increment) <= view and not math.isnan(r)
        ),
        default=math.inf,
    )
