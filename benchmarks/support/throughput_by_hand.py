"""What an engineer writes by hand for the rules of :mod:`support.throughput_rules`, for speed.

Straight-line code, one function per topic, nothing general: the generated monitor is measured
against it. It does the same job, with the same events: it handles NaN, edges, intervals, timeouts,
late timers and backward clocks. Nobody writes a hundred rules like this.
"""

from __future__ import annotations

import math
from collections.abc import Callable

Event = tuple[int, str, str, str]
"""The time in ns, what happened, the action, the behaviour."""

NAN = math.nan
NEVER = 1 << 63
TIMEOUT = 500_000_000


class OneRuleByHand:
    """The single rule: too fast for two seconds."""

    __slots__ = ("due", "emit", "fast", "heard", "missing", "now", "since")

    def __init__(self, start: int, emit: Callable[[Event], None]) -> None:
        """Start the timeout."""
        self.emit = emit
        self.now = self.heard = start
        self.due = start + TIMEOUT
        self.since = NEVER
        self.fast = self.missing = False

    def odometry(self, t: int, speed: float) -> None:
        """Take the speed."""
        if not self.now <= t < self.due:
            self.catch_up(t)
        self.now = t
        if speed == speed:
            self.heard = t
            if self.missing:
                self.missing = False
                self.due = min(self.due, t + TIMEOUT)
            if speed > 0.5:
                if self.since == NEVER:
                    self.since = t
                    self.due = min(self.due, t + 2_000_000_000)
                return
        self.since = NEVER
        self.fast = False

    def catch_up(self, t: int) -> None:
        """Settle what is due."""
        if t < self.now:
            self.emit((t, "clock_step", "", ""))
            self.since = NEVER
            self.fast = self.missing = False
            self.heard = t
        while (due := self.earliest()) <= t:
            if self.since + 2_000_000_000 <= due and not self.fast:
                self.fast = True
                self.emit((due, "trigger", "stop", "rushes_0"))
            if self.heard + TIMEOUT <= due:
                self.missing = True
                self.since = NEVER
                self.fast = False
        self.due = due

    def earliest(self) -> int:
        """Return the next deadline."""
        due = NEVER if self.missing else self.heard + TIMEOUT
        return due if self.fast else min(due, self.since + 2_000_000_000)


