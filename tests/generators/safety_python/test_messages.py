"""The fields that the safety node reads and writes, on rclpy's own messages."""

from __future__ import annotations

import math
from typing import Any

import pytest

from deros.generators.safety_python.messages import is_stamped, literal, reading
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType

diagnostic_msgs = pytest.importorskip("diagnostic_msgs.msg")
sensor_msgs = pytest.importorskip("sensor_msgs.msg")

STORE = InterfaceStore()


def read(msg: Any, *path: str | int) -> Any:
    """Evaluate the expression for a field of ``msg``, as the generated node does."""
    package = type(msg).__module__.partition(".")[0]
    text = reading(STORE, InterfaceType(package, "msg", type(msg).__name__), path)
    return eval(text, {"msg": msg, "math": math})


def test_numbers_come_out_as_pythons_own() -> None:
    """Arrays of fixed length are NumPy in rclpy; single precision would spoil comparisons."""
    msg = sensor_msgs.Imu()
    msg.orientation_covariance[4] = 0.1
    element = read(msg, "orientation_covariance", 4)
    assert (type(element), element) == (float, 0.1)
    assert type(read(msg, "orientation_covariance")) is list
    assert read(msg, "orientation", "w") == 1.0


def test_a_byte_comes_out_as_an_integer() -> None:
    """``byte`` is a bytes object in rclpy, but a number in the rules."""
    msg = diagnostic_msgs.DiagnosticStatus(level=diagnostic_msgs.DiagnosticStatus.ERROR)
    assert read(msg, "level") == 2
    array = diagnostic_msgs.DiagnosticArray(status=[msg])
    assert read(array, "status", 0, "level") == 2


def test_an_element_that_is_not_there_is_nan() -> None:
    """The monitor takes NaN for an index that the message's array does not have."""
    msg = sensor_msgs.JointState(position=[1.0, 2.0])
    assert read(msg, "position", 1) == 2.0
    assert math.isnan(read(msg, "position", 2))
    array = diagnostic_msgs.DiagnosticArray()
    assert math.isnan(read(array, "status", 0, "level"))
    assert math.isnan(read(array, "status", 0, "values", 0, "key"))


def test_arrays_of_any_length_are_handed_on() -> None:
    """They are sequences of Python's own numbers already."""
    msg = sensor_msgs.LaserScan(ranges=[1.5, 2.5])
    assert list(read(msg, "ranges")) == [1.5, 2.5]
    assert type(read(msg, "ranges")[0]) is float


@pytest.mark.parametrize(
    ("base", "value", "text"),
    [
        ("float64", 1, "1.0"),
        ("float32", math.inf, "float('inf')"),
        ("uint8", 3, "3"),
        ("byte", 2, "b'\\x02'"),
        ("bool", True, "True"),
        ("string", "it's", '"it\'s"'),
    ],
)
def test_literals_are_those_that_rclpy_takes(base: str, value: Any, text: str) -> None:
    """A float is not written as an int, and a byte is not, either."""
    assert literal(FieldType(base), value) == text


def test_messages_with_a_header_are_stamped() -> None:
    """Only a header of std_msgs counts."""
    assert is_stamped(STORE, InterfaceType("geometry_msgs", "msg", "TwistStamped"))
    assert not is_stamped(STORE, InterfaceType("geometry_msgs", "msg", "Twist"))
    assert not is_stamped(STORE, InterfaceType("no_such", "msg", "Thing"))
