"""Message fields written by Python nodes."""

from __future__ import annotations

import math
from typing import Any

import pytest

from deros.generators.text.python_fields import literal
from deros.interfaces.types import FieldType


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
def test_literals_have_the_type_that_rclpy_expects(base: str, value: Any, text: str) -> None:
    """A float is not written as an int, and neither is a byte."""
    assert literal(FieldType(base), value) == text
