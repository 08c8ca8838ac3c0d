"""Unknown values and failsafe rules: at the start, during the grace period, in reports."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from deros.generators.monitor.python.run import GeneratedMonitor
from deros.rules.engine.cause_plans import plan_of_unknown
from deros.rules.engine.engine import Engine
from deros.rules.engine.state import LeafValue
from deros.rules.program import ir
from tests.support.rules import condition, findings, program

MS = 10**6
SCAN = "input scan = topic /scan timeout 500 ms"
RULES = f"""
action stop publishes true on /stop : std_msgs.Bool latched;
{SCAN}
entity lidar {{
  failsafe near: scan.nearest(-30 deg, 30 deg) < 0.4 m;
  silent: scan.unknown();
  blind: scan.nearest(-30 deg, 30 deg).unknown();
}}
if lidar.near then {{ stop; }};
"""

monitors = pytest.mark.parametrize("monitor", [Engine, GeneratedMonitor])
Monitor = Callable[..., Engine]


def _scan(ahead: float) -> dict[int, LeafValue]:
    """Return a scan of three beams, with the middle one in the sector."""
    return {0: [2.0, ahead, 2.0], 1: -1.0, 2: 1.0, 3: 0.125, 4: 10.0}


def _verdicts(engine: Engine) -> list[bool | None]:
    """Return the verdict of ``near`` and the values of both forms of ``unknown()``."""
    return [rule.value for rule in engine.explain().rules]


@monitors
def test_documented_timeline_holds(monitor: Monitor) -> None:
    """During the grace nothing is unknown yet; afterwards every kind of blindness acts at once."""
    engine = monitor(program(RULES), 0, grace_ns=2000 * MS)
    engine.advance(1799 * MS)
    assert engine.waiting
    assert engine.events == []
    assert engine.next_deadline == 2500 * MS
    engine.message(1800 * MS, "/scan", _scan(2.0))
    assert not engine.waiting
    assert _verdicts(engine) == [False, False, False]
    engine.message(1900 * MS, "/scan", _scan(0.0))
    assert _verdicts(engine) == [True, False, True]
    assert engine.events[-1].t_ns == 1900 * MS
    engine.message(2000 * MS, "/scan", _scan(2.0))
    assert _verdicts(engine) == [False, False, False]
    engine.advance(2500 * MS)
    assert _verdicts(engine) == [True, True, True]
    assert [event.t_ns for event in engine.events] == [1900 * MS, 2500 * MS]


@monitors
def test_sensor_that_never_starts_acts_after_grace_and_timeout(
    monitor: Monitor,
) -> None:
    """This is the time at which the input is missing."""
    engine = monitor(program(RULES), 0, grace_ns=2000 * MS)
    engine.advance(3000 * MS)
    assert [event.t_ns for event in engine.events] == [2500 * MS]


@monitors
@pytest.mark.parametrize("ahead", [0.0, 0.03, math.nan])
def test_blind_first_scan_acts_during_the_grace(monitor: Monitor, ahead: float) -> None:
    """The sensor has started, so the monitor no longer waits."""
    engine = monitor(program(RULES), 0, grace_ns=2000 * MS)
    engine.message(100 * MS, "/scan", _scan(ahead))
    assert [event.t_ns for event in engine.events] == [100 * MS]


@monitors
def test_reset_is_refused_while_blind_or_waiting(monitor: Monitor) -> None:
    """A latched stop of an earlier run stays until the sector is known to be free."""
    engine = monitor(program(RULES), 0, grace_ns=2000 * MS, latched={"stop"})
    engine.advance(10 * MS)
    assert not engine.reset(20 * MS)
    engine.message(100 * MS, "/scan", _scan(0.0))
    assert not engine.reset(110 * MS)
    refused = [event for event in engine.events if event.kind == "refused"][-1]
    assert (refused.holding, refused.unknown) == (("behaviour_1",), ())
    engine.message(200 * MS, "/scan", _scan(2.0))
    assert engine.reset(210 * MS)


@monitors
def test_clock_step_is_a_start_without_grace(monitor: Monitor) -> None:
    """All inputs are awaited again, until the timeout passes in the new time."""
    engine = monitor(program(RULES), 0, grace_ns=2000 * MS)
    engine.message(3000 * MS, "/scan", _scan(2.0))
    engine.advance(1000 * MS)
    assert _verdicts(engine) == [None, False, False]
    engine.advance(1500 * MS)
    assert _verdicts(engine) == [True, True, True]


@monitors
def test_explain_shows_the_unknown_term(monitor: Monitor) -> None:
    """The state of a failsafe rule that acts shows the missing value."""
    engine = monitor(program(RULES), 0)
    engine.message(100 * MS, "/scan", _scan(0.0))
    near, silent, blind = engine.explain().rules
    assert near.value is True
    assert near.text.startswith("failsafe near:")
    assert near.reads == (("scan.nearest(-0.523599, 0.523599)", None),)
    assert silent.reads == (("scan.unknown()", False),)
    assert blind.reads == (("scan.nearest(-0.523599, 0.523599).unknown()", True),)


def test_unknown_applies_to_inputs_and_functions() -> None:
    """A field stands for its input; a function stands for itself, whatever its operand."""
    declared = "input v = topic /odom timeout 1 sec"
    assert condition("v.unknown()", declared) == ir.Unknown(0)
    assert condition("v.twist.twist.linear.x.unknown()", declared) == ir.Unknown(0)
    assert condition("v.twist.twist.linear.unknown() = false", declared) == ir.Not(ir.Unknown(0))
    size = ir.Apply("abs", (ir.Read(0),), 0)
    assert condition("v.twist.twist.linear.x.abs().unknown()", declared) == ir.Unknown(0, size)


def test_failsafe_rule_lists_inputs_that_can_make_it_unknown() -> None:
    """Inputs that are only tested for missing or unknown are not listed."""
    built = program(
        "input v = topic /odom.twist.twist.linear.x timeout 1 sec\n"
        "input w = topic /speed.data timeout 1 sec\n"
        "entity e { failsafe r: w.missing() or v > 1; failsafe s: w.unknown(); }"
    )
    assert built.rules[0].condition == ir.Failsafe(
        ir.Or((ir.Missing(0), ir.Compare(ir.Read(1), ">", ir.Const(1.0)))), (1,)
    )
    assert built.rules[1].condition == ir.Unknown(0)


@pytest.mark.parametrize(
    ("rule", "name", "failsafe"),
    [
        ("failsafe: v > 1", "failsafe", False),
        ('failsafe "text": v > 1', "failsafe", False),
        ("failsafe failsafe: v > 1", "failsafe", True),
        ('failsafe r "text": v > 1', "r", True),
        ("failsafe // so\n r: v > 1", "r", True),
        ("failsafe /* so */ : v > 1", "failsafe", False),
    ],
)
def test_failsafe_is_a_valid_rule_name(rule: str, name: str, failsafe: bool) -> None:
    """A rule may have this name and be failsafe."""
    built = program(f"input v = topic /speed.data timeout 1 sec entity e {{ {rule}; }}").rules[0]
    assert (built.name, isinstance(built.condition, ir.Failsafe)) == (name, failsafe)


@pytest.mark.parametrize(
    ("rule", "place"),
    [
        ("failsafe r: v > 1", "r"),
        ("r: v.unknown()", "v.unknown()"),
        ("r: v.rate().unknown()", "v.rate().unknown()"),
        ("r: v.age() > 1 sec", "v.age()"),
        ("r: not v.age() < 1 sec", "v.age()"),
        ("r: v.age() in [0 sec, 1 sec]", "v.age()"),
        ("r: topic /speed.data.age() > 1 sec", "topic /speed.data.age()"),
    ],
)
def test_what_asks_for_silence_needs_a_timeout(rule: str, place: str) -> None:
    """Without one, nothing notices a sensor that never sends, and waiting never ends."""
    reported = findings(f"input v = topic /speed.data entity e {{ {rule}; }}")
    assert ("DRS319", place) in [each[:2] for each in reported]


@pytest.mark.parametrize(
    "rule", ["scan.age().unknown()", "scan.missing().unknown()", "limit.unknown()"]
)
def test_unknown_applies_to_read_values_only(rule: str) -> None:
    """It does not apply to ages, conditions or constants."""
    reported = findings(f"const limit = 1\n{SCAN} entity e {{ r: {rule}; }}")
    assert "DRS304" in [each[0] for each in reported]


def test_chain_of_rules_may_be_longer_than_calls_can_be_nested() -> None:
    """What is unknown of a behaviour is found through any number of rules."""
    rules = "".join(f"r{each}: r{each + 1} for 1 ms; " for each in range(1_100))
    text = f"input v = topic /speed.data timeout 1 sec entity e {{ {rules} r1100: v > 1; }}"
    built = program(f"action stop latched; {text} if e.r0 then {{ stop; }};")
    plan = plan_of_unknown(built, built.behaviours[0])
    ((reading,),) = plan.tiers
    assert reading.rule is not None
    assert (built.rules[reading.rule].name, reading.name) == ("r1100", "v")
