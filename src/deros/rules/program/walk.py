"""Traversals of a program: behaviours, conditions and values, in the order of evaluation."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TypeVar

from deros.rules.program.ir import (
    Age,
    And,
    Apply,
    Begins,
    Behaviour,
    Compare,
    Compute,
    Condition,
    Const,
    Failsafe,
    For,
    Frequency,
    Input,
    Leaf,
    Not,
    Once,
    Or,
    Program,
    Read,
    Rule,
    RuleRef,
    Scale,
    Since,
    Times,
    Truth,
    Tuned,
    Unknown,
    ValueExpression,
    Within,
)


def behaviours(program: Program) -> Iterator[Behaviour]:
    """Yield all behaviours in the order of their indices: outer before inner, top to bottom."""
    for each in program.behaviours:
        yield from nested(each)


def nested(behaviour: Behaviour) -> Iterator[Behaviour]:
    """Yield a behaviour and all that are nested in it, in the order of their indices."""
    yield behaviour
    for item in behaviour.body:
        if isinstance(item, Behaviour):
            yield from nested(item)


def refusing(program: Program) -> frozenset[int]:
    """Return the behaviours, by index, on whose falsehood a reset depends, with enclosing ones."""
    found = {
        index
        for action in program.actions
        if action.latched or action.reset_by is not None
        for index in action.triggered_by
    }
    for behaviour in reversed(tuple(behaviours(program))):
        if behaviour.index in found and behaviour.parent is not None:
            found.add(behaviour.parent)
    return frozenset(found)


def holdable_inputs(program: Program) -> tuple[Input, ...]:
    """Return the inputs whose timeouts can be held still, with no other effect.

    Who looks ahead holds them, as if messages went on to come. The age of an input, where a rule
    asks for it, counts from the same message as its timeout, so such an input is none of them.
    """
    aged = {each.input for each in conditions(program) if isinstance(each, Age)}
    return tuple(
        each for each in program.inputs if each.timeout_ns is not None and each.index not in aged
    )


def most_messages(conditions: Iterable[Condition]) -> dict[int, int]:
    """Return, by input, how many of its last messages the frequencies among conditions look at."""
    found: dict[int, int] = {}
    for each in conditions:
        if isinstance(each, Frequency):
            found[each.input] = max(found.get(each.input, 0), each.messages)
    return found


def inputs_of_causes(conditions: Iterable[Condition]) -> frozenset[int]:
    """Return the inputs that the causes of every ``since`` among the conditions read."""
    sinces = (each for each in conditions if isinstance(each, Since))
    return frozenset(index for each in sinces for index in each.inputs)


def awaited_by_behaviours(program: Program) -> frozenset[int]:
    """Return the inputs that causes of a ``since`` in a behaviour read.

    That such an input has come may change what is remembered, without any verdict of a rule.
    """
    conditions = (each.condition for each in behaviours(program))
    return inputs_of_causes(part for each in conditions for part in parts(each))


def conditions(program: Program) -> Iterator[Condition]:
    """Yield every condition of the rules, then of the behaviours, operands before the whole."""
    for rule in program.rules:
        yield from parts(rule.condition)
    for behaviour in behaviours(program):
        yield from parts(behaviour.condition)


def parts(condition: Condition) -> Iterator[Condition]:
    """Yield a condition's operands, theirs first, and then the condition itself."""
    for operand in operands(condition):
        yield from parts(operand)
    yield condition


def parts_below(
    program: Program, condition: Condition, seen: set[int]
) -> Iterator[tuple[Condition, int | None]]:
    """Yield the parts of a condition, in the place of each rule that it names those of the rule.

    With each is the rule that it is a part of, if any; rules ``seen`` before are left out. A chain
    of rules may be longer than calls can be nested.
    """
    open_: list[tuple[Iterator[Condition], int | None]] = [(parts(condition), None)]
    while open_:
        inside, rule = open_[-1]
        part = next(inside, None)
        if part is None:
            open_.pop()
        elif not isinstance(part, RuleRef):
            yield part, rule
        elif part.rule not in seen:
            seen.add(part.rule)
            open_.append((parts(program.rules[part.rule].condition), part.rule))


def operands(condition: Condition) -> tuple[Condition, ...]:
    """Return the conditions that a condition is made of, in the order written."""
    match condition:
        case Not() | For() | Once() | Times() | Begins() | Failsafe():
            return (condition.operand,)
        case And() | Or():
            return condition.operands
        case Since():
            return condition.operand, condition.cause
        case _:
            return ()


def rules_in(condition: Condition) -> list[int]:
    """Return the rules that a condition itself names, in order, each time that it does."""
    return [part.rule for part in parts(condition) if isinstance(part, RuleRef)]


