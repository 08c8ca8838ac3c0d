"""Cells: which values have one, and that no comparison changes within it, and one changes at it."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from deros.generators.monitor.python.interface import MONITOR
from deros.generators.monitor.python.slots import CELL
from tests.support.python_snippets import texts_of

_SPACE: dict[str, Callable[..., tuple[float, float]]] = {}
exec(f"import math\nNAN = math.nan\n{CELL}", _SPACE)
cell = _SPACE["cell"]

numbers = st.floats(allow_nan=False, width=64) | st.integers(-3, 3).map(float)
bounds = st.lists(numbers, unique=True, max_size=5).map(sorted)


def _compared(value: float, limits: list[float]) -> list[tuple[bool, bool]]:
    """Return how a value compares with each of some limits; the other comparisons follow."""
    return [(value < limit, value > limit) for limit in limits]


@given(numbers, bounds, numbers)
@example(-0.0, [0.0], 0.0)
@example(math.inf, [math.inf], 0.0)
def test_numbers_are_in_a_cell_that_compare_as_its_value_does(
    value: float, limits: list[float], other: float
) -> None:
    """Each number is inside if, and only if, all its comparisons are those of the value."""
    low, high = cell(value, *limits)
    assert low <= value <= high
    next_ones = [low, high, math.nextafter(low, -math.inf), math.nextafter(high, math.inf)]
    for each in (other, *limits, *next_ones):
        assert (low <= each <= high) == (_compared(each, limits) == _compared(value, limits))


@given(bounds, numbers)
def test_nothing_is_in_the_cell_of_an_unknown_number(limits: list[float], other: float) -> None:
    """After NaN every number is news, and NaN itself is so always."""
    low, high = cell(math.nan, *limits)
    assert not low <= math.nan <= high
    assert not low <= other <= high


SPEED = "input v = topic /odom.twist.twist.linear.x timeout 1 sec "
ACTS = "if e.r then { stop; };"


@pytest.mark.parametrize(
    ("rules", "has_cell"),
    [
        (f"{SPEED} entity e {{ r: v > 1 or v not in [-2, 3); }}", True),
        (f"{SPEED} entity e {{ r: v.rate() > 1 or v.rate().unknown(); }}", True),
        (f"{SPEED} entity e {{ r: v > v.previous(); }}", False),
        (f"{SPEED} entity e {{ r: v * v > 2; }}", False),
        (f"const v_max = 2 m/s tunable in [1, 3] m/s {SPEED} entity e {{ r: v > v_max; }}", False),
        (f"{SPEED} entity e {{ r: v > 1; s: v.age() > 0.1 sec; }}", False),
        (f"{SPEED} entity e {{ r: v > 1; s: v.frequency(5) < 2 Hz; }}", False),
        ("input v = topic /mode.data entity e { r: v > 3; }", False),
    ],
)
def test_values_compared_with_constants_have_cells(rules: str, *, has_cell: bool) -> None:
    """What else a value is read for may change with each of its numbers, or with each message."""
    text = texts_of(f"action stop; {rules} {ACTS}")[MONITOR]
    assert ("cell(" in text) == has_cell


def test_stored_numbers_are_those_of_python() -> None:
    """Those of numpy would compare with the ends of a cell as float32."""
    rules = (
        "v.max() > 0.4 or v.min() > 0.3 or v[1] > 0.2 or "
        "w.nearest(-1 rad, 1 rad) < 0.4 or w.blind(-1 rad, 1 rad) > 0.2"
    )
    inputs = "input v = topic /scan.ranges input w = topic /scan"
    space: dict[str, Any] = {"__name__": "monitor"}
    rules_of = f"action stop; {inputs} entity e {{ r: {rules}; }} {ACTS}"
    exec(texts_of(rules_of)[MONITOR], space)
    monitor = space["Monitor"](0, lambda _: None)
    handler = monitor.on_scan
    fields: dict[str, Any] = {"ranges": np.array([0.5, 0.25, 2.0], np.float32)}
    fields |= {"angle_min": -0.5, "angle_increment": 0.5, "range_min": 0.1, "range_max": 9.0}
    given = {name: fields.get(name, 0.25) for name in inspect.signature(handler).parameters}
    handler(**{**given, "t": 1})
    stored = {each: getattr(monitor, each) for each in monitor.__slots__}
    numbers = {name: each for name, each in stored.items() if name.startswith(("_v", "_w"))}
    assert not [name for name, each in numbers.items() if isinstance(each, np.generic)]
    assert (monitor._v_max, monitor._w_nearest) == (2.0, 0.25)
