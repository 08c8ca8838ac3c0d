"""The feeding robot's mission, PLC and rules on its physics, in simulated time and without ROS."""

from __future__ import annotations

import math
import random
from array import array

import pytest

from tests.support.examples import example_module
from tests.support.judge import Judge, Verdict, each_of_20_robots

pytest.importorskip("mujoco", reason="the extra 'physics' is not installed")

example_module("frobit", "frobit_drive.differential")  # which the odometry sums up with
boards = example_module("physics", "wheeled_physics.feeding_robot_board")
measures = example_module("physics", "wheeled_physics.measures")
arbitration = example_module("feeding_robot", "feeding_robot_actuators.arbitration")
missions = example_module("feeding_robot", "feeding_robot_mission.mission")
plc = example_module("feeding_robot", "feeding_robot_plc.logic")
LIDAR = measures.FEEDING_ROBOT.lidar
PERIOD = 0.02
SLOW_CYCLES = 5
FINDINGS = ("low_speed", "stop", "motor_stop")

Finding = tuple[str, float, float]
"""The behaviour that acts, and the least and the most seconds that it takes."""

SEEN: dict[str, dict[str, Finding]] = {
    "left_encoder": {"low_speed": ("warn", 0.5, 0.8), "stop": ("hold", 1.2, 1.6)},
    "right_encoder": {"low_speed": ("warn", 0.5, 0.8), "stop": ("hold", 1.2, 1.6)},
    "left_motor": {"low_speed": ("warn", 1.9, 2.6), "stop": ("hold", 7.6, 8.8)},
    "right_motor": {"low_speed": ("warn", 1.9, 2.6), "stop": ("hold", 7.6, 8.8)},
    "left_runaway": {
        "low_speed": ("warn", 0.4, 0.7),
        "stop": ("hold", 1.1, 1.5),
        "motor_stop": ("too_fast", 4.05, 4.2),
    },
    "right_runaway": {
        "low_speed": ("warn", 0.4, 0.7),
        "stop": ("hold", 1.1, 1.5),
        "motor_stop": ("too_fast", 4.05, 4.2),
    },
    "runaway": {
        "stop": ("much_too_fast", 0.25, 0.45),
        "motor_stop": ("much_too_fast", 0.25, 0.45),
    },
    "gyro": {"stop": ("tilted", 0.7, 0.95), "motor_stop": ("tilted", 0.7, 0.95)},
    "line": {
        "stop": ("controller_lost", 0.45, 0.55),
        "motor_stop": ("behaviour_", 0.45, 0.55),  # without a name, within it
    },
    "lidar_line": {"stop": ("sensor_lost", 0.35, 0.55)},
    "lidar_dirt": {"stop": ("sensor_lost", -0.01, 0.12)},
    "obstacle": {"low_speed": ("warn", 2.0, 3.2), "stop": ("hold", 11.5, 13.5)},
    "person": {"stop": ("hold", -0.01, 0.12)},
    "crate": {"stop": ("bumped", 2.2, 3.2), "motor_stop": ("bumped", 2.2, 3.2)},
}
"""
What finds each fault. It takes a cut motor or encoder for the wall that the robot turns to; a
robot that is to halt has as many seconds more for it.
"""

UNSEEN = ("left_throttle", "right_throttle", "caster", "battery", "lidar_dark", "lidar_stuck")
"""The robot drives on along its alley as it should, or nearly so."""

RESTLESS = ("left_encoder", "right_encoder")
"""The wheel without an encoder turns on, whatever is commanded."""


