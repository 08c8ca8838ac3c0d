"""What random programs and traces contain, to see that the draws miss nothing.

A feature is named by words. One of a pair counts where it can make a difference: a trace in which a
field goes from 0.0 to -0.0 counts only for a program that compares that field.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from itertools import pairwise
from typing import Any

from deros.rules.engine.state import LeafValue
from deros.rules.program import ir, walk
from deros.rules.program.formulas import Binary, Name, Number
from deros.rules.program.rounds import rounds, watched_actions
from tests.support.strategies import Step

_EXACT = 2**53
"""Above it, a double does not hold every integer."""

OPERATORS: Mapping[type, str] = {
    ir.Not: "another not",
    ir.And: "and",
    ir.Or: "or",
    ir.For: "for",
    ir.Once: "within",
    ir.Times: "times",
    ir.Begins: "begins",
    ir.Missing: "missing",
    ir.Unknown: "unknown",
    ir.Age: "age",
    ir.Frequency: "frequency",
    ir.Truth: "boolean",
    ir.Compare: "comparison",
    ir.Within: "interval",
    ir.RuleRef: "rule",
    ir.Active: "active",
}
"""What can stand right after ``not``, as features name it; a ``since`` has two sides."""

FEATURES = (
    "a plain number beside a product",
    "a number with a unit beside a product",
    "min or max of three",
    "min or max of three, one a constant",
    "min or max of constants",
    *(f"not before {each}" for each in (*OPERATORS.values(), "since", "failsafe")),
    *(
        f"not within {each}"
        for each in ("for", "within", "times", "begins", "and", "or", "failsafe")
    ),
    "not within since, before its cause",
    "not within since, in its cause",
    "a rate over header stamps",
    "a latency by header stamps",
    "a rate of a latency by header stamps",
    "previous of a 64-bit integer",
    "previous of a 64-bit integer beside a great constant",
    "previous of a 64-bit integer beside another value",
    "a rule that names an action",
    "a behaviour that names an action",
    "a latched action that a condition names",
    "three rounds of an event",
    *(f"a point in a {each}" for each in ("polygon", "circle", "rectangle")),
    *(f"points of a scan in a {each}" for each in ("polygon", "circle", "rectangle")),
)
"""What a program can contain."""

_WAITING = (
    "since",
    "the cause of a since",
    "for",
    "within",
    "times",
    "begins",
    "failsafe",
    "missing",
)

TRACE_FEATURES = (
    "zeros of both signs",
    *(f"zeros of both signs in {each}" for each in ("=", "!=", "previous", "min or max")),
    *(f"an input that never comes in {each}" for each in (*_WAITING, "a reset")),
    "the last of three topics first",
    *(f"a stamp that {each}" for each in ("steps back", "stands still", "jumps", "is missing")),
    "neighbours among 64-bit integers",
)
"""What a pair of a program and a trace can contain."""


def features_of(program: ir.Program) -> set[str]:
    """Return which of :data:`FEATURES` a program contains."""
    found: set[str] = set()
    conditions = tuple(walk.conditions(program))
    for condition in conditions:
        found |= _negations(program, condition)
        found |= _of_previous(program, condition)
    for value in walk.values(conditions):
        if isinstance(value, ir.Compute) and value.zone is not None:
            found.add(f"a point in a {type(value.zone.shape).__name__.lower()}")
        elif isinstance(value, ir.Compute):
            found |= _of_arithmetic(value)
        if isinstance(value, ir.Apply) and value.zone is not None:
            found.add(f"points of a scan in a {type(value.zone.shape).__name__.lower()}")
        if isinstance(value, ir.Apply) and value.function == "rate_over":
            found |= {"a rate over header stamps"} if len(value.arguments) > 2 else set()
            found |= (
                {"a rate of a latency by header stamps"}
                if "latency" in map(_function, value.arguments)
                else set()
            )
        found |= {"a latency by header stamps"} if _function(value) == "latency" else set()
    return found | _of_actions(program)


def _function(value: ir.ValueExpression) -> str:
    return value.function if isinstance(value, ir.Apply) else ""


def features_of_trace(program: ir.Program, steps: Sequence[Step]) -> set[str]:
    """Return which of :data:`TRACE_FEATURES` a program driven by a trace contains."""
    messages = [each for each in steps if each.call == "message"]
    return {
        *_zeros(program, messages),
        *_absent(program, messages),
        *_stamps(program, messages),
        *_neighbours(program, messages),
    }


# Programs -----------------------------------------------------------------------------------------


def _of_actions(program: ir.Program) -> set[str]:
    conditions = {
        "rule": [each.condition for each in program.rules],
        "behaviour": [each.condition for each in walk.behaviours(program)],
    }
    found = {
        f"a {owner} that names an action"
        for owner, wholes in conditions.items()
        for each in wholes
        if any(isinstance(part, ir.Active) for part in walk.parts(each))
    }
    if any(program.actions[index].latched for index in watched_actions(program)):
        found.add("a latched action that a condition names")
    return found | ({"three rounds of an event"} if len(rounds(program)) > 2 else set())


def _negations(program: ir.Program, condition: ir.Condition) -> set[str]:
    def is_not(each: ir.Condition) -> bool:
        return isinstance(each, ir.Not)

    match condition:
        case ir.Not(operand=ir.Since()):
            return {"not before since"}
        case ir.Not(operand=ir.RuleRef(rule=rule)):
            is_failsafe = isinstance(program.rules[rule].condition, ir.Failsafe)
            return {"not before rule", *(["not before failsafe"] if is_failsafe else [])}
        case ir.Not(operand=operand):
            return {f"not before {OPERATORS[type(operand)]}"}
        case ir.Since():
            before = ["not within since, before its cause"] if is_not(condition.operand) else []
            return {
                *before,
                *(["not within since, in its cause"] if is_not(condition.cause) else []),
            }
        case ir.Begins():
            return {"not within begins"} if is_not(condition.operand.operand) else set()
        case ir.Failsafe():
            return {"not within failsafe"} if is_not(condition.operand) else set()
        case ir.For() | ir.Once() | ir.Times() | ir.And() | ir.Or():
            inside = any(map(is_not, walk.operands(condition)))
            return {f"not within {OPERATORS[type(condition)]}"} if inside else set()
        case _:
            return set()


def _of_previous(program: ir.Program, condition: ir.Condition) -> set[str]:
    sides = [getattr(condition, each, None) for each in ("operand", "left", "right", "lower")]
    if not any(_is_wide_previous(program, each) for each in sides):
        return set()
    found = {"previous of a 64-bit integer"}
    for side in sides:
        if isinstance(side, ir.Const) and abs(float(side.value)) >= _EXACT:
            found.add("previous of a 64-bit integer beside a great constant")
        if isinstance(side, ir.Read) or (
            isinstance(side, ir.Apply) and not _is_wide_previous(program, side)
        ):
            found.add("previous of a 64-bit integer beside another value")
    return found


def _is_wide_previous(program: ir.Program, value: object) -> bool:
    match value:
        case ir.Apply(function="previous", arguments=(ir.Read(leaf), *_)):
            return program.leaves[leaf].type.base in ("int64", "uint64")
    return False


def _of_arithmetic(value: ir.Compute) -> set[str]:
    found = set()
    for part in _parts(value.formula):
        if isinstance(part, Binary) and part.operator in ("+", "-"):
            sides = (part.left, part.right)
            product = any(_is_product(each) for each in sides)
            if product and any(isinstance(each, Number) for each in sides):
                found.add("a plain number beside a product")
    if _WITH_UNIT.search(value.wording):
        found.add("a number with a unit beside a product")
    tree = ast.parse(_WITH_UNIT.sub(r"\1", value.wording), mode="eval")
    for call in ast.walk(tree):
        if isinstance(call, ast.Call) and ast.unparse(call.func) in ("min", "max"):
            constants = [each for each in call.args if _is_constant(each)]
            if len(call.args) > 2:
                found.add("min or max of three")
                if 0 < len(constants) < len(call.args):
                    found.add("min or max of three, one a constant")
            if len(constants) == len(call.args):
                found.add("min or max of constants")
    return found


_WITH_UNIT = re.compile(r"(\d) (?:ms|s)\b")


def _is_product(part: object) -> bool:
    """Return whether a part of a formula is a product or quotient of two things that are read."""
    products = (each for each in _parts(part) if isinstance(each, Binary))
    return any(
        each.operator in ("*", "/")
        and all(any(isinstance(x, Name) for x in _parts(s)) for s in (each.left, each.right))
        for each in products
    )


def _is_constant(node: ast.expr) -> bool:
    return not any(isinstance(each, ast.Name) and each.id[0] == "x" for each in ast.walk(node))


def _parts(value: Any) -> Iterator[Any]:
    if isinstance(value, tuple):
        for each in value:
            yield from _parts(each)
    elif is_dataclass(value):
        yield value
        for each in fields(value):
            yield from _parts(getattr(value, each.name))


# Traces -------------------------------------------------------------------------------------------


def _successions(messages: Sequence[Step], leaf: int) -> Iterator[tuple[LeafValue, LeafValue]]:
    """Yield each value of a leaf and the one after it."""
    values = [each.leaves[leaf] for each in messages if leaf in each.leaves]
    yield from pairwise(values)


def _zeros(program: ir.Program, messages: Sequence[Step]) -> set[str]:
    changing = {
        leaf.index
        for leaf in program.leaves
        if any(map(_changes_sign_of_zero, _successions(messages, leaf.index)))
    }
    found = set()
    for condition in walk.conditions(program):
        for value in walk.values([condition]):
            read = set(walk.leaves(value)) & changing
            if not read:
                continue
            found.add("zeros of both signs")
            if isinstance(condition, ir.Compare) and condition.operator in ("=", "!="):
                found.add(f"zeros of both signs in {condition.operator}")
            if isinstance(value, ir.Apply) and value.function == "previous":
                found.add("zeros of both signs in previous")
            if isinstance(value, ir.Compute) and re.search("m(in|ax)", value.wording):
                found.add("zeros of both signs in min or max")
    return found


def _changes_sign_of_zero(pair: tuple[LeafValue, LeafValue]) -> bool:
    former, value = pair
    if not isinstance(former, float) or not isinstance(value, float) or former or value:
        return False
    return math.copysign(1.0, former) != math.copysign(1.0, value)


def _absent(program: ir.Program, messages: Sequence[Step]) -> set[str]:
    found = set()
    first = list(dict.fromkeys(each.topic for each in messages))
    topics = tuple(program.topics)
    if len(topics) > 2 and len(first) > 1 and first[0] == topics[-1]:
        found.add("the last of three topics first")
    if not first:
        return found
    absent = {each.index for each in program.inputs if each.topic not in first}
    conditions = tuple(walk.conditions(program))

    def waits(condition: ir.Condition) -> bool:
        return not absent.isdisjoint(walk.inputs_behind(condition, program.rules, program.leaves))

    for each in conditions:
        if isinstance(each, ir.Missing) and each.input in absent:
            found.add("an input that never comes in missing")
        kinds = (ir.For, ir.Once, ir.Times, ir.Begins)
        names = {kind: OPERATORS[kind] for kind in kinds}
        for kind, word in (names | {ir.Failsafe: "failsafe", ir.Since: "since"}).items():
            if isinstance(each, kind) and waits(each):
                found.add(f"an input that never comes in {word}")
        if isinstance(each, ir.Since) and not absent.isdisjoint(each.inputs):
            found.add("an input that never comes in the cause of a since")
    refusing = walk.refusing(program)
    for behaviour in walk.behaviours(program):
        if behaviour.index in refusing and waits(behaviour.condition):
            found.add("an input that never comes in a reset")
    return found


def _stamps(program: ir.Program, messages: Sequence[Step]) -> set[str]:
    found = set()
    for value in walk.values(walk.conditions(program)):
        if not isinstance(value, ir.Apply) or value.function != "rate_over":
            continue
        header = [each.leaf for each in value.arguments[2:] if isinstance(each, ir.Read)]
        if not header:
            continue
        sec, nanosec = header
        received = [each.leaves for each in messages if sec in each.leaves]
        stamps = [int(f"{each[sec]}") * 10**9 + int(f"{each[nanosec]}") for each in received]
        for former, stamp in pairwise(stamps):
            found |= {"a stamp that is missing"} if stamp == 0 else set()
            found |= {"a stamp that steps back"} if 0 < stamp < former else set()
            found |= {"a stamp that stands still"} if 0 < stamp == former else set()
            found |= {"a stamp that jumps"} if 0 < former < stamp - 10**8 else set()
    return found


def _neighbours(program: ir.Program, messages: Sequence[Step]) -> set[str]:
    for condition in walk.conditions(program):
        for value in walk.values([condition]):
            if not _is_wide_previous(program, value):
                continue
            for leaf in walk.leaves(value):
                for former, after in _successions(messages, leaf):
                    if not isinstance(former, int) or not isinstance(after, int):
                        continue
                    if former != after and float(former) == float(after):
                        return {"neighbours among 64-bit integers"}
    return set()
