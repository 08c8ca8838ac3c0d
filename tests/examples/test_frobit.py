"""The Frobit without ROS: its parts, and what its rules make of each fault of its board."""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Iterator
from typing import Any

import pytest

from deros.diagnostics import SourceFile
from deros.interfaces.store import InterfaceStore
from deros.rules.engine.engine import Engine
from deros.simulation.simulate import seconds, simulate
from deros.simulation.trace import nanoseconds, read_trace
from tests.support.examples import example_module, example_program

board = example_module("frobit", "frobit_base.board")
regulation = example_module("frobit", "frobit_wheel.regulation")
differential = example_module("frobit", "frobit_drive.differential")
route = example_module("frobit", "frobit_route.route")

STORE = InterfaceStore()
PERIOD = 0.02
TICKS = 180
AXLE = differential.Axle(0.051, 0.215)
FAULTS = {
    "encoder": "wheel_without_answer",
    "motor": "wheel_astray",
    "throttle": "wheel_astray",
}

program = functools.partial(example_program, "frobit")


class Robot:
    """Board, wheel controllers and drive controller in one loop of 20 ms, without its nodes."""

    def __init__(self) -> None:
        """Stand, all lines whole."""
        self.board = board.Board(TICKS)
        self.wheels = (self.board.left, self.board.right)
        self.tachometers = [regulation.Tachometer(TICKS) for _ in self.wheels]
        self.regulators = [regulation.Regulator(12.0, 0.05, 0.3) for _ in self.wheels]
        self.setpoints = [0.0, 0.0]
        self.cycle = 0

    @property
    def now(self) -> float:
        """Return the time in s."""
        return self.cycle * PERIOD

    def step(self, forward: float, turn: float = 0.0) -> Iterator[tuple[str, dict[str, Any]]]:
        """Drive for a cycle; yield the messages that the rules read."""
        speeds = []
        wanted = AXLE.wheels(forward, turn)
        for side, wheel in enumerate(self.wheels):
            name = ("left", "right")[side]
            self.tachometers[side].count(wheel.ticks(), self.now)
            speed = self.tachometers[side].speed()
            speeds.append(speed)
            setpoint = differential.towards(self.setpoints[side], wanted[side], PERIOD / 0.051)
            self.setpoints[side] = setpoint
            thrust = self.regulators[side].thrust(setpoint, speed, PERIOD)
            wheel.command(thrust, self.now)
            yield f"/{name}/setpoint", {"data": setpoint}
            yield f"/{name}/thrust", {"data": thrust}
            yield f"/{name}/speed", {"data": speed}
        yield "/odometry", {"twist.twist.linear.x": AXLE.motion(*speeds)[0]}
        self.cycle += 1
        self.board.advance(self.now, PERIOD)


def verdicts(lines: list[str], until: float) -> list[tuple[float, str, str | None]]:
    """Return time (s), action and behaviour of each trigger of the rules."""
    trace = read_trace(SourceFile("trace.jsonl", "\n".join(lines)), program(), STORE)
    assert trace.diagnostics == ()
    events = simulate(Engine(program()), trace.messages, nanoseconds(f"{until:.3f}"))
    return [
        (float(seconds(e.t_ns)), e.action, e.behaviour)
        for e in events
        if e.kind == "trigger" and e.action != "log_state"
    ]


def drive(robot: Robot, until: float, way: Any, lines: list[str]) -> None:
    """Drive until a time (s) as ``way`` of the time says, and append the messages."""
    while robot.now < until - 1e-9:
        stamp = f"{robot.now:.3f}"
        for topic, data in robot.step(*way(robot.now)):
            lines.append(json.dumps({"t": stamp, "topic": topic, "data": data}))


def straight(_now: float) -> tuple[float, float]:
    """Drive straight on, as the route does."""
    return 0.3, 0.0


def winding(now: float) -> tuple[float, float]:
    """Set off, turn on the spot, drive a curve, stand: by turns of a second and a half."""
    return [(0.3, 0.0), (0.0, 1.0), (0.3, -0.5), (0.0, 0.0)][int(now / 1.5) % 4]


def test_nothing_is_wrong_with_a_robot_that_drives_its_route() -> None:
    """It sets off, turns and halts for 24 seconds, and no rule acts."""
    lines: list[str] = []
    robot = Robot()
    drive(robot, 24.0, winding, lines)
    assert verdicts(lines, 24.0) == []
    assert robot.wheels[0].angle > 20.0, "it has not moved"


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("line", FAULTS)
def test_each_fault_of_the_board_stops_the_robot(line: str, side: str) -> None:
    """A cut encoder shows no tick at once, and a wheel without its motor rolls out.

    The throttle sticks while the robot drives, and shows when it should halt a second later.
    """
    lines: list[str] = []
    robot = Robot()
    drive(robot, 3.0, straight, lines)
    robot.board.fail(f"{side}_{line}", robot.now)
    shows = 4.0 if line == "throttle" else 3.0
    drive(robot, shows, straight, lines)
    drive(robot, 6.0, straight if shows == 3.0 else lambda _: (0.0, 0.0), lines)
    when, action, behaviour = verdicts(lines, 6.0)[0]
    assert (action, behaviour) == ("stop", FAULTS[line])
    assert 0.0 < when - shows < 1.0


