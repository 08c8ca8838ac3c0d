"""The fields that the safety node writes."""

from __future__ import annotations

import math
from typing import Any

import pytest

from deros.generators.safety_python.messages import is_stamped, literal
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType

STORE = InterfaceStore()


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
