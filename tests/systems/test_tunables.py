"""Tunable constants of rules as written, and the parameters of safety nodes that they are."""

from __future__ import annotations

import math

import pytest

from deros.models.common import Interval
from deros.systems.flatten import flatten, nodes_of_rules
from deros.systems.tunables import in_unit_of, tunables_of
from deros.validators.system.system_nodes import check_instances
from tests.support.rules import load
from tests.systems.test_safety_instances import RULES, system_with

STRIDES = 'unit stride = 0.5 m/s\nconst a = 3 stride tunable in [1 stride, 2.5 m/s] "Speed"'
TUNED = RULES.replace("< 1 m ", "< distance ").replace(
    "input front", 'const distance = 1 m tunable in [50, 200] cm "Room"\ninput front'
)


def test_numbers_are_in_the_unit_of_the_constant() -> None:
    """The ends are converted, also from and into units of the rules."""
    (found,) = tunables_of(load(STRIDES))
    assert (found.name, found.default, found.lower, found.upper) == ("a", 3.0, 1.0, 5.0)
    assert (found.unit, found.description, found.interval) == (
        "stride",
        "Speed",
        "[1.0, 5.0] stride",
    )


def test_faulty_constants_are_left_out() -> None:
    """What is reported where the rules are compiled has no parameter."""
    assert tunables_of(load("const a = 1 tunable in [2, 3]; const b = 1")) == ()


@pytest.mark.parametrize(
    ("value", "unit", "expected"),
    [
        (2, None, 2.0),
        (1.5, "m/s", 3.0),
        (100, "cm/s", 2.0),
        (2, "m", None),
        (2, "foo", None),
        (True, None, None),
        ("2", None, None),
    ],
)
def test_value_is_converted(value: float | str, unit: str | None, expected: float | None) -> None:
    """A number of the same dimension is; nothing else can be a value."""
    rules = load(STRIDES)
    assert in_unit_of(tunables_of(rules)[0], value, unit, rules) == expected


@pytest.mark.parametrize("value", [0.5, 5.1, math.nan, math.inf, True, "2"])
def test_value_outside_the_interval_is_refused(value: object) -> None:
    """So are NaN, and what is no number."""
    (constant,) = tunables_of(load(STRIDES))
    assert constant.refusal(value)
    assert not constant.refusal(1.0)
    assert not constant.refusal(5)


def test_constant_is_a_fixed_parameter() -> None:
    """It has the unit, the interval and the description of the constant."""
    (node, *_) = nodes_of_rules(load('const a = 3 m tunable in [1, 5] m "Room"'))
    found = node.parameter("a")
    assert found is not None
    assert (found.default, found.unit, found.description) == (3.0, "m", "Room")
    assert found.interval == Interval(1.0, 5.0)
    assert found.read_only


def test_unit_of_the_rules_is_in_the_description() -> None:
    """A node description could not be checked with a unit that it does not know."""
    (node, *_) = nodes_of_rules(load(STRIDES))
    found = node.parameter("a")
    assert found is not None
    assert (found.unit, found.description) == (None, "Speed (in stride)")


@pytest.mark.usefixtures("own_folder")
def test_setting_is_converted_for_the_safety_node_alone() -> None:
    """Launch files have the value in the unit of the constant; the gate has no such parameter."""
    statement = 'safety "robot.deros"\nparameters\n  param distance = 150 cm'
    flat = flatten(system_with(statement, TUNED))
    assert [dict(each.parameters) for each in flat.nodes] == [{"distance": 1.5}, {}]


@pytest.mark.usefixtures("own_folder")
@pytest.mark.parametrize(
    ("value", "code", "place"),
    [
        ("distance = 3 m", "DRS221", "3"),
        ("distance = 40 cm", "DRS221", "40"),
        ("distance = 1 s", "DRS306", "s"),
        ("distance = true", "DRS207", "true"),
        ("publish_freq = 20 Hz", "DRS306", "Hz"),
        ("use_sim_time = true m", "DRS306", "m"),
    ],
)
def test_wrong_setting_is_reported_at_its_value(value: str, code: str, place: str) -> None:
    """One out of the interval, of another dimension, or with a unit where none is converted."""
    statement = f'safety "robot.deros"\nparameters\n  param {value}'
    flat = flatten(system_with(statement, TUNED))
    found = [(each.code.name, each.span.text) for each in check_instances(flat)]
    assert (code, place) in found