class RobotByHand:
    """The fourteen rules and thirteen behaviours of the paper's robot."""

    __slots__ = (
        *("arm", "arm_at", "arm_gone", "auto", "bumper", "bumper_at", "bumper_gone", "button"),
        *("button_at", "button_gone", "close", "dangerous", "due", "emit", "far", "front_at"),
        *("front_gone", "held", "imu_at", "imu_gone", "left_due", "low_speed_on", "manual"),
        *("mode_at", "mode_gone", "motor_stop_on", "moving", "near", "now", "reverse_due"),
        *("roll_over", "speed_at", "speed_due", "speed_gone", "stop_on", "tilt_due", "tilted"),
        "too_fast",
    )

    def __init__(self, start: int, emit: Callable[[Event], None]) -> None:
        """Start the timeouts."""
        self.emit = emit
        self.now = start
        self.low_speed_on = self.stop_on = self.motor_stop_on = False
        self.held = [False] * 13
        self.start(start)

    def start(self, t: int) -> None:
        """Know nothing, as at the start and after a backward step of the clock."""
        self.imu_at = self.speed_at = self.front_at = self.mode_at = t
        self.button_at = self.bumper_at = self.arm_at = t
        self.imu_gone = self.front_gone = self.mode_gone = False
        self.button_gone = self.bumper_gone = self.arm_gone = False
        self.tilt_due = self.speed_due = self.reverse_due = self.left_due = NEVER
        self.tilted = self.roll_over = self.far = self.close = self.near = False
        self.button = self.bumper = self.arm = self.manual = self.auto = False
        self.too_fast = self.dangerous = self.speed_gone = False
        self.moving: bool | None = None
        self.due = t + TIMEOUT

    # Messages

    def imu(self, t: int, x: float, y: float, z: float, w: float) -> None:
        """Take the orientation."""
        if not self.now <= t < self.due:
            self.catch_up(t)
        self.now = t
        tilted = roll_over = False
        if x == x and y == y and z == z and w == w:
            self.imu_at = t
            if self.imu_gone:
                self.imu_gone = False
                self.due = min(self.due, t + TIMEOUT)
            length = math.sqrt(x * x + y * y + z * z + w * w)
            if 0.0 < length < math.inf:
                x, y, z, w = x / length, y / length, z / length, w / length
                roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
                sine = 2.0 * (w * y - z * x)
                pitch = math.asin(-1.0 if sine < -1.0 else 1.0 if sine > 1.0 else sine)
                tilted = not (-0.139626 <= roll <= 0.139626 and -0.139626 <= pitch <= 0.139626)
                roll_over = not (-0.174533 <= roll <= 0.174533 and -0.174533 <= pitch <= 0.174533)
        if tilted:
            if self.tilt_due == NEVER:
                self.tilt_due = t + 4_000_000_000
                self.due = min(self.due, self.tilt_due)
            tilted = t >= self.tilt_due
        elif self.tilt_due != NEVER:
            self.tilt_due = NEVER
        if tilted != self.tilted or roll_over != self.roll_over:
            self.tilted = tilted
            self.roll_over = roll_over
            self.act(t)

    def odometry(self, t: int, speed: float) -> None:
        """Take the speed."""
        if not self.now <= t < self.due:
            self.catch_up(t)
        self.now = t
        moving = None
        if speed == speed:
            self.speed_at = t
            if self.speed_gone:
                self.due = min(self.due, t + TIMEOUT)
            moving = not -0.05 <= speed <= 0.05
            silent = False
        else:
            silent = self.speed_gone
        if speed > 0.5:
            if self.speed_due == NEVER:
                self.speed_due = t + 4_000_000_000
                self.due = min(self.due, self.speed_due)
        elif self.speed_due != NEVER:
            self.speed_due = NEVER
        if speed < -0.25:
            if self.reverse_due == NEVER:
                self.reverse_due = t + 2_000_000_000
                self.due = min(self.due, self.reverse_due)
        elif self.reverse_due != NEVER:
            self.reverse_due = NEVER
        too_fast = t >= self.speed_due or t >= self.reverse_due
        dangerous = speed > 1.0 or speed < -0.4
        if (
            moving is not self.moving
            or too_fast != self.too_fast
            or dangerous != self.dangerous
            or silent != self.speed_gone
        ):
            self.moving = moving
            self.too_fast = too_fast
            self.dangerous = dangerous
            self.speed_gone = silent
            self.act(t)

    def front(self, t: int, distance: float) -> None:
        """Take the distance of the nearest obstacle."""
        if not self.now <= t < self.due:
            self.catch_up(t)
        self.now = t
        if distance == distance:
            self.front_at = t
            if self.front_gone:
                self.front_gone = False
                self.due = min(self.due, t + TIMEOUT)
        far = 2.0 <= distance < 4.0
        close = 0.8 <= distance < 2.0
        near = distance < 0.8
        if far != self.far or close != self.close or near != self.near:
            self.far = far
            self.close = close
            self.near = near
            self.act(t)

    def mode(self, t: int, mode: int) -> None:
        """Take the mode."""
        if not self.now <= t < self.due:
            self.catch_up(t)
        self.now = self.mode_at = t
        if self.mode_gone:
            self.mode_gone = False
            self.due = min(self.due, t + TIMEOUT)
        manual = mode == 0
        auto = mode == 2
        if manual != self.manual or auto != self.auto:
            self.manual = manual
            self.auto = auto
            self.act(t)

    def stop_button(self, t: int, pressed: bool) -> None:
        """Take the stop button."""
        if not self.now <= t < self.due:
            self.catch_up(t)
        self.now = self.button_at = t
        if self.button_gone:
            self.button_gone = False
            self.due = min(self.due, t + TIMEOUT)
        if pressed != self.button:
            self.button = pressed
            self.act(t)

    def bumpers(self, t: int, pressed: bool) -> None:
        """Take the bumper."""
        if not self.now <= t < self.due:
            self.catch_up(t)
        self.now = self.bumper_at = t
        if self.bumper_gone:
            self.bumper_gone = False
            self.due = min(self.due, t + TIMEOUT)
        if pressed != self.bumper:
            self.bumper = pressed
            self.act(t)

    def feeding_arm(self, t: int, pressed: bool) -> None:
        """Take the contact of the feeding arm."""
        if not self.now <= t < self.due:
            self.catch_up(t)
        self.now = self.arm_at = t
        if self.arm_gone:
            self.arm_gone = False
            self.due = min(self.due, t + TIMEOUT)
        if pressed != self.arm:
            self.arm = pressed
            self.act(t)

    # Behaviours

    def act(self, t: int) -> None:
        """Do what the behaviours ask for that hold now and did not before."""
        auto, moving = self.auto, self.moving
        standing = moving is False and auto
        if standing:
            if self.left_due == NEVER:
                self.left_due = t + 600_000_000_000
                self.due = min(self.due, self.left_due)
        else:
            self.left_due = NEVER
        was = self.held
        holds = self.held = [
            self.too_fast and auto,
            self.dangerous and auto,
            self.dangerous and self.manual,
            (self.tilted and moving is True and auto) or self.roll_over,
            self.far and moving is True and auto,
            self.close and auto,
            self.near,
            self.button,
            self.bumper and auto,
            self.arm and auto,
            t >= self.left_due,
            self.speed_gone,
            self.manual,
        ]
        if holds == was:
            return
        reset = False
        for name, actions, held, before in zip(BEHAVIOURS, ACTIONS, holds, was, strict=True):
            if held and not before:
                for action in actions:
                    self.emit((t, "trigger", action, name))
                    if action == "low_speed":
                        self.low_speed_on = True
                    elif action == "stop":
                        self.stop_on = True
                    elif action == "motor_stop":
                        self.motor_stop_on = True
                    else:
                        reset = True
        if reset and self.low_speed_on:
            self.low_speed_on = holds[0] or holds[2] or holds[4]
            self.emit((t, "refused" if self.low_speed_on else "reset", "low_speed", ""))
        if reset and self.stop_on:
            self.stop_on = holds[1] or holds[3] or any(holds[5:10]) or holds[11]
            self.emit((t, "refused" if self.stop_on else "reset", "stop", ""))

    # Time

    def catch_up(self, t: int) -> None:
        """Settle a backward step of the clock, then what is due up to now."""
        if t < self.now:
            self.now = t
            self.start(t)
            self.emit((t, "clock_step", "", ""))
            self.act(t)
        while (due := self.earliest()) <= t:
            self.now = due
            if self.imu_at + TIMEOUT <= due and not self.imu_gone:
                self.imu_gone = True
                self.tilted = self.roll_over = False
                self.tilt_due = NEVER
            if self.speed_at + TIMEOUT <= due and not self.speed_gone:
                self.speed_gone = True
                self.moving = None
                self.dangerous = False
                self.speed_due = self.reverse_due = NEVER
            if self.front_at + TIMEOUT <= due and not self.front_gone:
                self.front_gone = True
                self.far = self.close = self.near = False
            if self.mode_at + TIMEOUT <= due and not self.mode_gone:
                self.mode_gone = True
                self.manual = self.auto = False
            if self.button_at + TIMEOUT <= due and not self.button_gone:
                self.button_gone = True
                self.button = False
            if self.bumper_at + TIMEOUT <= due and not self.bumper_gone:
                self.bumper_gone = True
                self.bumper = False
            if self.arm_at + TIMEOUT <= due and not self.arm_gone:
                self.arm_gone = True
                self.arm = False
            self.tilted = due >= self.tilt_due
            self.too_fast = due >= self.speed_due or due >= self.reverse_due
            self.act(due)
        self.due = due

    def earliest(self) -> int:
        """Return the next deadline."""
        due = NEVER
        if not self.imu_gone:
            due = self.imu_at + TIMEOUT
        if not self.speed_gone and self.speed_at + TIMEOUT < due:
            due = self.speed_at + TIMEOUT
        if not self.front_gone and self.front_at + TIMEOUT < due:
            due = self.front_at + TIMEOUT
        if not self.mode_gone and self.mode_at + TIMEOUT < due:
            due = self.mode_at + TIMEOUT
        if not self.button_gone and self.button_at + TIMEOUT < due:
            due = self.button_at + TIMEOUT
        if not self.bumper_gone and self.bumper_at + TIMEOUT < due:
            due = self.bumper_at + TIMEOUT
        if not self.arm_gone and self.arm_at + TIMEOUT < due:
            due = self.arm_at + TIMEOUT
        for end in (self.tilt_due, self.speed_due, self.reverse_due, self.left_due):
            if self.now < end < due:
                due = end
        return due


BEHAVIOURS = (
    *("too_fast_0", "much_too_fast_0", "fast_by_hand_0", "tilted_0", "warn_0", "hold_0"),
    *("avoid_0", "button_0", "bumped_0", "arm_hit_0", "left_running_0", "lost_0", "manual_0"),
)
ACTIONS = (
    ("low_speed",),
    ("motor_stop", "stop"),
    ("low_speed",),
    ("motor_stop", "stop"),
    ("low_speed",),
    ("stop",),
    ("stop",),
    ("motor_stop", "stop"),
    ("motor_stop", "stop"),
    ("motor_stop", "stop"),
    ("motor_stop",),
    ("stop",),
    ("controllerOk",),
)
"""What each behaviour does."""
