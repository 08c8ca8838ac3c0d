"""Commands as plain data: the zero of a message of any type, and fields without limits."""

from __future__ import annotations

from deros.rules.gates.gate_engine import GateEngine
from deros.rules.program.commands import Message
from deros.rules.program.ir import Gate, GateLine, Source, Stop
from tests.support.gate_driver import MS, Driver, at, twist
from tests.support.gates import ACTIONS, STORE, message_type, span


def zero_after(kind: str, command: Message, t_ms: float = 1500) -> Message:
    """Return the zero that a stop publishes after ``command``."""
    gate = zeroing(kind)
    gate.state(0, "/stop", {"data": False})
    (passed,) = gate.command(1, command)
    assert passed.message is command
    (output,) = gate.state(at(t_ms), "/stop", {"data": True})
    return output.message


def zeroing(kind: str) -> GateEngine:
    """Return a gate that stops commands of any type with zero, whether that stops them or not."""
    line = GateLine(0, None, None, (), span(2), stop=Stop())
    gate = Gate(0, (Source("/nav"),), "/command", message_type(kind), 50 * MS, (line,), span(1))
    return GateEngine(gate, ACTIONS, STORE)


def test_zero_has_the_last_frame_and_the_current_time() -> None:
    """The header has the time of the zero and the frame of the last command."""
    header = {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "base_link"}
    assert zero_after("geometry_msgs.TwistStamped", {"header": header, "twist": twist(0.5)}) == {
        "header": {"stamp": {"sec": 1, "nanosec": 500 * MS}, "frame_id": "base_link"},
        "twist": {
            "linear": {"x": 0.0, "y": 0.0, "z": 0.0},
            "angular": {"x": 0.0, "y": 0.0, "z": 0.0},
        },
    }


def test_zero_has_arrays_as_long_as_the_last_command() -> None:
    """Numbers in them are zero; joint names stay."""
    command = {
        "header": {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""},
        "name": ["left", "right"],
        "position": [],
        "velocity": [1.0, 2.0],
        "effort": [3.0],
    }
    zero = zero_after("sensor_msgs.JointState", command)
    assert {name: zero[name] for name in command if name != "header"} == {
        "name": ["left", "right"],
        "position": [],
        "velocity": [0.0, 0.0],
        "effort": [0.0],
    }


def test_zero_before_any_command_has_empty_arrays() -> None:
    """The length is not known yet."""
    (output,) = zeroing("sensor_msgs.JointState").advance(0)
    assert output.message["velocity"] == output.message["name"] == []


def test_zero_keeps_the_layout_of_an_array() -> None:
    """The layout identifies the numbers, and is not a command itself."""
    layout = {"dim": [{"label": "joint", "size": 2, "stride": 2}], "data_offset": 1}
    zero = zero_after("std_msgs.Float64MultiArray", {"layout": layout, "data": [1.0, 2.0]})
    assert zero == {"layout": layout, "data": [0.0, 0.0]}


def test_zero_of_a_quaternion_is_the_identity() -> None:
    """Four zeros would not be a rotation."""
    command = {
        "position": {"x": 1.0, "y": 2.0, "z": 3.0},
        "orientation": {"x": 1.0, "y": 0.0, "z": 0.0, "w": 0.0},
    }
    zero = zero_after("geometry_msgs.Pose", command)
    assert zero["orientation"] == {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
    assert zero["position"] == {"x": 0.0, "y": 0.0, "z": 0.0}


def test_zero_keeps_the_length_of_message_arrays() -> None:
    """The number of points stays, and each is zero, including durations."""
    stamp = {"sec": 3, "nanosec": 4}
    point = {
        "positions": [1.0],
        "velocities": [],
        "accelerations": [],
        "effort": [],
        "time_from_start": stamp,
    }
    header = {"stamp": stamp, "frame_id": ""}
    command = {"header": header, "joint_names": ["a"], "points": [point]}
    zero = zero_after("trajectory_msgs.JointTrajectory", command)
    assert zero["points"] == [
        {**point, "positions": [0.0], "time_from_start": {"sec": 0, "nanosec": 0}}
    ]


def test_zero_of_flags_is_false_and_of_integers_0() -> None:
    """Booleans are false and integers 0."""
    command = {"x_offset": 1, "y_offset": 2, "height": 3, "width": 4, "do_rectify": True}
    assert zero_after("sensor_msgs.RegionOfInterest", command) == {
        "x_offset": 0,
        "y_offset": 0,
        "height": 0,
        "width": 0,
        "do_rectify": False,
    }


def test_zero_before_any_command_has_full_fixed_arrays() -> None:
    """Their length is part of the type."""
    (output,) = zeroing("geometry_msgs.PoseWithCovariance").advance(0)
    assert output.message["covariance"] == [0.0] * 36


def test_limit_of_a_missing_element_is_ignored() -> None:
    """The existing elements are limited."""
    line = "stop: limit data[0] to [0, 1], data[3] to [0, 1];"
    gate = Driver(line, kind="std_msgs.Int32MultiArray")
    layout = {"dim": [], "data_offset": 0}
    (output,) = gate.engine.command(0, {"layout": layout, "data": [5, 5]})
    assert output.message["data"] == [1, 5]
