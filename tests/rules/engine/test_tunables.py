"""Tunable constants while a monitor runs, in the reference and in the generated Python."""

from __future__ import annotations

import math

import pytest

from deros.generators.monitor.python.render import render_monitor
from deros.generators.monitor.python.run import GeneratedMonitor
from deros.rules.engine.engine import Engine
from deros.rules.program.ir import Program
from tests.support.monitors import compare
from tests.support.rules import program
from tests.support.strategies import Start, Step

SPEED = """
action stop;
input v = topic /odom.twist.twist.linear.x
const limit = 0.5 m/s tunable in [0.1, 1] m/s
entity e { fast: CONDITION; }
behaviour b: if e.fast then { stop; };
"""
CHARGE = """
action stop;
input charge = topic /battery.percentage
const least = 20 % tunable in [10, 90] %
entity e { low: CONDITION; }
behaviour b: if e.low then { stop; };
"""

Runner = type[Engine] | type[GeneratedMonitor]


def speed(condition: str) -> Program:
    """Return a program with a limit of speed."""
    return program(SPEED.replace("CONDITION", condition))


def acts(built: Program, value: float, runner: Runner = Engine, **constants: float) -> bool:
    """Return whether a message has the action run."""
    monitor = runner(built, constants=constants)
    return bool(monitor.message(1, built.inputs[0].topic, {0: value}))


@pytest.mark.parametrize("runner", [Engine, GeneratedMonitor])
@pytest.mark.parametrize(
    ("condition", "value", "chosen", "expected"),
    [
        ("v > limit", 0.5, 0.5, False),
        ("v > limit", 0.45, 0.4, True),
        ("limit < v", 0.45, 0.4, True),
        ("v not in [-limit, limit]", -0.45, 0.4, True),
        ("v not in [-limit, limit]", -0.45, 0.5, False),
        ("v > 2 * limit", 0.85, 0.4, True),
        ("v > 2 * limit", 0.85, 0.5, False),
        ("v - 10 cm/s > limit", 0.45, 0.4, False),
        ("v * 2 > limit", 0.3, 0.5, True),
    ],
)
def test_value_chosen_at_the_start_decides(
    runner: Runner, condition: str, value: float, chosen: float, expected: bool
) -> None:
    """A tunable constant stands for that number wherever it is compared or computed with."""
    assert acts(speed(condition), value, runner, limit=chosen) is expected


@pytest.mark.parametrize("runner", [Engine, GeneratedMonitor])
def test_default_applies_unless_it_is_set(runner: Runner) -> None:
    """Without a value of its own, a monitor has that of the rules."""
    assert acts(speed("v > limit"), 0.55, runner)
    assert not acts(speed("v > limit"), 0.45, runner)


@pytest.mark.parametrize("runner", [Engine, GeneratedMonitor])
@pytest.mark.parametrize("value", [0.05, 1.5, math.nan, math.inf])
def test_value_outside_the_interval_prevents_the_start(runner: Runner, value: float) -> None:
    """So does NaN."""
    with pytest.raises(ValueError, match="limit"):
        runner(speed("v > limit"), constants={"limit": value})


@pytest.mark.parametrize("runner", [Engine, GeneratedMonitor])
def test_constant_that_no_rule_reads_is_checked(runner: Runner) -> None:
    """It is a parameter like the others."""
    built = speed("v > 0.5 m/s")
    assert acts(built, 0.6, runner, limit=0.4)
    with pytest.raises(ValueError, match="limit"):
        runner(built, constants={"limit": 2.0})


@pytest.mark.parametrize("runner", [Engine, GeneratedMonitor])
def test_unknown_constant_prevents_the_start(runner: Runner) -> None:
    """A misspelt name is no constant."""
    with pytest.raises(ValueError, match="no tunable constant limits"):
        runner(speed("v > limit"), constants={"limits": 0.5})


@pytest.mark.parametrize("runner", [Engine, GeneratedMonitor])
@pytest.mark.parametrize(
    ("condition", "value", "percent", "expected"),
    [
        ("charge <= least", 0.2, 20.0, True),
        ("charge < least", 0.2, 20.0, False),
        ("charge <= least", 0.7, 70.0, True),
        ("charge in [10 %, least]", 0.7, 70.0, True),
        ("charge * 1 <= 1 * least", 0.7, 70.0, True),
    ],
)
def test_constant_is_rounded_as_the_field_is(
    runner: Runner, condition: str, value: float, percent: float, expected: bool
) -> None:
    """A float32 that is 0.2 is at most 20 %, as with a constant that is not tunable."""
    built = program(CHARGE.replace("CONDITION", condition))
    narrow = {0.2: 0.20000000298023224, 0.7: 0.699999988079071}[value]
    assert acts(built, narrow, runner, least=percent) is expected


def test_cause_names_the_constant_with_its_value() -> None:
    """It is shown in its own unit, as it is set."""
    for condition, cause in (
        ("v > limit", "v 0.62 > limit 0.4 m/s"),
        ("v not in [-limit, limit]", "v 0.62 not in [-limit -0.4 m/s, limit 0.4 m/s]"),
        ("v > 1.5 * limit", "v 0.62 > (1.5 * limit) 0.6000000000000001"),
    ):
        built = speed(condition)
        for runner in (Engine, GeneratedMonitor):
            monitor = runner(built, constants={"limit": 0.4})
            monitor.message(1, "/odom", {0: 0.62})
            explained = monitor.explain()
            assert explained.causes["b"][0].removeprefix("e.fast: ").startswith(cause)
            assert ("limit", 0.4) in [tuple(each) for each in explained.rules[0].reads]


def test_cause_in_another_unit_shows_both() -> None:
    """The constant is told in its unit; what is computed of it, in that of the other side."""
    declared = "const tilt = 90 deg tunable in [10, 170] deg"
    rules = f"""
action stop;
input o = topic /imu.orientation
{declared}
entity e {{ tilted: o.roll() > CONDITION; }}
behaviour b: if e.tilted then {{ stop; }};
"""
    turned = {0: 1.0, 1: 0.0, 2: 0.0, 3: 0.0}
    for condition, shown in (
        ("tilt", "rad > tilt 90.0 deg"),
        ("2 * tilt / 2", "rad > (2 * tilt / 2) 1.5707963267948966 rad"),
    ):
        monitor = Engine(program(rules.replace("CONDITION", condition)))
        monitor.message(1, "/imu", turned)
        assert monitor.explain().causes["b"][0].endswith(shown)


def test_monitors_agree_on_all_ways_to_use_a_constant() -> None:
    """The generated monitor and the reference answer alike, whatever the constant is set to."""
    built = speed(
        "(v > limit for 2 ns) or v in [-limit, limit] or v * limit > 0.3 m2/s2 or v < -2 * limit"
    )
    speeds = (0.0, 0.3, 0.45, -0.45, 0.7, math.nan, 1.2, -3.0)
    steps = [Step("message", 3, "/odom", {0: value}) for value in speeds]
    texts = render_monitor(built)
    for chosen in (0.1, 0.4, 0.5, 1.0):
        compare(built, steps, texts, Start(0, frozenset(), (("limit", chosen),)))