def with_named(condition: Condition, rules: Mapping[int, Rule] | Sequence[Rule]) -> list[Condition]:
    """Return the conditions of the rules that a condition names, directly or not, and then itself.

    Each rule is there once, after those that it names itself.
    """
    return [*(rules[index].condition for index in named_rules(condition, rules)), condition]


def named_rules(condition: Condition, rules: Mapping[int, Rule] | Sequence[Rule]) -> list[int]:
    """Return the rules that a condition names, directly or not, in the order of evaluation.

    A rule that is not among the ``rules`` is left out.
    """
    known = rules.keys() if isinstance(rules, Mapping) else range(len(rules))
    found: set[int] = set()
    open_ = [condition]
    while open_:
        for part in parts(open_.pop()):
            if isinstance(part, RuleRef) and part.rule in known and part.rule not in found:
                found.add(part.rule)
                open_.append(rules[part.rule].condition)
    return sorted(found)


def values(conditions: Iterable[Condition]) -> Iterator[ValueExpression]:
    """Yield every value expression in the given conditions, arguments before functions."""
    for condition in conditions:
        match condition:
            case Truth(operand=operand):
                yield from terms(operand)
            case Unknown(operand=function) if function is not None:
                yield from terms(function)
            case Compare(left=left, right=right):
                yield from terms(left)
                yield from terms(right)
            case Within(operand=operand, lower=lower, upper=upper):
                yield from terms(operand)
                yield from terms(lower)
                yield from terms(upper)
            case _:
                pass


def terms(value: ValueExpression) -> Iterator[ValueExpression]:
    """Yield a value's arguments, theirs first, and then the value itself."""
    match value:
        case Apply(arguments=arguments):
            for argument in arguments:
                yield from terms(argument)
        case Scale(operand=operand):
            yield from terms(operand)
        case Compute(operands=operands):
            for operand in operands:
                yield from terms(operand)
        case _:
            pass
    yield value


def leaves(value: ValueExpression) -> Iterator[int]:
    """Yield the indices of the leaves that a value reads."""
    for term in terms(value):
        if isinstance(term, Read):
            yield term.leaf


def inputs_read(condition: Condition, leaves: Sequence[Leaf]) -> set[int]:
    """Return the inputs whose values or ages a condition reads: those that can make it unknown.

    What the rules read that it names is not among them; see :func:`with_named`.
    """
    asked = [part for part in parts(condition) if not isinstance(part, Unknown)]
    found = {part.input for part in asked if isinstance(part, Age)}
    for value in values(asked):
        if isinstance(value, Apply):
            found.add(value.input)
        elif isinstance(value, Read):
            found.add(leaves[value.leaf].input)
    return found


def inputs_behind(
    condition: Condition, rules: Mapping[int, Rule] | Sequence[Rule], leaves: Sequence[Leaf]
) -> tuple[int, ...]:
    """Return the inputs that a condition reads, and the rules that it names, in order."""
    read = (inputs_read(each, leaves) for each in with_named(condition, rules))
    return tuple(sorted(set().union(*read)))


def terminals(condition: Condition) -> list[Read | Apply | Tuned]:
    """Return the leaves, outermost functions and constants that a condition itself compares.

    Those that arithmetic has as operands are among them; constants are tunable ones, as written.
    """
    found: list[Read | Apply | Tuned] = []
    for value in compared(condition):
        if isinstance(value, Compute):
            found += value.operands
        else:
            found.append(value.as_written if isinstance(value, Tuned) else value)
    return found


Changing = TypeVar("Changing", bound=ValueExpression)


def is_fixed(value: ValueExpression) -> bool:
    """Return whether a value never changes, and so is never unknown."""
    return isinstance(value, Const | Tuned) or (isinstance(value, Compute) and value.is_fixed)


def changing(values: Iterable[Changing]) -> list[Changing]:
    """Return the values that can change, and be unknown: all but those of tunable constants."""
    return [each for each in values if not is_fixed(each)]


def computed(condition: Condition) -> list[Compute]:
    """Return the arithmetic that a condition itself (no part) compares."""
    return [value for value in compared(condition) if isinstance(value, Compute)]


def uncertain(condition: Condition) -> list[Compute]:
    """Return the arithmetic of a condition that can be unknown while its operands are known.

    Whether a point is in a zone cannot be.
    """
    return [each for each in changing(computed(condition)) if each.zone is None]


def compared(condition: Condition) -> list[Read | Apply | Compute | Tuned]:
    """Return what a condition itself (no part) compares, without fixed constants and units."""
    found: list[Read | Apply | Compute | Tuned] = []
    for name in ("operand", "left", "right", "lower", "upper"):
        value = getattr(condition, name, None)
        while isinstance(value, Scale):
            value = value.operand
        if isinstance(value, Read | Apply | Compute | Tuned):
            found.append(value)
    return found
