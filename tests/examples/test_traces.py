"""Rules of the examples on traces, through the reference engine: expected events and times."""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import pytest

from deros.diagnostics import SourceFile
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.engine.engine import Engine
from deros.rules.program.ir import Program
from deros.simulation.simulate import seconds, simulate
from deros.simulation.trace import nanoseconds, read_trace
from tests.support.examples import EXAMPLES

STORE = InterfaceStore()
SPEED, SCAN, IMU = "/odometry", "/scan", "/imu"
STOP, MOTOR_STOP, LOW_SPEED = "stop", "motor_stop", "low_speed"


@functools.cache
def program(path: str) -> Program:
    """Return the program of the rules of an example."""
    rules = Repository().load(str(EXAMPLES / path)).model
    assert isinstance(rules, Rules)
    built = build(rules, STORE)
    assert built.program is not None
    return built.program


@dataclass
class Scene:
    """A robot with sensors that publish ten times a second, and changes of their messages.

    ``changes`` are times, topics and the fields from then on; ``None`` silences the topic.
    """

    rules: str
    normal: Mapping[str, Mapping[str, Any]]
    changes: list[tuple[float, str, Mapping[str, Any] | None]] = field(default_factory=list)
    period_ms: int = 100

    def at(self, time: float, topic: str, fields: Mapping[str, Any] | None) -> Scene:
        """Return the scene with another change, which has its own message."""
        return Scene(
            self.rules, self.normal, [*self.changes, (time, topic, fields)], self.period_ms
        )

    def _messages(self, until: float) -> Iterator[tuple[int, str, Mapping[str, Any]]]:
        beats = range(0, round(until * 1000), self.period_ms)
        for topic, fields in self.normal.items():
            own = sorted((round(t * 1000), data) for t, name, data in self.changes if name == topic)
            for ms in sorted({*beats, *(t for t, _ in own)}):
                current: Mapping[str, Any] | None = fields
                for time, data in own:
                    current = data if time <= ms else current
                if current is not None:
                    yield ms, topic, current

    def play(self, until: float) -> list[tuple[float, str, str]]:
        """Return the events: time in s, ``trigger``, ``reset`` or ``refused``, action."""
        lines = [
            json.dumps({"t": f"{ms / 1000:.3f}", "topic": topic, "data": dict(fields)})
            for ms, topic, fields in sorted(self._messages(until), key=lambda m: m[0])
        ]
        source = SourceFile("trace.jsonl", "\n".join(lines))
        trace = read_trace(source, program(self.rules), STORE)
        assert trace.diagnostics == ()
        end = nanoseconds(f"{until:.3f}")
        events = simulate(Engine(program(self.rules)), trace.messages, end)
        return [
            (float(seconds(e.t_ns)), e.kind, e.action) for e in events if e.action != "log_state"
        ]

    def triggers(self, until: float) -> list[tuple[float, str]]:
        """Return the triggered actions with their times."""
        return [(time, action) for time, kind, action in self.play(until) if kind == "trigger"]


def speed(value: float) -> dict[str, Any]:
    """Return the fields of an odometry message."""
    return {"twist.twist.linear.x": value}


def tilt(roll: float = 0.0, pitch: float = 0.0) -> dict[str, Any]:
    """Return the fields of an IMU message for angles in degrees, of which one is zero."""
    half_roll, half_pitch = math.radians(roll) / 2, math.radians(pitch) / 2
    return {
        "orientation.x": math.sin(half_roll),
        "orientation.y": math.sin(half_pitch),
        "orientation.w": math.cos(half_roll) * math.cos(half_pitch),
    }


def scan(ahead: float | str, beside: float | str = "Infinity") -> dict[str, Any]:
    """Return a scan of five beams, 45 degrees apart."""
    return {
        "angle_min": -math.pi / 2,
        "angle_max": math.pi / 2,
        "angle_increment": math.pi / 4,
        "range_min": 0.05,
        "range_max": 25.0,
        "ranges": [beside, beside, ahead, beside, beside],
    }


