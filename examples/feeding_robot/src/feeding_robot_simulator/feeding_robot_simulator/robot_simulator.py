"""The machine itself, simulated: chassis, hydraulic drive, diesel engine and the yard around."""

from __future__ import annotations

import math

from builtin_interfaces.msg import Time
from feeding_robot_simulator.kinematics import (
    Controls,
    IDLE_SPEED,
    Motion,
    Obstacle,
    quaternion,
    unevenness,
    Vehicle,
)
from feeding_robot_simulator.robot_simulator_base import RobotSimulatorBase, run
from geometry_msgs.msg import Vector3
from nav_msgs.msg import Odometry
from rclpy.clock import Clock, ClockType
from rosgraph_msgs.msg import Clock as ClockMessage
from std_msgs.msg import Bool, Float64

SLOW_CYCLES = 4
"""Engine speed and clearance are measured in every fourth cycle."""

LONGEST_CYCLE = 0.1
"""Most seconds that one cycle makes up for: a machine that was held up does not leap."""


class RobotSimulator(RobotSimulatorBase):
    """Integrates the motion and publishes the truth, which the sensor drivers then measure."""

    def __init__(self) -> None:
        """Start at rest, with the engine off and nothing ahead."""
        super().__init__()
        self._vehicle = Vehicle(self.parameters.top_speed, self.parameters.wheel_base)
        self._motion = Motion()
        self._pedal = 0.0
        self._steering = 0.0
        self._engine_on = False
        self._override = math.nan
        self._slope = Vector3()
        self._obstacle = Obstacle()
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._last_cycle = self._steady.now().nanoseconds
        self._cycles = 0
        self._elapsed = 0.0
        self._stepped = False

    def on_pedal(self, msg: Float64) -> None:
        """Move the pedal, unless a hand holds it."""
        self._pedal = msg.data

    def on_steering(self, msg: Float64) -> None:
        """Turn the front wheels."""
        self._steering = msg.data

    def on_engine_enable(self, msg: Bool) -> None:
        """Open or shut the fuel valve."""
        self._engine_on = msg.data
        self._publish_engine_speed()

    def on_world_obstacle(self, msg: Float64) -> None:
        """Put an obstacle ahead, or take it away."""
        self._obstacle = Obstacle(msg.data)

    def on_world_slope(self, msg: Vector3) -> None:
        """Tilt the ground."""
        self._slope = msg

    def on_world_pedal_override(self, msg: Float64) -> None:
        """Hold the pedal by hand, or let it go."""
        self._override = msg.data

    def on_world_step(self, msg: Float64) -> None:
        """Advance by the step that the player asks for; real time no longer counts."""
        self._stepped = True
        self._advance(msg.data)
        self._publish_slow_signals()

    def on_cycle(self) -> None:
        """Advance by the real time since the last cycle."""
        now = self._steady.now().nanoseconds
        passed = (now - self._last_cycle) / 1e9
        self._last_cycle = now
        if self._stepped:
            return
        self._advance(min(passed, LONGEST_CYCLE))
        self._cycles += 1
        if self._cycles % SLOW_CYCLES == 0:
            self._publish_slow_signals()

    def _advance(self, duration: float) -> None:
        pedal = self._pedal if math.isnan(self._override) else self._override
        controls = Controls(pedal, self._steering, self._engine_on)
        self._motion = self._vehicle.advance(self._motion, controls, duration)
        self._obstacle = self._obstacle.approached(self._motion.speed * duration)
        self._elapsed += duration
        nanoseconds = round(self._elapsed * 1e9)
        self.publish_clock(
            ClockMessage(clock=Time(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9))
        )
        self.publish_motion(self._odometry())

    def _odometry(self) -> Odometry:
        msg = Odometry()
        msg.header.stamp = self.get_clock().now().to_msg()
        msg.header.frame_id = 'yard'
        msg.child_frame_id = 'base_link'
        pose = msg.pose.pose
        pose.position.x, pose.position.y = self._motion.x, self._motion.y
        roll, pitch = unevenness(self._motion.x)
        orientation = quaternion(self._slope.x + roll, self._slope.y + pitch, self._motion.yaw)
        pose.orientation.x, pose.orientation.y = orientation[0], orientation[1]
        pose.orientation.z, pose.orientation.w = orientation[2], orientation[3]
        msg.twist.twist.linear.x = self._motion.speed
        msg.twist.twist.angular.z = self._motion.yaw_rate
        return msg

    def _publish_slow_signals(self) -> None:
        self.publish_clearance(Float64(data=self._obstacle.distance))
        self._publish_engine_speed()

    def _publish_engine_speed(self) -> None:
        self.publish_engine_speed(Float64(data=IDLE_SPEED if self._engine_on else 0.0))


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(RobotSimulator, args)


if __name__ == '__main__':
    main()
