"""Causes: the parts of a condition that make it true, with their values."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from deros.generators.monitor.python.run import GeneratedMonitor
from deros.rules.engine.engine import Engine
from deros.rules.engine.state import LeafValue
from deros.rules.program.bounds import as_float32
from deros.rules.program.ir import Program
from tests.support.rules import program

MS = 10**6
INPUTS = """
action stop;
const limit = 2.5
const max_tilt = toRad(10 deg)
const greeting = "a{b}'c\\""
input v = topic /speed.data timeout 0.5 sec
input u = topic /odom.twist.twist.linear.x
input w = topic /odom.twist.twist.linear.y
input f = topic /flag.data
input m = topic /mode.data
input n = topic /name.data
input q = topic /imu.orientation
input s = topic /status
input c = topic /battery.percentage
input scan = topic /scan
"""

monitors = pytest.mark.parametrize("monitor", [Engine, GeneratedMonitor])
Monitor = Callable[..., Engine]


class Driver:
    """A monitor of rules whose inputs are set by field paths."""

    def __init__(self, monitor: Monitor, text: str) -> None:
        """Start at 0."""
        self.program: Program = program(INPUTS + text)
        self.monitor = monitor(self.program)

    def send(self, t_ms: int, topic: str, **values: LeafValue) -> None:
        """Send a message; fields are given by the last part of their paths, all others are 0."""
        leaves: dict[int, LeafValue] = {}
        for leaf in self.program.leaves:
            if self.program.inputs[leaf.input].topic == topic:
                leaves[leaf.index] = values.get(str(leaf.path[-1]), 0.0)
        self.monitor.message(t_ms * MS, topic, leaves)

    def causes(self, rule: int = 0) -> tuple[str, ...]:
        """Return the causes of a rule."""
        return self.monitor.explain().rules[rule].causes

    def why(self, behaviour: str = "b") -> tuple[str, ...]:
        """Return the causes of a behaviour."""
        return self.monitor.explain().causes[behaviour]


TENTH = as_float32(0.1)


def rule(condition: str) -> str:
    """Return rules with one condition, and a behaviour of it."""
    return f"entity e {{ r: {condition}; }} behaviour b: if e.r then {{ stop; }};"


@monitors
@pytest.mark.parametrize(
    ("condition", "topic", "values", "expected"),
    [
        ("v > 2", "/speed", {"data": 3.25}, "v 3.25 > 2"),
        ("limit < v", "/speed", {"data": 3.25}, "v 3.25 > 2.5"),
        ("not v <= limit", "/speed", {"data": 3.25}, "v 3.25 > 2.5"),
        ("not v != 3.25", "/speed", {"data": 3.25}, "v = 3.25"),
        ("v != 2", "/speed", {"data": -0.0}, "v 0.0 != 2"),
        ("v > 2", "/speed", {"data": math.inf}, "v inf > 2"),
        ("v in (2, 4]", "/speed", {"data": 3.0}, "v 3.0 in (2, 4]"),
        ("v not in [0, 2]", "/speed", {"data": 3.0}, "v 3.0 not in [0, 2]"),
        ("not v in [0, 2]", "/speed", {"data": 3.0}, "v 3.0 not in [0, 2]"),
        ("u > 5 km/h", "/odom", {"x": 2.0}, "u 2.0 m/s > 5 km/h"),
        ("u > 0.5 m/s", "/odom", {"x": 2.0}, "u 2.0 > 0.5 m/s"),
        ("u >= w", "/odom", {"x": 2.0, "y": 1.5}, "u 2.0 >= w 1.5"),
        ("u in [w, 3 m/s]", "/odom", {"x": 2.0, "y": 1.5}, "u 2.0 in [w 1.5, 3 m/s]"),
        ("u > 1", "/odom", {"x": 2.0}, "u 2.0 > 1"),
        ("m > 2.5", "/mode", {"data": 7}, "m 7 > 2.5"),
        ("m = 7", "/mode", {"data": 7}, "m = 7"),
        ("s.level = ERROR", "/status", {"level": 2}, "s.level = ERROR"),
        ("s.level != ERROR", "/status", {"level": 0}, "s.level 0 != ERROR"),
        ("f", "/flag", {"data": True}, "f is true"),
        ("not f", "/flag", {"data": False}, "f is false"),
        ("f = false", "/flag", {"data": False}, "f = false"),
        ('n != "auto"', "/name", {"data": "a\nb"}, 'n "a?b" != "auto"'),
        ('n != "auto"', "/name", {"data": "x" * 99}, f'n "{"x" * 60}…" != "auto"'),
        ("n = greeting", "/name", {"data": "a{b}'c\""}, 'n = "a{b}\'c""'),
        (
            "q.roll() not in [-max_tilt, max_tilt]",
            "/imu",
            {"x": 1.0},
            "q.roll() 3.141592653589793 rad not in [-10 deg, 10 deg]",
        ),
        ("true", "/flag", {"data": True}, "true"),
        ("c <= 0.2", "/battery", {"percentage": as_float32(0.2)}, "c 0.2 <= 0.2"),
        ("c >= 0.7", "/battery", {"percentage": as_float32(0.7)}, "c 0.7 >= 0.7"),
        ("c = 0.1", "/battery", {"percentage": as_float32(0.1)}, "c = 0.1"),
        ("c in [10 %, 0.3]", "/battery", {"percentage": as_float32(0.1)}, "c 0.1 in [10 %, 0.3]"),
        ("c.abs() < 0.7", "/battery", {"percentage": as_float32(0.3)}, "c.abs() 0.3 < 0.7"),
        ("c * 1 > 0.1", "/battery", {"percentage": as_float32(0.1)}, f"(c * 1) {TENTH} > 0.1"),
        (
            "scan.nearest(-30 deg, 30 deg) <= 0.4 m",
            "/scan",
            {
                "ranges": [as_float32(0.4)] * 3,
                "angle_min": -0.5,
                "angle_increment": 0.5,
                "range_max": 9.0,
            },
            "scan.nearest(-0.523599, 0.523599) 0.4 <= 0.4 m",
        ),
    ],
)
def test_comparison_shows_its_value(
    monitor: Monitor, condition: str, topic: str, values: dict[str, LeafValue], expected: str
) -> None:
    """The bound is as written, and a negated comparison becomes its opposite."""
    driver = Driver(monitor, rule(condition) + " entity z { z: f or m = 1; }")
    driver.send(100, topic, **values)
    assert driver.causes() == (expected,)
    assert driver.why() == (f"e.r: {expected}",)


@monitors
def test_true_operands_of_or_and_all_of_and_are_shown(monitor: Monitor) -> None:
    """Operands that do not contribute are omitted."""
    driver = Driver(monitor, rule("(v > 1 or f or m = 2) and not (u > 1 or m = 3)"))
    driver.send(100, "/speed", data=3.0)
    driver.send(100, "/odom", x=0.5)
    driver.send(100, "/mode", data=2)
    assert driver.causes() == ("v 3.0 > 1", "m = 2", "u 0.5 <= 1", "m 2 != 3")
    driver.send(100, "/speed", data=0.0)
    assert driver.causes() == ("m = 2", "u 0.5 <= 1", "m 2 != 3")


@monitors
def test_false_operands_of_a_negated_and_are_shown(monitor: Monitor) -> None:
    """One false operand suffices, and unknown ones are omitted."""
    driver = Driver(monitor, rule("not (v > 1 and f and m = 2)"))
    driver.send(100, "/speed", data=3.0)
    driver.send(100, "/mode", data=1)
    assert driver.causes() == ("m 1 != 2",)
    driver.send(100, "/flag", data=False)
    assert driver.causes() == ("f is false", "m 1 != 2")


@monitors
def test_for_is_shown_when_it_is_due(monitor: Monitor) -> None:
    """Next to another true part, one that is not due yet is not a cause."""
    driver = Driver(monitor, rule("(u > 1 or u > 5 for 500 ms) or f"))
    driver.send(100, "/odom", x=3.0)
    driver.send(200, "/flag", data=True)
    assert driver.causes() == ("f is true",)
    driver.monitor.advance(599 * MS)
    assert driver.causes() == ("f is true",)
    driver.monitor.advance(600 * MS)
    assert driver.causes() == ("u 3.0 > 1 for 500 ms", "f is true")
    driver.send(700, "/flag", data=False)
    assert driver.causes() == ("u 3.0 > 1 for 500 ms",)


@monitors
def test_within_shows_its_text_or_for_no_time_its_operand(monitor: Monitor) -> None:
    """The values that made it true may be gone, unless it is true at this instant alone."""
    driver = Driver(monitor, rule("(u > 1 within 100 ms) or (u > 1 within 0 sec)"))
    driver.send(100, "/odom", x=3.0)
    assert driver.causes() == ("u > 1 within 100 ms", "u 3.0 > 1")
    driver.send(150, "/odom", x=0.5)
    assert driver.causes() == ("u > 1 within 100 ms",)


@monitors
def test_negated_for_shows_a_short_or_false_operand(monitor: Monitor) -> None:
    """Its operand has not lasted long enough, or is false."""
    driver = Driver(monitor, rule("f and not (u > 1 for 0.5 sec)"))
    driver.send(100, "/flag", data=True)
    driver.send(100, "/odom", x=3.0)
    assert driver.causes() == ("f is true", "u 3.0 > 1 for less than 0.5 sec")
    driver.send(200, "/odom", x=0.5)
    assert driver.causes() == ("f is true", "u 0.5 <= 1")


@monitors
def test_nested_for_shows_both_durations(monitor: Monitor) -> None:
    """The inner duration comes first; an operand that is not due yet is shown as written."""
    driver = Driver(monitor, rule("((u > 1 for 0.1 sec) or f for 0.2 sec) and m = 0"))
    driver.send(0, "/mode", data=0)
    driver.send(100, "/odom", x=3.0)
    driver.monitor.advance(400 * MS)
    assert driver.causes() == ("u 3.0 > 1 for 0.1 sec for 0.2 sec", "m = 0")
    driver = Driver(monitor, rule("not (((u > 1 for 0.1 sec) or f) for 0.2 sec)"))
    driver.send(100, "/flag", data=True)
    assert driver.causes() == ("not yet ((u > 1 for 0.1 sec) or f) for 0.2 sec",)


@monitors
def test_silence_shows_its_age(monitor: Monitor) -> None:
    """An age is shown with its value, questions about messages as written."""
    driver = Driver(monitor, rule("v.missing() or v.age() >= 500 ms or not v.unknown()"))
    driver.send(100, "/speed", data=3.0)
    assert driver.causes() == ("not v.unknown()",)
    driver.monitor.advance(600 * MS)
    assert driver.causes() == ("v.missing()", "v.age() 0.5 s >= 500 ms")
    driver = Driver(monitor, rule("v.age() not in [0, 0.3 sec] or v.unknown()"))
    driver.send(100, "/speed", data=3.0)
    driver.monitor.advance(600 * MS)
    assert driver.causes() == ("v.age() 0.5 > 0.3 sec", "v.unknown()")


@monitors
def test_failsafe_rule_shows_unknown_terms(monitor: Monitor) -> None:
    """If it is true by its values, those are shown."""
    text = "entity e { failsafe r: v > 5 and v.rate() < 1; } behaviour b: if e.r then { stop; };"
    driver = Driver(monitor, text)
    driver.send(100, "/speed", data=6.0)
    assert driver.causes() == ("unknown: v.rate()",)
    driver.send(200, "/speed", data=6.0)
    assert driver.causes() == ("v 6.0 > 5", "v.rate() 0.0 < 1")
    driver.monitor.advance(700 * MS)
    assert driver.causes() == ("unknown: v, v.rate()",)
    assert driver.why() == ("e.r: unknown: v, v.rate()",)


FORGETFUL = """
input x = topic /odom.twist.twist.linear.x timeout 9 sec
entity e { REST }
behaviour b: if e.r then { stop; };
"""


def _forgotten(monitor: Monitor, rules: str) -> Driver:
    """Return a monitor whose x was above 2, and whose v was unknown since, and is 3."""
    driver = Driver(monitor, FORGETFUL.replace("REST", rules))
    driver.send(100, "/odom", x=3.0)
    driver.send(110, "/speed", data=math.nan)
    driver.send(120, "/odom", x=0.0)
    driver.send(130, "/speed", data=3.0)
    return driver


@monitors
@pytest.mark.parametrize(
    "rules",
    [
        "failsafe r: v > 1 since x > 2;",
        "failsafe r: not (v > 1 since x > 2);",
        "q: v > 1 since x > 2; failsafe r: e.q and x < 5;",
        "failsafe r: (v > 1 since x > 2) or x.abs() / x > 5;",
    ],
)
def test_failsafe_rule_shows_what_has_no_value_of_known_terms(monitor: Monitor, rules: str) -> None:
    """A ``since`` does not know what was before, and arithmetic divides by zero."""
    driver = _forgotten(monitor, rules)
    named = "(x.abs() / x), " if "/" in rules else ""
    cause = f"unknown: {named}v > 1 since x > 2"
    assert driver.causes(1 if "q:" in rules else 0) == (cause,)
    assert driver.why() == (f"e.r: {cause}",)


@monitors
def test_unknown_since_is_no_cause(monitor: Monitor) -> None:
    """That one side of it is false makes it false only if both are known to suffice."""
    driver = _forgotten(monitor, "r: not (v > 1 since x > 2) or x = 0;")
    assert driver.causes() == ("x = 0",)
    driver.send(140, "/speed", data=0.0)
    assert driver.causes() == ("x 0.0 <= 2", "v 0.0 <= 1", "x = 0")


@monitors
def test_negated_within_is_a_cause_only_when_its_time_is_over(monitor: Monitor) -> None:
    """Until then it is true, although its operand is false."""
    driver = Driver(monitor, rule("not (v > 1 within 2 sec) or v < 1"))
    driver.send(100, "/speed", data=3.0)
    driver.send(200, "/speed", data=0.0)
    assert driver.causes() == ("v 0.0 < 1",)
    driver.send(2200, "/speed", data=0.0)
    assert driver.causes() == ("v 0.0 <= 1", "v 0.0 < 1")


@monitors
def test_behaviour_shows_its_rules(monitor: Monitor) -> None:
    """Conditions of outer behaviours come first; negated rules show why they are false."""
    text = """
    entity e { fast: v > 1 and f; slow: u < 1; off: m = 0; }
    behaviour outer: if (e.fast for 0.1 sec) or e.off then {
      behaviour inner: if not e.slow or not (e.off for 1 sec) then { stop; };
    };
    """
    driver = Driver(monitor, text)
    driver.send(100, "/mode", data=1)
    driver.send(100, "/flag", data=True)
    driver.send(100, "/odom", x=3.0)
    assert driver.monitor.explain().causes == {}
    driver.send(200, "/speed", data=2.0)
    assert driver.monitor.explain().causes == {}
    driver.monitor.advance(300 * MS)
    fast = "e.fast for 0.1 sec: v 2.0 > 1; f is true"
    assert driver.why("outer") == (fast,)
    assert driver.why("inner") == (fast, "not e.slow: u 3.0 >= 1", "not e.off: m 1 != 0")
    driver.send(310, "/mode", data=0)
    assert driver.why("outer") == (fast, "e.off: m = 0")
    assert driver.why("inner") == (
        fast,
        "e.off: m = 0",
        "not e.slow: u 3.0 >= 1",
        "e.off for less than 1 sec: m = 0",
    )


@monitors
def test_false_rule_has_no_cause(monitor: Monitor) -> None:
    """A behaviour that does not hold, or is disabled, has none either."""
    text = "entity e { r: v > 1; } optional behaviour b: if e.r then { stop; };"
    driver = Driver(monitor, text)
    assert driver.causes() == ()
    driver.send(100, "/speed", data=2.0)
    driver.monitor.enable(110 * MS, "b", False)
    assert driver.causes() == ("v 2.0 > 1",)
    assert driver.monitor.explain().causes == {}


def test_nested_negated_intervals_do_not_explode() -> None:
    """The emitted text grows linearly with the rule."""
    condition = "u > 1"
    for _ in range(30):
        condition = f"not ({condition} for 1 sec)"
    monitor: Monitor = GeneratedMonitor  # type: ignore[assignment]
    driver = Driver(monitor, rule(condition))
    driver.send(100, "/odom", x=3.0)
    assert len(driver.causes()) == 1