def test_motor_that_is_cut_before_the_robot_sets_off_stops_it() -> None:
    """The wheel does not answer to thrust."""
    lines: list[str] = []
    robot = Robot()
    robot.board.fail("right_motor", 0.0)
    drive(robot, 3.0, straight, lines)
    when, action, behaviour = verdicts(lines, 3.0)[0]
    assert (action, behaviour) == ("stop", "wheel_without_answer")
    assert 0.3 < when < 0.8


@pytest.mark.parametrize("line", ["encoder", "throttle"])
def test_relay_ends_what_no_command_can(line: str) -> None:
    """Without the motors' supply the wheel stands, whatever the thrust is stuck at."""
    robot = Robot()
    drive(robot, 3.0, straight, [])
    robot.board.fail(f"left_{line}", robot.now)
    drive(robot, 4.0, straight, [])
    assert robot.board.left.speed > 4.0
    robot.board.motors_off = True
    drive(robot, 6.0, straight, [])
    assert abs(robot.board.left.speed) < 0.01


def test_cut_encoder_shows_no_tick_while_the_wheel_turns_faster() -> None:
    """The regulator takes the wheel for one that stands, and gives it all that there is."""
    robot = Robot()
    drive(robot, 3.0, straight, [])
    turning = robot.board.left.speed
    robot.board.fail("left_encoder", robot.now)
    shown = robot.board.left.ticks()
    drive(robot, 5.0, straight, [])
    assert robot.board.left.ticks() == shown
    assert robot.board.left.speed > 1.5 * turning


def test_command_to_stand_stops_a_wheel_whose_encoder_is_cut() -> None:
    """What the regulator has summed up in vain does not drive it on."""
    regulator = regulation.Regulator(12.0, 0.05, 0.3)
    for _ in range(100):
        wound_up = regulator.thrust(6.0, 0.0, PERIOD)
    assert wound_up == 1.0
    assert regulator.thrust(0.0, 0.0, PERIOD) == 0.0
    assert regulator.thrust(6.0, 6.0, PERIOD) == pytest.approx(0.5)


@pytest.mark.parametrize("setpoint", [math.nan, math.inf])
def test_setpoint_that_is_no_number_gives_no_thrust(setpoint: float) -> None:
    """Neither in the regulator, nor in the motor driver."""
    assert regulation.Regulator(12.0, 0.05, 0.3).thrust(setpoint, 1.0, PERIOD) == 0.0
    wheel = board.Wheel(TICKS)
    wheel.command(setpoint, 0.0)
    assert wheel.drive(0.0) == 0.0


def test_motor_driver_stands_when_thrusts_cease() -> None:
    """A computer that hangs does not drive on."""
    wheel = board.Wheel(TICKS)
    wheel.command(0.5, 1.0)
    assert wheel.drive(1.15) == 0.5
    assert wheel.drive(1.16) == 0.0


def test_speed_is_right_where_the_counter_wraps() -> None:
    """From the largest 32-bit number to the least is one tick forwards."""
    tachometer = regulation.Tachometer(TICKS)
    for number in range(10):
        ticks = (2**31 - 5 + number + 2**31) % 2**32 - 2**31
        tachometer.count(ticks, number * PERIOD)
    assert tachometer.speed() == pytest.approx(math.tau / TICKS / PERIOD)


def test_board_counts_a_turn_of_the_wheel_and_wraps() -> None:
    """One turn is 180 ticks, backwards too, and the counter goes round."""
    wheel = board.Wheel(TICKS)
    for ticks, shown in [(180, 180), (-180, -180), (2**31 - 1, 2**31 - 1), (2**31, -(2**31))]:
        wheel.angle = (ticks + 0.5) / TICKS * math.tau
        assert wheel.ticks() == shown


def test_axle_and_its_inverse_agree() -> None:
    """What the wheels are set to is what the odometry says."""
    assert AXLE.motion(*AXLE.wheels(0.3, -0.7)) == pytest.approx((0.3, -0.7))
    pose = differential.Pose()
    for _ in range(round(math.tau / PERIOD)):
        pose.advance(0.3, 1.0, PERIOD)
    assert math.hypot(pose.x, pose.y) < 0.01, "a full circle ends where it began"


def test_route_goes_round_its_waypoints() -> None:
    """All four corners are reached, in their order, twice."""
    corners = route.pairs([1.5, 0.0, 1.5, 1.0, 0.0, 1.0, 0.0, 0.0])
    way, pose = route.Route(corners, 0.3), differential.Pose()
    reached: list[tuple[float, float]] = []
    for _ in range(5000):
        forward, turn = way.command(pose.x, pose.y, pose.yaw)
        pose.advance(forward, turn, PERIOD)
        for corner in corners:
            near = math.dist((pose.x, pose.y), corner) < route.REACHED
            if near and reached[-1:] != [corner]:
                reached.append(corner)
    assert reached[0] == (0.0, 0.0), "it begins at the last one"
    assert reached[1:9] == [*corners, *corners]


@pytest.mark.parametrize("numbers", [[], [1.0], [1.0, 2.0, 3.0], [1.0, math.nan]])
def test_waypoints_that_are_no_points_are_refused(numbers: list[float]) -> None:
    """With the reason."""
    with pytest.raises(ValueError, match="x and y of each point"):
        route.pairs(numbers)