class Loop:
    """The robot, its mission, gate and PLC every 20 ms, and a farmer who starts it."""

    def __init__(self, seed: int = 0) -> None:
        """Stand in the alley, in manual mode; the key is turned."""
        self.board = boards.FeedingRobotBoard(seed)
        self.robot = self.board.robot
        self.judge = Judge("feeding_robot")
        self.mission = missions.Mission(0.4, 0.6)
        self.arbiter = arbitration.Arbiter(arbitration.Limits(boards.TOP_SPEED, 0.3), 0.0)
        self.plc = plc.PlcLogic(plc.Watchdog(0.5, 0.0), plc.Watchdog(0.5, 0.0), key_turned=True)
        self.cycles = 0
        self.fastest = self.most_tilted = 0.0
        self.touches: list[float] = []

    def drive(self, duration: float) -> None:
        """Drive along the alley for some seconds."""
        for _ in range(round(duration / PERIOD)):
            self.cycle()

    def cycle(self) -> None:
        """Drive so for a cycle; half a second after the start the farmer lets it."""
        now = self.robot.time
        if now >= 0.5:
            self.plc.mode = plc.Mode.AUTOMATIC
        if self.robot.heard:
            self._report(now)
        if self.cycles % SLOW_CYCLES == 0:
            self._report_slowly(now)
        self.board.pedal(self.arbiter.decide(now)[0])
        self.board.steer(self.arbiter.steering)
        self._run_plc(now)
        self.board.advance(PERIOD)
        self.judge.advance(self.robot.time)
        self.cycles += 1
        self.fastest = max(self.fastest, self.robot.speed())
        self.most_tilted = max(self.most_tilted, self.tilt())

    def active(self, action: str) -> bool:
        """Return whether the rules have triggered an action; nobody resets any but at the start."""
        return any(each.action == action for each in self.judge.verdicts)

    def found(self) -> list[Verdict]:
        """Return the actions against a danger, in their order."""
        return [each for each in self.judge.verdicts if each.action in FINDINGS]

    def first(self, action: str) -> Verdict | None:
        """Return when and why an action was triggered first."""
        return next((each for each in self.judge.verdicts if each.action == action), None)

    def tilt(self) -> float:
        """Return the greater of roll and pitch, in rad and without a sign, as it truly is."""
        x, y, z, w = self.robot.orientation()
        roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
        return max(abs(roll), abs(math.asin(2 * (w * y - z * x))))

    def _report(self, now: float) -> None:
        """Let the driver report, and the mission answer through the gate."""
        attitude = zip("xyzw", self.robot.imu(), strict=True)
        self.judge.hear(now, "/imu", {f"orientation.{axis}": part for axis, part in attitude})
        if not self.board.reckon():
            return
        self.judge.hear(now, "/odometry", {"twist.twist.linear.x": self.board.motion[0]})
        allowed = (
            self.active("controllerOk")
            and not self.active("stop")
            and self.plc.mode is plc.Mode.AUTOMATIC
        )
        pose = self.board.pose
        command = self.mission.plan(allowed, pose.y, pose.yaw, PERIOD)
        self.judge.hear(now, "/controller/keep_alive", {"data": self.cycles})
        self.plc.controller.last = now
        most = 0.0 if self.active("stop") else 0.2 if self.active("low_speed") else math.inf
        self.arbiter.command(min(command.speed, most), command.steering, now)

    def _report_slowly(self, now: float) -> None:
        """Let scanner and PLC report."""
        ranges = self.robot.scan()
        if ranges is not None:
            scan = {
                "ranges": array("f", ranges).tolist(),
                "angle_min": -LIDAR.half_angle,
                "angle_increment": 2 * LIDAR.half_angle / (LIDAR.beams - 1),
                "range_min": LIDAR.range_min,
                "range_max": LIDAR.range_max,
            }
            self.judge.hear(now, "/scan", scan)
        pressed = self.plc.pressed
        reported = {
            "mode": int(self.plc.mode),
            **{each.name.lower(): each in pressed for each in plc.Contact},
            "engine_running": self.board.engine_speed > 10.0,
            "keep_alive": self.cycles,
        }
        for name, value in reported.items():
            self.judge.hear(now, f"/plc/{name}", {"data": value})

    def _run_plc(self, now: float) -> None:
        """Let the PLC see bumpers, safety node and mission, and hold the engine."""
        bumpers = plc.Contact.FRONT_BUMPER, plc.Contact.REAR_BUMPER
        touching = zip(bumpers, self.board.bumpers(), strict=True)
        self.plc.pressed = {each for each, touches in touching if touches}
        if self.plc.pressed:
            self.touches.append(now)
        self.plc.safety_node.last = now
        self.plc.motor_stop = self.active("motor_stop")
        self.arbiter.mode = int(self.plc.mode)
        self.plc.supervise(now)
        if self.plc.engine_enabled != (self.board.engine_speed > 0.0):
            self.board.engine(self.plc.engine_enabled)


def with_fault(fault: str, seed: int, duration: float = 4.0) -> tuple[Loop, float]:
    """Return a drive along the alley with a fault, and the time (s) of the fault."""
    loop = Loop(seed)
    loop.drive(3.0 + PERIOD * random.Random(seed).randrange(50))
    assert loop.found() == []
    began = loop.robot.time
    loop.robot.fail(fault)
    loop.drive(duration)
    return loop, began


def test_every_fault_is_tried() -> None:
    """Those that the rules see, those that they do not, and the ramp, which tilts."""
    assert {*SEEN, *UNSEEN, "ramp"} == {*Loop().robot.faults}


