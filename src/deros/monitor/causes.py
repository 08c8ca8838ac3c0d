"""The causes of a condition that is true or false: its decisive parts, each with its values.

For an ``or`` they are the true operands, for an ``and`` all, for a ``for`` its operand's, with
the duration behind them; ``not`` asks why its operand is false. A :data:`Plan` holds all of that
which does not depend on values; the reference interprets it, and the generators emit it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deros.interfaces.durations import seconds_text
from deros.monitor import walk
from deros.monitor.evaluate import evaluate_condition
from deros.monitor.ir import (
    OPPOSITE,
    Age,
    And,
    Begins,
    Behaviour,
    Compare,
    Condition,
    Const,
    Failsafe,
    For,
    Missing,
    Not,
    Once,
    Or,
    Program,
    RuleRef,
    Scale,
    Since,
    Truth,
    Unknown,
    ValueExpression,
    Within,
    Wording,
)
from deros.monitor.reads import Term, plain_term, strip_comments, term_name, term_value, terms
from deros.monitor.state import State
from deros.monitor.wordings import constant

_LONGEST_TEXT = 40
_MORE = " …"
_LEVELS = 2
"""From so many rules below one another on, a cause names a rule without that rule's causes."""


@dataclass(frozen=True, slots=True)
class Say:
    """A cause, where a condition is true, or (``holds`` false) is false.

    ``pieces`` are texts, and between them terms that stand for their values.
    """

    condition: Condition
    holds: bool
    pieces: tuple[str | Term, ...]


@dataclass(frozen=True, slots=True)
class SayRule:
    """A cause, where a rule is true, or (``holds`` false) is false: a ``head``, and why it is.

    Where rules name rules that name rules, the innermost are named without their own causes
    (:func:`plan_of_rule`): otherwise the text could double with each rule in between.
    """

    rule: int
    holds: bool
    head: str


@dataclass(frozen=True, slots=True)
class AllOf:
    """The causes of all parts, where each of them has some."""

    parts: tuple[Plan, ...]


@dataclass(frozen=True, slots=True)
class AnyOf:
    """The causes of all parts that have some."""

    parts: tuple[Plan, ...]


@dataclass(frozen=True, slots=True)
class During:
    """The causes of the operand of an interval or of a ``since``.

    They are some where the interval has lasted long enough or, if not ``reached``, where it has
    begun and has not; and where the ``since`` is true, which is always ``reached``.
    """

    interval: For | Since
    reached: bool
    part: Plan

    @property
    def is_sure(self) -> bool:
        """Whether the operand is true then; that of a ``since`` need not be, in its cause."""
        return isinstance(self.interval, For)


@dataclass(frozen=True, slots=True)
class OrUnknown:
    """The causes of a part or, where it has none, the cause that some of the terms are unknown."""

    part: Plan
    terms: tuple[Term, ...]


Plan = Say | SayRule | AllOf | AnyOf | During | OrUnknown
"""How to tell why a condition is true, or why it is false; where it is not, there is no cause."""


def causes_of_rule(
    program: Program, index: int, holds: bool, state: State, t_ns: int
) -> tuple[str, ...]:
    """Return why a rule is true, or false, as of its last evaluation."""
    return tuple(_tell(program, plan_of_rule(program, index, holds), state, t_ns))


def causes_of_behaviour(
    program: Program, behaviour: Behaviour, state: State, t_ns: int
) -> tuple[str, ...]:
    """Return why the conditions of a behaviour and of all around it are true."""
    return tuple(_tell(program, plan_of_behaviour(program, behaviour), state, t_ns))


def plan_of_behaviour(program: Program, behaviour: Behaviour) -> Plan:
    """Return the plan of a behaviour's causes: the outermost condition first, each part once."""
    everyone = {each.index: each for each in walk.behaviours(program)}
    around = [behaviour]
    while (parent := around[0].parent) is not None:
        around.insert(0, everyone[parent])
    return _all_of([plan_of(program, each.condition, True) for each in around])


def plan_of_rule(program: Program, index: int, holds: bool) -> Plan:
    """Return the plan of a rule's causes; they go through no more than two further rules."""
    condition = program.rules[index].condition
    shortened = {rule for rule in _named(condition) if _has_levels(program, rule, _LEVELS)}
    return plan_of(program, condition, holds, shortened=frozenset(shortened))


