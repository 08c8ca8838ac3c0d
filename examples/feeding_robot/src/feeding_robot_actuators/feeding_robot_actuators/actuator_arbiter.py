"""Moves the actuators as the gate lets it, and only where software is to move them."""

from __future__ import annotations

from feeding_robot_actuators.actuator_arbiter_base import ActuatorArbiterBase, run
from feeding_robot_actuators.arbitration import Arbiter, Limits
from geometry_msgs.msg import Twist
from std_msgs.msg import Float64, UInt8


class ActuatorArbiter(ActuatorArbiterBase):
    """Moves the pedal at a fixed rate, and at once when a command comes."""

    def __init__(self) -> None:
        """Hold the robot until the gate and the mode switch have been heard."""
        super().__init__()
        limits = Limits(self.parameters.top_speed, self.parameters.command_timeout)
        self._arbiter = Arbiter(limits, command_at=self._now())

    def on_command(self, msg: Twist) -> None:
        """Obey the gate."""
        self._arbiter.command(msg.linear.x, msg.angular.z, self._now())
        self._move()

    def on_mode(self, msg: UInt8) -> None:
        """Follow the mode switch."""
        self._arbiter.mode = msg.data

    def on_control(self) -> None:
        """Move the pedal, whether or not anything was heard."""
        self._move()

    def _move(self) -> None:
        pedal, steering = self._arbiter.decide(self._now())
        self.publish_pedal(Float64(data=pedal))
        self.publish_steering(Float64(data=steering))

    def _now(self) -> float:
        return float(self.clock_of_timers.now().nanoseconds) / 1e9


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(ActuatorArbiter, args)


if __name__ == '__main__':
    main()
