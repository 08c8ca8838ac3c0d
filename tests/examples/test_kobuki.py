"""The Kobuki without ROS: its parts, and what its rules make of what the base measures."""

from __future__ import annotations

import functools
import json
import math
from typing import Any

import pytest

from deros.diagnostics import SourceFile
from deros.interfaces.store import InterfaceStore
from deros.rules.engine.engine import Engine
from deros.simulation.simulate import seconds, simulate
from deros.simulation.trace import nanoseconds, read_trace
from tests.support.examples import example_module, example_program

base = example_module("kobuki", "kobuki_base.base")
odometry = example_module("kobuki", "kobuki_base.odometry")
star = example_module("kobuki", "kobuki_pilot.star")

STORE = InterfaceStore()
PERIOD = 0.02
CRUISE = 0.25

program = functools.partial(example_program, "kobuki")


class Robot:
    """Base, driver and pilot in one loop of 20 ms, without their nodes."""

    def __init__(self) -> None:
        """Stand in the middle of the room."""
        self.base = base.Base()
        self.odometry = odometry.DeadReckoning()
        self.star = star.Star(CRUISE)
        self.lines: list[str] = []
        self.cycle = 0
        self.astray = False

    @property
    def now(self) -> float:
        """Return the time in s."""
        return self.cycle * PERIOD

    def drive(self, until: float) -> None:
        """Drive until a time (s), and keep the messages that the rules read."""
        while self.now < until - 1e-9:
            self.cycle += 1
            self.base.advance(self.now, PERIOD)
            self.odometry.count(*self.base.counters(), round(self.now * 1000) % base.COUNTER)
            pose = self.odometry.x, self.odometry.y, self.odometry.yaw
            command = (CRUISE, 0.0) if self.astray else self.star.command(*pose)
            if self.base.bumper() or star.stands(self.now):
                command = (0.0, 0.0)
            self.base.command(*command, self.now)
            self._say(
                "/odometry",
                {
                    "pose.pose.position.x": pose[0],
                    "pose.pose.position.y": pose[1],
                    "pose.pose.position.z": 0.0,
                    "twist.twist.linear.x": self.odometry.forward,
                },
            )
            self._say("/imu", {"angular_velocity.z": self.base.gyro()})
            self._say("/pilot/load", {"data": 5.0})

    def _say(self, topic: str, data: dict[str, Any]) -> None:
        self.lines.append(json.dumps({"t": f"{self.now:.3f}", "topic": topic, "data": data}))

    def stops(self) -> list[tuple[float, str | None]]:
        """Return the time (s) and behaviour of each stop that the rules make of the messages."""
        trace = read_trace(SourceFile("trace.jsonl", "\n".join(self.lines)), program(), STORE)
        assert trace.diagnostics == ()
        events = simulate(Engine(program()), trace.messages, nanoseconds(f"{self.now:.3f}"))
        return [
            (float(seconds(e.t_ns)), e.behaviour)
            for e in events
            if e.kind == "trigger" and e.action == "stop"
        ]


def test_nothing_is_wrong_with_a_robot_that_drives_along_its_star() -> None:
    """It sets off, turns and halts for a minute, and no rule acts; it has reached all points."""
    robot = Robot()
    reached = set()
    while robot.now < 60.0:
        robot.drive(robot.now + 0.1)
        place = robot.base.x, robot.base.y
        reached |= {
            n for n in range(star.POINTS) if math.dist(place, star.Star(0, n)._point()) < 0.2
        }
    assert robot.stops() == []
    assert reached == set(range(star.POINTS))


@pytest.mark.parametrize(
    ("fault", "behaviour", "latest"), [("throttle", "too_fast", 2.5), ("spin", "spins", 1.5)]
)
def test_motors_that_stick_stop_the_robot(fault: str, behaviour: str, latest: float) -> None:
    """As soon as the ramp has passed the limit, and 0.3 s more."""
    robot = Robot()
    robot.drive(6.0)
    robot.base.fault = fault
    robot.drive(9.0)
    when, why = robot.stops()[0]
    assert why == behaviour
    assert 0.3 < when - 6.0 < latest