def _has_levels(program: Program, index: int, levels: int) -> bool:
    """Return whether so many rules stand below one another below a rule."""
    if not levels:
        return True
    named = _named(program.rules[index].condition)
    return any(_has_levels(program, each, levels - 1) for each in named)


def _named(condition: Condition) -> set[int]:
    return {part.rule for part in walk.parts(condition) if isinstance(part, RuleRef)}


def told_rules(program: Program) -> frozenset[tuple[int, bool]]:
    """Return the rules, and which verdict of each, whose causes somebody may ask for.

    Those are the causes of each rule as written, while it is true, and what the plans of these and
    of the behaviours name.
    """
    open_ = [(each.index, True) for each in program.rules if each.early_of is None]
    for behaviour in walk.behaviours(program):
        open_ += _rules_in(plan_of_behaviour(program, behaviour))
    found: set[tuple[int, bool]] = set()
    while open_:
        asked = open_.pop()
        if asked not in found:
            found.add(asked)
            open_ += _rules_in(plan_of_rule(program, *asked))
    return frozenset(found)


def _rules_in(plan: Plan) -> Iterator[tuple[int, bool]]:
    match plan:
        case AllOf(parts=parts) | AnyOf(parts=parts):
            for each in parts:
                yield from _rules_in(each)
        case During(part=part) | OrUnknown(part=part):
            yield from _rules_in(part)
        case SayRule(rule=rule, holds=holds):
            yield rule, holds


def plan_of(
    program: Program,
    condition: Condition,
    holds: bool,
    suffix: str = "",
    shortened: frozenset[int] = frozenset(),
) -> Plan:
    """Return the plan of the causes of a condition that is true or, if not ``holds``, false.

    Args:
        program: whose condition it is.
        condition: the condition.
        holds: whether it is true.
        suffix: what follows each cause: for how long.
        shortened: the rules that are named without their causes.
    """
    match condition:
        case Not():
            return plan_of(program, condition.operand, not holds, suffix, shortened)
        case And() | Or():
            plans = [
                plan_of(program, each, holds, suffix, shortened) for each in condition.operands
            ]
            return _all_of(plans) if isinstance(condition, And) is holds else _any_of(plans)
        case For():
            return _plan_of_interval(program, condition, holds, suffix, shortened)
        case Once() if holds and condition.duration_ns:  # what made it true may be gone
            written = _shortened(strip_comments(condition.span.text))
            return Say(condition, True, (f"{written}{suffix}",))
        case Once():
            return plan_of(program, condition.operand, holds, suffix, shortened)
        case Begins():
            lasting = condition.operand
            word = " as of now" if holds else " already"
            part = plan_of(program, lasting.operand, True, f"{word}{suffix}", shortened)
            during = During(lasting, not holds, part)
            if holds:
                return during
            return _any_of([during, plan_of(program, lasting.operand, False, suffix, shortened)])
        case Since():
            return _plan_of_since(program, condition, holds, suffix, shortened)
        case Failsafe():
            part = plan_of(program, condition.operand, holds, suffix, shortened)
            return OrUnknown(part, terms(program, condition.operand)) if holds else part
        case RuleRef():
            rule = program.rules[condition.rule]
            name = (rule if rule.early_of is None else program.rules[rule.early_of]).full_name
            head = f"{'' if holds else 'not '}{name}{suffix}"
            if condition.rule in shortened:
                return Say(condition, holds, (head,))
            return SayRule(condition.rule, holds, f"{head}: ")
        case _:
            pieces = [*_pieces(program, condition, holds), suffix]
            return Say(condition, holds, tuple(_joined(pieces)))


