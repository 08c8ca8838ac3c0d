"""Keeps a wheel at its setpoint."""

from __future__ import annotations

from frobit_wheel.regulation import Regulator, Tachometer
from frobit_wheel.wheel_controller_base import run, WheelControllerBase
from std_msgs.msg import Float64, Int32

PERIOD = 0.02
"""Time, in s, from one cycle of control to the next."""


class WheelController(WheelControllerBase):
    """Regulates at a fixed rate; without setpoint or ticks there is no thrust."""

    def __init__(self) -> None:
        """Stand."""
        super().__init__()
        given = self.parameters
        self._tachometer = Tachometer(given.ticks_per_turn)
        self._regulator = Regulator(given.top_speed, given.gain, given.integral_gain)
        self._setpoint = 0.0
        self._asked_at = self._now()

    def on_setpoint(self, msg: Float64) -> None:
        """Take the speed to turn at."""
        self._setpoint = msg.data
        self._asked_at = self._now()

    def on_encoder(self, msg: Int32) -> None:
        """Take the counter of the encoder."""
        self._tachometer.count(msg.data, self._now())

    def on_control(self) -> None:
        """Set the thrust, and report the speed while there is one to report."""
        now, timeout = self._now(), self.parameters.timeout
        seen = self._tachometer.age(now) <= timeout
        asked = now - self._asked_at <= timeout
        speed = self._tachometer.speed()
        setpoint = self._setpoint if seen and asked else 0.0
        self.publish_thrust(Float64(data=self._regulator.thrust(setpoint, speed, PERIOD)))
        if seen:
            self.publish_speed(Float64(data=speed))

    def _now(self) -> float:
        return float(self.clock_of_timers.now().nanoseconds) / 1e9


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(WheelController, args)


if __name__ == '__main__':
    main()
