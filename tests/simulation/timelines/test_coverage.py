"""What timelines reach is seen without changing what happens, and why rules do not act is told."""

from __future__ import annotations

import pytest
from hypothesis import given, settings

from deros.rules.engine.engine import Engine
from deros.rules.program import walk
from deros.simulation.timelines.coverage import Coverage, Gap, condition_text
from deros.simulation.timelines.coverage import sides as sides_of
from tests.support import timelines
from tests.support.counterexamples import Pair, pairs
from tests.support.profiles import scaled
from tests.support.strategies import Step, programs

HEAD = """use "robot.system" import Robot
action stop;
input v = topic /speed.data timeout 1 sec
input f = topic /flag.data timeout 1 sec
"""


def _run(engine: Engine, t_ns: int, step: Step) -> int:
    """Do a step and return its time."""
    t_ns = max(0, t_ns + step.wait_ns)
    match step.call:
        case "message":
            engine.message(t_ns, step.topic, step.leaves)
        case "advance":
            engine.advance(t_ns)
        case "reset":
            engine.reset(t_ns)
        case "enable":
            engine.enable(t_ns, step.behaviour, step.enabled)
    return t_ns


@settings(max_examples=scaled(200))
@given(programs().flatmap(pairs))
def test_looking_changes_nothing(pair: Pair) -> None:
    """An engine that is asked for everything after each step gives the events of another one."""
    plain, asked = (
        Engine(pair.program, 0, pair.start.grace_ns, pair.start.latched) for _ in range(2)
    )
    coverage = Coverage(pair.program)
    t_ns = 0
    for step in pair.steps:
        _run(plain, t_ns, step)
        t_ns = _run(asked, t_ns, step)
        coverage.observe(asked)
        for behaviour in walk.behaviours(pair.program):
            if asked.holds(behaviour) is False and asked.is_enabled(behaviour):
                assert asked.against(behaviour)
        assert asked.events == plain.events
    missing = coverage.total - coverage.seen
    assert len(coverage.gaps()) <= missing


CONDITIONS: tuple[tuple[str, list[str]], ...] = (
    ("v > 1", []),
    ("v > 1 and f", ["v > 1", "f"]),
    ("not v > 1", []),
    ("not (v > 1 or f)", ["v > 1", "f"]),
    ("v > 1 or not f", ["v > 1", "f"]),
    ("(v > 1 and f) or v < 0", ["v > 1 and f", "v > 1", "f", "v < 0"]),
    ("v > 1 for 1 sec", ["v > 1"]),
    ("f begins and v in [0, 1)", ["f begins", "f", "v in [0, 1)"]),
    ("v >= 1 since v > 2", ["v >= 1", "v > 2"]),
    ("v.missing() or v.age() > 0.5 sec", ["v.missing()", "v.age() > 0.5 sec"]),
    ("a and f", ["f"]),
)


@pytest.mark.parametrize(("condition", "sides"), CONDITIONS)
def test_sides_of_a_condition(condition: str, sides: list[str]) -> None:
    """Comparisons and the sides of and and or count once, what is negated as what it is of.

    The whole condition counts as its rule, and a rule that it names is counted there.
    """
    rules = f"{HEAD}entity e {{ a: v > 5; r: {condition}; }}\nif e.r then {{ stop; }};"
    program = timelines.program(rules)
    whole = program.rules[-1].condition
    found = [condition_text(program, each) for each in sides_of(whole)]
    assert sorted(found) == sorted(sides)


def test_what_was_seen_is_no_gap() -> None:
    """A rule that was never seen stands for all that it is made of."""
    rules = f"{HEAD}entity e {{ r: v > 1 and f; }}\nbehaviour b: if e.r then {{ stop; }};"
    program = timelines.program(rules)
    coverage = Coverage(program)
    assert _told(coverage.gaps()) == {("e.r", "", True), ("e.r", "", False), ("b", "", True)}
    engine = Engine(program)
    leaves = {program.inputs[leaf.input].topic: leaf.index for leaf in program.leaves}
    for t_ns, v, f in ((1, 2.0, False), (2, 2.0, True)):
        for topic, value in (("/speed", v), ("/flag", f)):
            engine.message(t_ns, topic, {leaves[topic]: value})
            coverage.observe(engine)
    assert _told(coverage.gaps()) == {("e.r", "v > 1", False)}
    assert (coverage.seen, coverage.total) == (6, 7)


def _told(gaps: list[Gap]) -> set[tuple[str, str, bool]]:
    return {(each.name, each.text, each.never) for each in gaps}


def test_looking_before_the_first_event_changes_nothing() -> None:
    """A switch that stays as it is is no event: what is asked then must not be remembered."""
    program = timelines.program(
        f"{HEAD}entity e {{ r: not v.missing() begins; }}\n"
        "optional behaviour b: if e.r then { stop; };"
    )
    leaf = next(each.index for each in program.leaves if each.path == ("data",))
    plain, asked = Engine(program), Engine(program)
    for engine in (plain, asked):
        engine.enable(0, "b", True)
    asked.explain()
    asked.verdict(program.rules[0].condition)
    asked.against(program.behaviours[0])
    for engine in (plain, asked):
        engine.message(1, "/speed", {leaf: 0.0})
    assert [each.kind for each in plain.events] == ["trigger"]
    assert asked.events == plain.events