def _plan_of_interval(
    program: Program, condition: For, holds: bool, suffix: str, shortened: frozenset[int]
) -> Plan:
    """Return the plan of an interval; nested ones add the same amount of text at each level."""
    duration = condition.wording or seconds_text(condition.duration_ns)
    is_deep = suffix.count(" for ") > 1 or suffix.endswith(_MORE)
    further = f" for {duration}{_MORE if is_deep else suffix}"
    if holds:
        whole = plan_of(program, condition.operand, True, further, shortened)
        return During(condition, True, whole) if condition.duration_ns else whole
    operand = plan_of(program, condition.operand, False, suffix, shortened)
    if not condition.duration_ns:
        return operand
    if any(isinstance(part, For) for part in walk.parts(condition.operand)):
        shown = _shortened(strip_comments(condition.span.text))
        short: Plan = Say(Truth(Const(True)), True, (f"not yet {shown}{suffix}",))
    else:
        less = f" for less than {duration}{suffix}"
        short = plan_of(program, condition.operand, True, less, shortened)
    return _any_of([During(condition, False, short), operand])


def _plan_of_since(
    program: Program, condition: Since, holds: bool, suffix: str, shortened: frozenset[int]
) -> Plan:
    """Return the plan of both sides; the operand has the cause, as written, behind it."""
    cause = plan_of(program, condition.cause, holds, suffix, shortened)
    is_deep = " since " in suffix or suffix.endswith(_MORE)
    further = _MORE if is_deep else f" since {_shortened(condition.wording)}{suffix}"
    behind = further if holds else suffix
    operand = plan_of(program, condition.operand, holds, behind, shortened)
    return _any_of([cause, During(condition, True, operand) if holds else operand])


def _shortened(text: str) -> str:
    return f"{text[:_LONGEST_TEXT]}{_MORE if len(text) > _LONGEST_TEXT else ''}"


def _all_of(plans: list[Plan]) -> Plan:
    flat: dict[Plan, None] = {}
    for each in plans:
        flat.update(dict.fromkeys(each.parts if isinstance(each, AllOf) else (each,)))
    return next(iter(flat)) if len(flat) == 1 else AllOf(tuple(flat))


def _any_of(plans: list[Plan]) -> Plan:
    flat: dict[Plan, None] = {}
    for each in plans:
        flat.update(dict.fromkeys(each.parts if isinstance(each, AnyOf) else (each,)))
    return next(iter(flat)) if len(flat) == 1 else AnyOf(tuple(flat))


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
            bound = shown.right[0] if shown else seconds_text(condition.bound_ns)
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
    """Return the value that is read, before its conversion into the unit of another one."""
    while isinstance(value, Scale):
        value = value.operand
    assert not isinstance(value, Const)
    return value


def _joined(pieces: list[str | Term]) -> list[str | Term]:
    """Return pieces, with adjacent texts joined."""
    found: list[str | Term] = []
    for piece in pieces:
        if isinstance(piece, str) and found and isinstance(found[-1], str):
            found[-1] += piece
        elif piece != "":
            found.append(piece)
    return found


# Telling ------------------------------------------------------------------------------------------


def _tell(program: Program, plan: Plan, state: State, t_ns: int) -> list[str]:
    # To evaluate once more what this event has evaluated changes no interval.
    match plan:
        case Say():
            if evaluate_condition(plan.condition, state, t_ns) is not plan.holds:
                return []
            texts = (
                each if isinstance(each, str) else constant(_known(program, each, state, t_ns))
                for each in plan.pieces
            )
            return ["".join(texts)]
        case SayRule():
            if state.verdicts[plan.rule] is not plan.holds:
                return []
            causes = causes_of_rule(program, plan.rule, plan.holds, state, t_ns)
            return [plan.head + "; ".join(causes)]
        case AllOf() | AnyOf():
            told = [_tell(program, each, state, t_ns) for each in plan.parts]
            is_so = all(told) or isinstance(plan, AnyOf)
            return [cause for each in told for cause in each] if is_so else []
        case During():
            has_lasted = evaluate_condition(plan.interval, state, t_ns) is True
            is_short = not has_lasted and plan.interval.index in state.since
            is_so = has_lasted if plan.reached else is_short
            return _tell(program, plan.part, state, t_ns) if is_so else []
        case OrUnknown():
            open_ = (each for each in plan.terms if term_value(program, each, state, 0) is None)
            names = [term_name(program, each) for each in open_]
            unknown = f"unknown: {', '.join(names)}"
            return _tell(program, plan.part, state, t_ns) or [unknown]


def _known(program: Program, term: Term, state: State, t_ns: int) -> bool | int | float | str:
    value = term_value(program, term, state, t_ns)
    assert value is not None, "what makes a condition true or false has a value"
    return value