@each_of_20_robots
@pytest.mark.parametrize("fault", SEEN)
def test_rules_find_a_fault_in_time_in_each_of_20_robots(fault: str, seeds: range) -> None:
    """Robots, noise and the time of the fault differ by the seed; nothing else is triggered."""
    latest = max(most for _, _, most in SEEN[fault].values())
    for seed in seeds:
        loop, began = with_fault(fault, seed, latest + 2.0)
        assert {each.action for each in loop.found()} == {*SEEN[fault]}, f"seed {seed}"
        for action, (behaviour, least, most) in SEEN[fault].items():
            first = loop.first(action)
            assert first is not None
            assert (first.behaviour or "").startswith(behaviour), f"seed {seed}"
            assert least < first.time - began < most, f"seed {seed}"
        if fault not in RESTLESS:
            assert loop.robot.speed() < 0.01, f"seed {seed}"


@each_of_20_robots
def test_ramp_below_the_scanner_ends_in_a_motor_stop(seeds: range) -> None:
    """Physics tilts the robot; at the 10 degrees of the rule, less noise, it is on its brakes."""
    for seed in seeds:
        loop, began = with_fault("ramp", seed, 10.5)
        first = loop.first("motor_stop")
        assert first is not None, f"seed {seed}"
        assert first.behaviour == "tilted", f"seed {seed}"
        assert 8.5 < first.time - began < 9.2, f"seed {seed}"
        assert math.radians(9.0) < loop.most_tilted < math.radians(10.5), f"seed {seed}"
        assert loop.tilt() == pytest.approx(loop.most_tilted, abs=0.02), f"seed {seed}"
        assert loop.robot.speed() < 0.01, f"seed {seed}"


@each_of_20_robots
@pytest.mark.parametrize("fault", UNSEEN)
def test_fault_that_breaks_no_rule_is_not_found(fault: str, seeds: range) -> None:
    """The robot goes on, no faster than it may, and touches nothing."""
    for seed in seeds:
        loop, _ = with_fault(fault, seed, 8.0)
        assert loop.found() == [], f"seed {seed}"
        assert 0.3 < loop.robot.speed() <= loop.fastest < 0.5, f"seed {seed}"
        assert loop.touches == [], f"seed {seed}"


@each_of_20_robots
@pytest.mark.parametrize("fault", RESTLESS)
def test_wheel_without_an_encoder_turns_on_in_spite_of_the_stop(fault: str, seeds: range) -> None:
    """A limit that the README states: the odometry shows a robot that stands, so no motor stop."""
    for seed in seeds:
        loop, _ = with_fault(fault, seed, 10.0)
        assert loop.active("stop"), f"seed {seed}"
        assert not loop.active("motor_stop"), f"seed {seed}"
        assert abs(loop.board.motion[0]) < 0.05, f"seed {seed}"
        assert loop.robot.speed() > 0.5, f"seed {seed}"


@pytest.mark.slow
def test_nothing_stops_a_robot_in_ten_minutes_of_its_alley() -> None:
    """Noise of scanner and IMU, slip and delay are within what the rules allow, for 230 m."""
    loop = Loop(1)
    loop.drive(600.0)
    assert loop.found() == []
    assert loop.touches == []
    x, y = loop.robot.position()
    assert x > 230.0
    assert abs(y) < 0.5


def test_same_seed_gives_the_same_messages() -> None:
    """Byte for byte, with something in the way; another seed is another robot."""
    first, again, other = (with_fault("crate", seed)[0].judge.lines for seed in (3, 3, 4))
    assert first == again
    assert first != other


@each_of_20_robots
@pytest.mark.parametrize("fault", ["lidar_dark", "lidar_stuck"])
def test_robot_whose_scanner_shows_a_free_way_is_stopped_by_its_bumper(
    fault: str, seeds: range
) -> None:
    """A limit that the README states: it drives into the person, and stands within 0.2 s."""
    for seed in seeds:
        loop, began = with_fault(fault, seed, PERIOD)
        loop.robot.fail("person")
        loop.drive(5.0)
        first = loop.found()[0]
        assert first.behaviour == "bumped", f"seed {seed}"
        assert 2.5 < loop.touches[0] - began < first.time - began < 4.0, f"seed {seed}"
        assert first.time - loop.touches[0] < 0.15, f"seed {seed}"
        assert loop.robot.speed() < 0.01, f"seed {seed}"


@each_of_20_robots
@pytest.mark.parametrize("fault", ["left_throttle", "right_throttle"])
def test_stuck_throttle_turns_the_robot_on_in_spite_of_the_stop(fault: str, seeds: range) -> None:
    """A limit that the README states: it is slow enough for all rules, so no motor stop."""
    for seed in seeds:
        loop, _ = with_fault(fault, seed, PERIOD)
        loop.robot.fail("person")
        loop.drive(5.0)
        assert loop.active("stop"), f"seed {seed}"
        assert not loop.active("motor_stop"), f"seed {seed}"
        assert 0.1 < loop.robot.speed() < 0.3, f"seed {seed}"