FEEDING = Scene(
    "feeding_robot/feeding_robot.deros",
    {
        IMU: tilt(),
        SPEED: speed(0.4),
        SCAN: scan("Infinity"),
        "/plc/keep_alive": {"data": 1},
        "/plc/mode": {"data": 2},
        "/plc/stop_button": {"data": False},
        "/plc/front_bumper": {"data": False},
        "/plc/rear_bumper": {"data": False},
        "/plc/feeding_arm": {"data": False},
        "/plc/engine_running": {"data": True},
        "/controller/keep_alive": {"data": 1},
    },
)
ENGINE_STOP = [MOTOR_STOP, STOP]


def actions_at(scene: Scene, until: float) -> dict[float, list[str]]:
    """Return the triggered actions by time."""
    by_time: dict[float, list[str]] = {}
    for time, action in scene.triggers(until):
        by_time.setdefault(time, []).append(action)
    return by_time


@pytest.mark.essential
def test_normal_operation_triggers_nothing() -> None:
    """Ten seconds of cruising have no events."""
    assert FEEDING.play(10.0) == []


@pytest.mark.parametrize(
    ("case", "scene", "until", "expected"),
    [
        (1, FEEDING.at(2.0, SCAN, scan(3.5)), 4.0, {2.0: [LOW_SPEED]}),
        (2, FEEDING.at(2.0, SCAN, scan(1.5)), 4.0, {2.0: [STOP]}),
        (3, FEEDING.at(2.0, SCAN, scan(0.6)), 4.0, {2.0: [STOP]}),
        (4, FEEDING.at(2.0, "/plc/front_bumper", {"data": True}), 4.0, {2.0: ENGINE_STOP}),
        (5, FEEDING.at(2.0, "/plc/rear_bumper", {"data": True}), 4.0, {2.0: ENGINE_STOP}),
        (6, FEEDING.at(2.0, "/plc/feeding_arm", {"data": True}), 4.0, {2.0: ENGINE_STOP}),
        (7, FEEDING.at(2.0, "/plc/stop_button", {"data": True}), 4.0, {2.0: ENGINE_STOP}),
        (8, FEEDING.at(2.0, SPEED, speed(0.75)).at(5.999, SPEED, speed(0.4)), 9.0, {}),
        (9, FEEDING.at(2.0, SPEED, speed(0.75)), 7.9, {6.0: ENGINE_STOP}),
        (10, FEEDING.at(2.0, SPEED, speed(1.001)), 4.0, {2.0: ENGINE_STOP}),
        (11, FEEDING.at(2.0, SPEED, speed(-0.32)).at(3.999, SPEED, speed(0.4)), 6.0, {}),
        (12, FEEDING.at(2.0, SPEED, speed(-0.32)), 6.0, {4.0: ENGINE_STOP}),
        (13, FEEDING.at(2.0, SPEED, speed(-0.401)), 3.0, {2.0: ENGINE_STOP}),
    ],
)
def test_demo_cases_trigger_exactly_the_expected_actions(
    case: int, scene: Scene, until: float, expected: dict[float, list[str]]
) -> None:
    """Each case acts exactly when it is due, and nothing else happens."""
    assert actions_at(scene, until) == expected, f"case {case}"


def test_ten_minutes_at_rest_stop_the_engine_to_the_nanosecond() -> None:
    """Case 15: not earlier, and counted again after any motion."""
    standing = Scene(FEEDING.rules, FEEDING.normal, period_ms=450).at(0.0, SPEED, speed(0.0))
    moved = standing.at(10.0, SPEED, speed(0.4)).at(11.0, SPEED, speed(0.0))
    assert actions_at(moved, 611.5) == {611.0: ENGINE_STOP}


@pytest.mark.parametrize("angle", ["roll", "pitch"])
@pytest.mark.parametrize("sign", [-1, 1])
def test_small_excess_tilt_is_tolerated_for_four_seconds(angle: str, sign: int) -> None:
    """8 degrees may be exceeded for 4 s, 10 degrees never."""
    leaning = FEEDING.at(2.0, IMU, tilt(**{angle: sign * 8.5}))
    assert actions_at(leaning, 7.0) == {6.0: ENGINE_STOP}
    righted = leaning.at(5.9, IMU, tilt())
    assert actions_at(righted, 9.0) == {}
    falling = FEEDING.at(2.0, IMU, tilt(**{angle: sign * 10.5}))
    assert actions_at(falling, 3.0) == {2.0: ENGINE_STOP}


