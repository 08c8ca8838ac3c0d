"""The base and the room that it drives in: what moves it, what it counts, what it bumps into."""

from __future__ import annotations

from dataclasses import dataclass
import math

WHEEL_RADIUS, WHEEL_DISTANCE = 0.035, 0.23
"""Measures of the Kobuki in m."""

BODY_RADIUS = 0.178
"""Radius, in m, of the round body; its front is the bumper."""

TICKS_PER_TURN = 2578.33
"""Ticks of an encoder in one turn of its wheel."""

COUNTER = 1 << 16
"""Encoders and time stamps are counted in 16 bits, and begin anew."""

FASTEST, FASTEST_TURN = 0.7, math.pi
"""What the motors can do, in m/s and rad/s."""

ACCELERATION, TURN_ACCELERATION = 0.3, 3.5
"""How fast the driver lets the speed change, in m/s² and rad/s²."""

COMMAND_TIMEOUT = 0.6
"""Age, in s, after which the driver stands."""

ROLL_OUT = 0.1
"""Time constant, in s, with which the wheels stop without power."""

WALL = 2.0
"""Distance, in m, of each of the four walls from where the robot starts."""

RIGHT, MIDDLE, LEFT = 1, 2, 4
"""Bits of the bumper."""

MIDDLE_ENDS, SIDE_ENDS = math.radians(30.0), math.radians(90.0)
"""Bearings from straight ahead, on both sides, at which parts of the bumper end."""

FULL, EMPTY = 16.5, 13.2
"""Voltage, in V, of the full and of the empty battery."""

ENDURANCE = 10800.0
"""Time, in s, for which the battery lasts."""

GYRO_STEP = math.radians(0.00875)
"""Least difference, in rad/s, that the gyroscope shows."""

STICKING = {'throttle': (FASTEST, 0.0), 'spin': (0.0, FASTEST_TURN)}
"""What the motors do, in m/s and rad/s, with each fault."""


@dataclass
class Base:
    """A robot in its room: pose in m and rad, speeds in m/s and rad/s, angles of wheels in rad."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    forward: float = 0.0
    turn: float = 0.0
    left: float = 0.0
    right: float = 0.0
    charge: float = 1.0
    motors_off: bool = False
    fault: str = ''
    _wanted: tuple[float, float] = (0.0, 0.0)
    _commanded_at: float = -math.inf

    def command(self, forward: float, turn: float, now: float) -> None:
        """Take a command, within what the motors can do; what is no number is one to stand."""
        if not (math.isfinite(forward) and math.isfinite(turn)):
            forward = turn = 0.0
        self._wanted = limited(forward, FASTEST), limited(turn, FASTEST_TURN)
        self._commanded_at = now

    def advance(self, now: float, duration: float) -> None:
        """Let ``duration`` seconds pass that end at ``now``."""
        if self.motors_off:
            kept = math.exp(-duration / ROLL_OUT)
            self.forward, self.turn = self.forward * kept, self.turn * kept
        else:
            forward, turn = self._driven(now)
            self.forward += limited(forward - self.forward, ACCELERATION * duration)
            self.turn += limited(turn - self.turn, TURN_ACCELERATION * duration)
        aside = self.turn * WHEEL_DISTANCE / 2
        self.left += (self.forward - aside) / WHEEL_RADIUS * duration
        self.right += (self.forward + aside) / WHEEL_RADIUS * duration
        heading = self.yaw + self.turn * duration / 2
        self.yaw = math.remainder(self.yaw + self.turn * duration, math.tau)
        # At a wall, the wheels slip.
        self.x = limited(self.x + self.forward * duration * math.cos(heading), WALL - BODY_RADIUS)
        self.y = limited(self.y + self.forward * duration * math.sin(heading), WALL - BODY_RADIUS)
        self.charge = max(0.0, self.charge - duration / ENDURANCE)

    def _driven(self, now: float) -> tuple[float, float]:
        """Return the speeds that the motors are driven at."""
        if self.fault:
            return STICKING[self.fault]
        return self._wanted if now - self._commanded_at <= COMMAND_TIMEOUT else (0.0, 0.0)

    def counters(self) -> tuple[int, int]:
        """Return the states of the encoders, left and right."""
        turns = self.left / math.tau, self.right / math.tau
        left, right = (math.floor(each * TICKS_PER_TURN) % COUNTER for each in turns)
        return left, right

    def gyro(self) -> float:
        """Return the turn rate, in rad/s, that the gyroscope shows."""
        return round(self.turn / GYRO_STEP) * GYRO_STEP

    def bumper(self) -> int:
        """Return the bits of the parts of the bumper that touch a wall."""
        bits = 0
        for place, bearing in ((self.x, 0.0), (self.y, math.pi / 2)):
            if abs(place) >= WALL - BODY_RADIUS:
                wall = bearing if place > 0.0 else bearing + math.pi
                bits |= part_touched(math.remainder(wall - self.yaw, math.tau))
        return bits

    @property
    def voltage(self) -> float:
        """Return the voltage of the battery, in V."""
        return EMPTY + (FULL - EMPTY) * self.charge

    def moves(self) -> bool:
        """Return whether it drives or turns."""
        return abs(self.forward) > 0.05 or abs(self.turn) > 0.2


def limited(number: float, most: float) -> float:
    """Return the number that is nearest to one, within ``most`` of zero."""
    return max(-most, min(most, number))


def part_touched(bearing: float) -> int:
    """Return which part of the bumper is in a direction, in rad from straight ahead."""
    if abs(bearing) <= MIDDLE_ENDS:
        return MIDDLE
    if abs(bearing) > SIDE_ENDS:
        return 0
    return LEFT if bearing > 0.0 else RIGHT