def test_pilot_that_goes_astray_is_stopped_at_the_edge_of_the_yard() -> None:
    """Long before it comes to a wall."""
    robot = Robot()
    robot.drive(2.5)
    robot.astray = True
    robot.drive(8.0)
    (when, why), *_ = robot.stops()
    assert why == "outside"
    outside = [line for line in robot.lines if float(json.loads(line)["t"]) == when]
    places = [json.loads(line)["data"] for line in outside if '"/odometry"' in line]
    assert max(abs(places[0]["pose.pose.position.x"]), abs(places[0]["pose.pose.position.y"])) > 1.2
    assert not robot.base.bumper()


@pytest.mark.parametrize("fault", ["throttle", "spin"])
def test_motors_without_power_end_what_no_command_can(fault: str) -> None:
    """The robot stands within half a second."""
    robot = Robot()
    robot.drive(6.0)
    robot.base.fault = fault
    robot.drive(8.0)
    assert robot.base.moves()
    robot.base.motors_off = True
    robot.drive(8.5)
    assert not robot.base.moves()


def test_driver_stands_when_commands_cease() -> None:
    """0.6 s after the last one it begins to, by its ramp."""
    robot = base.Base()
    robot.command(0.25, 0.0, 0.0)
    for cycle in range(1, 200):
        robot.advance(cycle * PERIOD, PERIOD)
        if cycle * PERIOD <= 0.6:
            at_timeout = robot.forward
        if cycle == 100:  # at 2 s, as its description says
            assert robot.forward == pytest.approx(0.0, abs=1e-9)
    assert at_timeout == pytest.approx(0.18)


@pytest.mark.parametrize("command", [(math.nan, 0.0), (0.2, math.inf)])
def test_command_that_is_no_number_is_one_to_stand(command: tuple[float, float]) -> None:
    """Both of its parts."""
    robot = base.Base()
    robot.command(*command, 0.0)
    robot.advance(PERIOD, PERIOD)
    assert (robot.forward, robot.turn) == (0.0, 0.0)


def test_encoders_and_stamps_that_begin_anew_do_not_move_the_robot() -> None:
    """The odometry follows the base for two minutes, over several turns of each counter."""
    robot = base.Base()
    driver = odometry.DeadReckoning()
    driver.count(*robot.counters(), 0)
    wrapped = 0
    for cycle in range(1, 6001):
        before = robot.counters()[0]
        robot.command(0.3, 0.25, cycle * PERIOD)
        robot.x = robot.y = 0.0  # the room is too small for two minutes
        robot.advance(cycle * PERIOD, PERIOD)
        wrapped += robot.counters()[0] < before
        assert driver.count(*robot.counters(), cycle * 20 % base.COUNTER)
        assert abs(driver.forward - robot.forward) < 0.01
    assert wrapped > 3
    assert math.hypot(driver.x, driver.y) < 2.5, "a circle of 1.2 m"


def test_odometry_waits_for_time_to_pass() -> None:
    """Two states at one time have no speed."""
    driver = odometry.DeadReckoning()
    assert not driver.count(0, 0, 65_530)
    assert not driver.count(10, 10, 65_530)
    assert driver.count(20, 20, 14)  # 20 ms later
    assert driver.forward == pytest.approx(20 * odometry.WAY / 0.02)


@pytest.mark.parametrize(
    ("yaw", "touched"),
    [(0.0, base.MIDDLE), (-0.8, base.LEFT), (0.8, base.RIGHT), (math.pi, 0)],
)
def test_bumper_shows_which_of_its_parts_is_at_a_wall(yaw: float, touched: int) -> None:
    """The wall is ahead in x; the back of the robot has no bumper."""
    assert base.Base(x=base.WALL - base.BODY_RADIUS, yaw=yaw).bumper() == touched


def test_walls_hold_the_robot() -> None:
    """Its wheels turn on."""
    robot = base.Base()
    for cycle in range(1000):
        robot.command(0.3, 0.0, cycle * PERIOD)
        robot.advance(cycle * PERIOD, PERIOD)
    assert robot.x == base.WALL - base.BODY_RADIUS
    assert robot.left * base.WHEEL_RADIUS > 4.0