def test_objects_beside_the_path_are_not_obstacles() -> None:
    """The zones are ahead: a wall half a metre to the side is passed."""
    assert FEEDING.at(2.0, SCAN, scan("Infinity", beside=0.5)).play(4.0) == []


def test_slight_overspeed_slows_the_robot_down_after_six_seconds() -> None:
    """A speed slightly above nominal causes low speed only."""
    assert actions_at(FEEDING.at(2.0, SPEED, speed(0.49)), 9.0) == {8.0: [LOW_SPEED]}


@pytest.mark.parametrize("topic", sorted(FEEDING.normal))
def test_silence_of_any_input_is_detected(topic: str) -> None:
    """Half a second after the last message of any sensor the robot is stopped."""
    silent = FEEDING.at(2.05, topic, None)
    assert STOP in actions_at(silent, 4.0)[2.5]


def test_nan_counts_as_silence() -> None:
    """NaN odometry stops the robot like missing odometry."""
    assert actions_at(FEEDING.at(2.05, SPEED, speed(math.nan)), 4.0)[2.5] == [STOP]


@pytest.mark.essential
def test_manual_mode_suspends_automatic_limits() -> None:
    """In manual mode neither bumpers nor speed act, but a fall of the robot does."""
    manual = FEEDING.at(0.0, "/plc/mode", {"data": 0})
    assert manual.triggers(1.0) == [(0.0, "controllerOk")]
    busy = manual.at(1.0, "/plc/front_bumper", {"data": True}).at(1.0, SPEED, speed(1.4))
    assert [action for _, action in busy.triggers(4.0)] == ["controllerOk"]
    falling = manual.at(1.0, IMU, tilt(roll=12.0))
    assert actions_at(falling, 2.0)[1.0] == ENGINE_STOP


def test_manual_mode_resets_stop_and_low_speed_but_not_the_motor_stop() -> None:
    """The latched motor stop needs its own reset."""
    scene = (
        FEEDING.at(1.0, SCAN, scan(3.0))
        .at(1.5, "/plc/front_bumper", {"data": True})
        .at(2.0, "/plc/front_bumper", {"data": False})
        .at(3.0, "/plc/mode", {"data": 0})
    )
    resets = [(time, action) for time, kind, action in scene.play(4.0) if kind == "reset"]
    assert resets == [(3.0, LOW_SPEED), (3.0, STOP)]


INTELLIGENT = Scene("intelligent_one/intelligent_one.deros", {SPEED: speed(0.4), IMU: tilt()})


def test_intelligent_one_tolerates_overspeed_for_two_seconds() -> None:
    """Then it stops; a nanosecond less and it does not."""
    fast = INTELLIGENT.at(1.0, SPEED, speed(0.51))
    assert fast.triggers(5.0) == [(3.0, STOP)]
    assert fast.at(2.999, SPEED, speed(0.4)).triggers(5.0) == []


@pytest.mark.parametrize("angle", ["roll", "pitch"])
def test_intelligent_one_tolerates_a_tilt_for_0_4_seconds(angle: str) -> None:
    """This is long enough to distinguish noise from a fall."""
    tilted = INTELLIGENT.at(1.0, IMU, tilt(**{angle: 10.5}))
    assert tilted.triggers(3.0) == [(1.4, STOP)]
    assert tilted.at(1.399, IMU, tilt()).triggers(3.0) == []


@pytest.mark.parametrize("topic", [SPEED, IMU])
def test_intelligent_one_stops_when_a_sensor_is_silent(topic: str) -> None:
    """The stop comes half a second after the last message."""
    assert INTELLIGENT.at(1.05, topic, None).triggers(3.0) == [(1.5, STOP)]
