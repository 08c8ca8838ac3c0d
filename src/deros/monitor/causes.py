"""Why a condition is true, or false: the parts of it that make it so, each with its values.

Of an ``or`` those are the true operands, of an ``and`` all, of a ``for`` those of its operand with
the duration behind them; ``not`` asks why its operand is false. A :data:`Plan` holds all of that
which does not depend on values; the reference interprets it, and the generators emit it.
"""

from __future__ import annotations

from dataclasses import dataclass

from deros.monitor import walk
from deros.monitor.evaluate import evaluate_condition
from deros.monitor.ir import (
    Age,
    And,
    Behaviour,
    Compare,
    Condition,
    Const,
    Failsafe,
    For,
    Missing,
    Not,
    Operator,
    Or,
    Program,
    RuleRef,
    Scale,
    Truth,
    Unknown,
    ValueExpression,
    Within,
    Wording,
)
from deros.monitor.reads import Term, one_line, plain_term, term_name, term_value, terms
from deros.monitor.state import State
from deros.monitor.wordings import constant

OPPOSITE: dict[Operator, Operator] = {
    "=": "!=",
    "!=": "=",
    "<": ">=",
    "<=": ">",
    ">": "<=",
    ">=": "<",
}


@dataclass(frozen=True, slots=True)
class Say:
    """A cause: texts, and between them terms that stand for their values."""

    pieces: tuple[str | Term, ...]


@dataclass(frozen=True, slots=True)
class SayUnknown:
    """A cause: those of the terms that have no value. ``suffix`` follows."""

    terms: tuple[Term, ...]
    suffix: str


@dataclass(frozen=True, slots=True)
class SayRule:
    """A cause: why a rule is true, or (``holds`` false) why it is false, behind a ``head``."""

    rule: int
    holds: bool
    head: str


@dataclass(frozen=True, slots=True)
class When:
    """What depends on whether a condition is true, or (``holds`` false) whether it is false."""

    condition: Condition
    holds: bool
    then: Plan
    otherwise: Plan = ()


Plan = tuple[Say | SayUnknown | SayRule | When, ...]
"""How to tell the causes of a condition of which is known that it is true, or that it is false."""


def causes_of_rule(
    program: Program, index: int, holds: bool, state: State, t_ns: int
) -> tuple[str, ...]:
    """Return why a rule is true, or false, as which it was evaluated last."""
    plan = plan_of(program, program.rules[index].condition, holds)
    return tuple(_tell(program, plan, state, t_ns))


def causes_of_behaviour(
    program: Program, behaviour: Behaviour, state: State, t_ns: int
) -> tuple[str, ...]:
    """Return why the conditions of a behaviour and of all around it are true."""
    return tuple(_tell(program, plan_of_behaviour(program, behaviour), state, t_ns))


def plan_of_behaviour(program: Program, behaviour: Behaviour) -> Plan:
    """Return how to tell why a behaviour holds: the outermost condition first, each part once."""
    everyone = {each.index: each for each in walk.behaviours(program)}
    around = [behaviour]
    while (parent := around[0].parent) is not None:
        around.insert(0, everyone[parent])
    parts = (part for each in around for part in plan_of(program, each.condition, True))
    return tuple(dict.fromkeys(parts))


def negated_rules(program: Program) -> frozenset[int]:
    """Return the rules of which some plan tells why they are false."""
    found: set[int] = set()
    plans = [plan_of_behaviour(program, each) for each in walk.behaviours(program)]
    plans += [plan_of(program, each.condition, True) for each in program.rules]
    while plans:
        for part in plans.pop():
            if isinstance(part, When):
                plans += [part.then, part.otherwise]
            elif isinstance(part, SayRule) and not part.holds and part.rule not in found:
                found.add(part.rule)
                plans.append(plan_of(program, program.rules[part.rule].condition, False))
    return frozenset(found)


def plan_of(program: Program, condition: Condition, holds: bool, suffix: str = "") -> Plan:
    """Return how to tell why a condition is true or, if not ``holds``, why it is false.

    Args:
        program: whose condition it is.
        condition: the condition.
        holds: what it is.
        suffix: what follows each cause: for how long.
    """
    match condition:
        case Not():
            return plan_of(program, condition.operand, not holds, suffix)
        case And() | Or():
            plans = [(each, plan_of(program, each, holds, suffix)) for each in condition.operands]
            if isinstance(condition, And) is holds:  # all operands are so
                return tuple(part for _, plan in plans for part in plan)
            return tuple(When(each, holds, plan) for each, plan in plans)
        case For():
            return _plan_of_interval(program, condition, holds, suffix)
        case Failsafe() if holds:
            known = plan_of(program, condition.operand, True, suffix)
            unknown = SayUnknown(terms(condition.operand), suffix)
            return (When(condition.operand, True, known, (unknown,)),)
        case Failsafe():
            return plan_of(program, condition.operand, False, suffix)
        case RuleRef():
            name = program.rules[condition.rule].full_name
            head = f"{'' if holds else 'not '}{name}{suffix}: "
            return (SayRule(condition.rule, holds, head),)
        case _:
            return (Say(tuple(_joined([*_pieces(program, condition, holds), suffix]))),)


