"""What the safety PLC decides, cycle by cycle. Times are seconds of one steady clock."""

from __future__ import annotations

from dataclasses import dataclass, field
import enum


class Mode(enum.IntEnum):
    """The positions of the operator's mode switch."""

    MANUAL = 0
    LEARN = 1
    AUTOMATIC = 2


class Contact(enum.Enum):
    """The contacts that are wired to the engine's fuel valve."""

    STOP_BUTTON = 'stop button'
    FRONT_BUMPER = 'front bumper'
    REAR_BUMPER = 'rear bumper'
    FEEDING_ARM = 'feeding arm'


class Light(enum.Enum):
    """The colours of the stack light, as ``(red, green, blue)``."""

    RED = (1.0, 0.0, 0.0)
    AMBER = (1.0, 0.75, 0.0)
    GREEN = (0.0, 1.0, 0.0)


@dataclass
class Watchdog:
    """Tells when a signal has been silent for longer than ``timeout`` seconds."""

    timeout: float
    last: float

    def expired(self, now: float) -> bool:
        """Whether the signal's silence has lasted too long."""
        return now - self.last > self.timeout


@dataclass
class PlcLogic:
    """
    The state of the PLC.

    The engine runs only after an operator has turned the ignition in manual mode with nothing
    against it, and whatever shuts it off keeps it off until that is done again. The keep-alives
    of the main controller and of the safety node count outside manual mode, where nobody but
    software holds the machine.
    """

    controller: Watchdog
    safety_node: Watchdog
    mode: Mode = Mode.MANUAL
    pressed: set[Contact] = field(default_factory=set)
    motor_stop: bool = False
    stopped: bool = False
    slow: bool = False
    key_turned: bool = False
    engine_enabled: bool = False

    def supervise(self, now: float) -> list[str]:
        """Run one cycle; return why it shut the engine off, nothing when it did not."""
        reasons = self._reasons(now)
        was_enabled = self.engine_enabled
        if reasons:
            self.engine_enabled = False
        elif self.key_turned and self.mode is Mode.MANUAL:
            self.engine_enabled = True
        return reasons if was_enabled else []

    def _reasons(self, now: float) -> list[str]:
        reasons = [each.value for each in Contact if each in self.pressed]
        if self.motor_stop:
            reasons.append('motor stop of the safety node')
        if self.mode is not Mode.MANUAL:
            if self.controller.expired(now):
                reasons.append('no keep-alive of the main controller')
            if self.safety_node.expired(now):
                reasons.append('no heartbeat of the safety node')
        return reasons

    @property
    def light(self) -> Light:
        """Tell people around, by a colour, what the robot is about to do."""
        if not self.engine_enabled or self.stopped:
            return Light.RED
        if self.slow or self.mode is not Mode.AUTOMATIC:
            return Light.AMBER
        return Light.GREEN
