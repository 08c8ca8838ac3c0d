"""Rules that name rules: what they mean, in which order they are evaluated, and what is refused."""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from typing import cast

import pytest
from hypothesis import HealthCheck, given, settings

from deros.generators.monitor.c.interface import render_monitor as render_c
from deros.generators.monitor.python.interface import render_monitor
from deros.generators.monitor.python.run import GeneratedMonitor
from deros.rules.engine.engine import Engine
from deros.rules.program import ir
from tests.support.counterexamples import Pair, pairs
from tests.support.monitors import START_NS, call, timed
from tests.support.rules import build_rules, findings, program
from tests.support.strategies import programs

SPEED = "input v = topic /speed.data timeout 1 sec\ninput f = topic /flag.data timeout 1 sec\n"
CHAIN = 3_001
"""Rules, each of which names the next: more than Python calls one another."""


def test_rules_come_after_those_that_they_name() -> None:
    """All others keep the order written."""
    built = program(
        SPEED + "entity a { first: v > 1; second: b.last and third; third: b.middle; fourth: f; }\n"
        "entity b { middle: v > 2; last: a.first or f; }"
    )
    names = [each.full_name for each in built.rules]
    assert names == ["a.first", "a.fourth", "b.middle", "a.third", "b.last", "a.second"]
    second = built.rules[5]
    assert second.condition == ir.And((ir.RuleRef(4), ir.RuleRef(3)))


@pytest.mark.parametrize("name", ["v", "limit"])
def test_input_or_constant_of_the_name_comes_first(name: str) -> None:
    """So rules that were written before rules could name rules keep their meaning."""
    result = build_rules(
        "input v = topic /flag.data\nconst limit = true\n"
        f"entity e {{ {name}: v; both: {name} and not {name}; }}"
    )
    assert result.program is not None
    (both,) = (each for each in result.program.rules if each.name == "both")
    assert not any(isinstance(each, ir.RuleRef) for each in _parts(both.condition))


def test_long_chain_is_built_checked_and_emitted() -> None:
    """No step of the way depends on how many rules stand below one another."""
    rules = "".join(f"r{n}: not r{n + 1};\n" for n in range(CHAIN))
    text = SPEED + f"entity e {{ {rules} failsafe r{CHAIN}: v > 1; }}\naction stop;\n"
    text += "if e.r0 and f.g then { stop; };\nentity f { g: f; }"
    built = program(text)
    assert [each.name for each in built.rules[:2]] == [f"r{CHAIN}", f"r{CHAIN - 1}"]
    assert sorted(code for code, _, _ in findings(text)) == ["DRS349", "DRS349", "DRS350"]
    for text in render_monitor(built).values():
        compile(text, "monitor", "exec")
    render_c(built)
    engine = Engine(built)
    flag, speed = (each.leaves[0] for each in built.inputs[::-1])
    engine.message(1, "/flag", {flag: True})
    events = engine.message(2, "/speed", {speed: 0.5})
    assert [(each.t_ns, each.action) for each in events] == [(2, "stop")]


def test_cause_stays_short() -> None:
    """Each rule doubles what it could say of the one below, and the text does not."""
    doubled = "".join(f"r{n}: r{n + 1} and v > {n} or r{n + 1} and f;\n" for n in range(40))
    built = program(
        SPEED + f"entity e {{ {doubled} r40: v > 50; }}\naction stop;\nif e.r0 then {{ stop; }};"
    )
    for monitor in (Engine(built), GeneratedMonitor(built)):
        flag, speed = (each.leaves[0] for each in built.inputs[::-1])
        monitor.message(1, "/flag", {flag: True})
        monitor.message(2, "/speed", {speed: 60.0})
        causes = monitor.explain().causes["behaviour_1"]
        assert causes == ("e.r0: e.r1; v 60.0 > 0; e.r1; f is true",)
        (last,) = (each for each in monitor.explain().rules if each.name == "e.r38")
        assert last.causes[0] == (
            "e.r39: e.r40: v 60.0 > 50; v 60.0 > 39; e.r40: v 60.0 > 50; f is true"
        )


@settings(suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(programs().flatmap(pairs))
def test_name_means_what_the_rule_means(pair: Pair) -> None:
    """With each name replaced by the condition of its rule, all verdicts and events are the same.

    The intervals of a condition are its own then, and run alike.
    """
    inlined = _inlined(pair.program)
    named = Engine(pair.program, START_NS, pair.start.grace_ns, pair.start.latched)
    plain = Engine(inlined, START_NS, pair.start.grace_ns, pair.start.latched)
    for t_ns, step in timed(pair.steps):
        assert call(plain, t_ns, step) == call(named, t_ns, step)
        assert plain.events == named.events
        verdicts = [
            [(each.value, each.since) for each in one.explain().rules] for one in (plain, named)
        ]
        assert verdicts[0] == verdicts[1]


def _parts(condition: ir.Condition) -> list[ir.Condition]:
    match condition:
        case ir.Not(operand=operand):
            return [condition, *_parts(operand)]
        case ir.And(operands=operands):
            return [condition, *(part for each in operands for part in _parts(each))]
        case _:
            return [condition]


def _inlined(written: ir.Program) -> ir.Program:
    """Return a program whose rules name no rules."""
    memories = count()
    conditions: list[ir.Condition] = []

    def inline(condition: ir.Condition) -> ir.Condition:
        match condition:
            case ir.RuleRef(rule=rule):
                return inline(conditions[rule])
            case ir.For() | ir.Once() | ir.Times():
                operand = inline(condition.operand)
                return replace(condition, index=next(memories), operand=operand)
            case ir.Since():
                operand, cause = inline(condition.operand), inline(condition.cause)
                return replace(condition, index=next(memories), operand=operand, cause=cause)
            case ir.Begins():
                return replace(condition, operand=cast(ir.For, inline(condition.operand)))
            case ir.Not() | ir.Failsafe():
                return replace(condition, operand=inline(condition.operand))
            case ir.And() | ir.Or():
                return replace(condition, operands=tuple(map(inline, condition.operands)))
            case _:
                return condition

    rules = []
    for each in written.rules:
        conditions.append(each.condition)
        rules.append(replace(each, condition=inline(each.condition)))

    def renumbered(behaviour: ir.Behaviour) -> ir.Behaviour:
        condition = shifted(behaviour.condition)
        body = tuple(
            renumbered(item) if isinstance(item, ir.Behaviour) else item for item in behaviour.body
        )
        return replace(behaviour, condition=condition, body=body)

    def shifted(condition: ir.Condition) -> ir.Condition:
        match condition:
            case ir.For() | ir.Once() | ir.Times():
                shift = condition.index + 10_000  # none of the numbers above
                return replace(condition, index=shift, operand=shifted(condition.operand))
            case ir.Since():
                operand, cause = shifted(condition.operand), shifted(condition.cause)
                shift = condition.index + 10_000
                return replace(condition, index=shift, operand=operand, cause=cause)
            case ir.Begins():
                return replace(condition, operand=cast(ir.For, shifted(condition.operand)))
            case ir.Not():
                return replace(condition, operand=shifted(condition.operand))
            case ir.And() | ir.Or():
                return replace(condition, operands=tuple(map(shifted, condition.operands)))
            case _:
                return condition

    behaviours = tuple(map(renumbered, written.behaviours))
    return replace(written, rules=tuple(rules), behaviours=behaviours)
