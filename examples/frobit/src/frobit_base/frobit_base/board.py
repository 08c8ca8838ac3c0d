"""The board between computer and wheels: motors, encoders, battery, and what can fail in them."""

from __future__ import annotations

from dataclasses import dataclass, field
import math

TOP_SPEED = 12.0
"""Speed, in rad/s, of a wheel at full thrust and nominal voltage."""

LAG = 0.12
"""Time constant, in s, with which a wheel follows its voltage, also to none."""

FRICTION = 0.04
"""Share of the nominal voltage below which a wheel does not turn."""

NOMINAL_VOLTAGE, EMPTY_VOLTAGE = 12.8, 10.5
"""Voltage, in V, of the full and of the empty battery."""

ENDURANCE = 7200.0
"""Time, in s, for which the battery lasts with both motors at full thrust."""

SUPPLY_TIMEOUT = 0.15
"""Age, in s, after which a motor driver takes the last thrust for void."""


@dataclass
class Wheel:
    """
    A wheel with its motor driver and its encoder.

    The three lines may fail: the encoder's and the motor's when they are cut, the driver's input
    when the driver sticks at the thrust that it has then.
    """

    ticks_per_turn: int
    thrust: float = 0.0
    heard_at: float = -math.inf
    speed: float = 0.0
    angle: float = 0.0
    encoder_cut: bool = False
    motor_cut: bool = False
    stuck_at: float | None = None
    _shown: int = 0

    def command(self, thrust: float, now: float) -> None:
        """Take a thrust, from -1 to 1; what is no number is none."""
        self.thrust = max(-1.0, min(1.0, thrust)) if math.isfinite(thrust) else 0.0
        self.heard_at = now

    def drive(self, now: float) -> float:
        """Return the thrust at which the motor driver works."""
        if self.stuck_at is not None:
            return self.stuck_at
        return self.thrust if now - self.heard_at <= SUPPLY_TIMEOUT else 0.0

    def advance(self, voltage: float, duration: float) -> None:
        """Turn for ``duration`` seconds with that share of the nominal voltage at the motor."""
        acting = 0.0 if self.motor_cut or abs(voltage) < FRICTION else voltage
        target = acting * TOP_SPEED
        before = self.speed
        self.speed = target + (before - target) * math.exp(-duration / LAG)
        self.angle += (before + self.speed) / 2 * duration

    def ticks(self) -> int:
        """Return the encoder's counter, signed, of 32 bits; a cut line shows no new tick."""
        if not self.encoder_cut:
            self._shown = math.floor(self.angle / math.tau * self.ticks_per_turn)
        return (self._shown + 2**31) % 2**32 - 2**31


@dataclass
class Board:
    """Two wheels on one battery, with a relay between them."""

    ticks_per_turn: int
    left: Wheel = field(init=False)
    right: Wheel = field(init=False)
    charge: float = 1.0
    motors_off: bool = False

    def __post_init__(self) -> None:
        """Mount the wheels."""
        self.left, self.right = Wheel(self.ticks_per_turn), Wheel(self.ticks_per_turn)

    @property
    def voltage(self) -> float:
        """Return the voltage of the battery, in V."""
        return EMPTY_VOLTAGE + (NOMINAL_VOLTAGE - EMPTY_VOLTAGE) * self.charge

    def advance(self, now: float, duration: float) -> None:
        """Let ``duration`` seconds pass that end at ``now``."""
        for wheel in (self.left, self.right):
            thrust = 0.0 if self.motors_off else wheel.drive(now)
            wheel.advance(thrust * self.voltage / NOMINAL_VOLTAGE, duration)
            self.charge = max(0.0, self.charge - abs(thrust) * duration / ENDURANCE / 2)

    def turns(self) -> bool:
        """Return whether a wheel turns."""
        return max(abs(self.left.speed), abs(self.right.speed)) > 1.0

    def fail(self, fault: str, now: float) -> None:
        """Let an ``encoder``, ``motor`` or ``throttle`` fail for good, as in ``left_encoder``."""
        side, line = fault.split('_')
        wheel = self.left if side == 'left' else self.right
        if line == 'encoder':
            wheel.encoder_cut = True
        elif line == 'motor':
            wheel.motor_cut = True
        elif line == 'throttle':
            wheel.stuck_at = wheel.drive(now)
        else:
            raise ValueError(f'no such fault: {fault}')