def _plan_of_interval(program: Program, condition: For, holds: bool, suffix: str) -> Plan:
    duration = condition.wording or f"{condition.duration_ns / 1e9:.9g} sec"
    if holds:
        return plan_of(program, condition.operand, True, f" for {duration}{suffix}")
    # A plan for what is both true and false doubles with each interval within another.
    if any(isinstance(part, For) for part in walk.parts(condition.operand)):
        short: Plan = (Say((f"not yet {one_line(condition.span.text)}{suffix}",)),)
    else:
        short = plan_of(program, condition.operand, True, f" for less than {duration}{suffix}")
    operand = plan_of(program, condition.operand, False, suffix)
    return (When(condition.operand, True, short, operand),)


# Comparisons, with their values -------------------------------------------------------------------


def _pieces(
    program: Program, condition: Truth | Compare | Within | Missing | Unknown | Age, holds: bool
) -> list[str | Term]:
    match condition:
        case Truth(operand=Const() as fixed):
            return [constant(fixed.value)]
        case Truth():
            return [f"{_name(program, condition.operand)} is {str(holds).lower()}"]
        case Missing() | Unknown():
            return [f"{'' if holds else 'not '}{term_name(program, condition)}"]
        case Compare():
            return _compared(program, condition, holds)
        case Within():
            return _within(program, condition, holds)
        case Age():
            shown = condition.wording
            operator = shown.operator if shown else condition.operator
            bound = shown.right[0] if shown else f"{condition.bound_ns / 1e9:.9g} sec"
            value = _valued(program, plain_term(condition), shown.unit if shown else "")
            return [*value, f" {operator if holds else OPPOSITE[operator]} {bound}"]


def _compared(program: Program, condition: Compare, holds: bool) -> list[str | Term]:
    shown = condition.wording
    operator = shown.operator if shown else condition.operator
    operator = operator if holds else OPPOSITE[operator]
    unit, bound = (shown.unit, shown.right[0]) if shown else ("", "")
    left = _side(program, condition.left, unit)
    right = _side(program, condition.right, bound)
    if operator == "=" and isinstance(condition.right, Const):  # the value is no news then
        left = [_name(program, condition.left)]
    elif operator == "=" and isinstance(condition.left, Const):
        right = [_name(program, condition.right)]
    return [*left, f" {operator} ", *right]


def _within(program: Program, condition: Within, holds: bool) -> list[str | Term]:
    closed = (condition.lower_closed, condition.upper_closed)
    brackets = ("[" if closed[0] else "(") + ("]" if closed[1] else ")")
    shown = condition.wording or Wording("=", "", ("", ""), brackets)
    return [
        *_side(program, condition.operand, shown.unit),
        f" {'' if holds else 'not '}in {shown.brackets[0]}",
        *_side(program, condition.lower, shown.right[0]),
        ", ",
        *_side(program, condition.upper, shown.right[1]),
        shown.brackets[1],
    ]


def _side(program: Program, value: ValueExpression, shown: str) -> list[str | Term]:
    """Return one side: a constant as ``shown``, all else with its value and ``shown`` as unit."""
    if isinstance(value, Const):
        return [shown or constant(value.value)]
    return _valued(program, _term(value), shown)


def _valued(program: Program, term: Term, unit: str) -> list[str | Term]:
    return [f"{term_name(program, term)} ", term, f" {unit}" if unit else ""]


def _name(program: Program, value: ValueExpression) -> str:
    return constant(value.value) if isinstance(value, Const) else term_name(program, _term(value))


def _term(value: ValueExpression) -> Term:
    """Return what is read: a value before its conversion into the unit of another one."""
    while isinstance(value, Scale):
        value = value.operand
    assert not isinstance(value, Const)
    return value


def _joined(pieces: list[str | Term]) -> list[str | Term]:
    """Return pieces with texts that stand side by side made one."""
    found: list[str | Term] = []
    for piece in pieces:
        if isinstance(piece, str) and found and isinstance(found[-1], str):
            found[-1] += piece
        elif piece != "":
            found.append(piece)
    return found


# Telling ------------------------------------------------------------------------------------------


def _tell(program: Program, plan: Plan, state: State, t_ns: int) -> list[str]:
    found: list[str] = []
    for part in plan:
        match part:
            case Say():
                texts = (
                    each if isinstance(each, str) else constant(_known(each, state, t_ns))
                    for each in part.pieces
                )
                found.append("".join(texts))
            case SayUnknown():
                names = (
                    term_name(program, each)
                    for each in part.terms
                    if term_value(each, state, t_ns) is None
                )
                found.append(f"unknown: {', '.join(names)}{part.suffix}")
            case SayRule():
                causes = causes_of_rule(program, part.rule, part.holds, state, t_ns)
                found.append(part.head + " and ".join(causes))
            case When():
                # To evaluate once more what this event has evaluated changes no interval.
                is_so = evaluate_condition(part.condition, state, t_ns) is part.holds
                found += _tell(program, part.then if is_so else part.otherwise, state, t_ns)
    return found


def _known(term: Term, state: State, t_ns: int) -> bool | int | float | str:
    value = term_value(term, state, t_ns)
    assert value is not None, "what makes a condition true or false has a value"
    return value
