"""Evaluates expressions and conditions by direct interpretation.

Source: Kleene's strong three-valued logic, with ``None`` for unknown.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from deros.rules.engine.state import State
from deros.rules.functions.function_forms import strict
from deros.rules.functions.function_values import matches, points_in
from deros.rules.functions.functions import FUNCTIONS
from deros.rules.functions.reads import Term, is_single
from deros.rules.program import walk
from deros.rules.program.beams import beam_formula
from deros.rules.program.bounds import shortest_decimal
from deros.rules.program.ir import (
    Active,
    Age,
    And,
    Apply,
    Begins,
    Compare,
    Compute,
    Condition,
    Const,
    Failsafe,
    For,
    Frequency,
    Missing,
    Not,
    Once,
    Operator,
    Or,
    Program,
    Read,
    RuleRef,
    Scalar,
    Scale,
    Since,
    Temporal,
    Times,
    Truth,
    Tuned,
    Unknown,
    ValueExpression,
    Within,
)
from deros.rules.program.operators import (
    NEVER,
    Remembered,
    Verdict,
    conjunction,
    disjunction,
)

COMPARE: Mapping[Operator, Callable[[Any, Any], bool]] = {
    "=": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}


def is_nan(value: object) -> bool:
    """Return whether a scalar of any library's floating-point type is NaN."""
    return bool(value != value)


# The types of operands agree by construction (rules.compiler.build), which Any stands for here.
def evaluate_value(value: ValueExpression, state: State) -> Any:
    """Return the present value, ``None`` for unknown, which includes a computed NaN."""
    match value:
        case Const():
            return value.value
        case Tuned():
            return value.of(state.constants[value.constant])
        case Read():
            result = state.values[value.leaf]
        case Apply(state=int(number)):
            result = state.memories[number].result if number in state.memories else None
        case Apply():
            arguments = [evaluate_value(each, state) for each in value.arguments]
            unknown = any(each is None for each in arguments)
            result = None if unknown else _applied(value, arguments)
        case Scale():
            operand = evaluate_value(value.operand, state)
            result = None if operand is None else _scaled(operand, value)
        case Compute():
            operands = [evaluate_value(each, state) for each in value.operands]
            unknown = any(each is None for each in operands)
            result = None if unknown else strict(value.formula, value.names, *operands)
    return None if not isinstance(result, Iterable) and is_nan(result) else result


def _applied(function: Apply, arguments: list[Any]) -> float | None:
    """Return a function of known arguments."""
    if function.entry is not None:
        return matches(function.entry, function.names, arguments)
    if function.zone is not None:
        return points_in(beam_formula(function.zone.shape), *arguments)
    return FUNCTIONS[function.function].value(*arguments)


def _scaled(number: float, scale: Scale) -> float:
    """Return a number in another unit; without an offset, zero keeps its sign."""
    product = number * scale.factor
    return product + scale.offset if scale.offset else product


def evaluate_condition(condition: Condition, state: State, t_ns: int) -> Verdict:
    """Return a condition's verdict at an event, and update what it remembers.

    No operand is ever skipped: a memory must be updated at every event.
    """
    match condition:
        case Truth():
            truth = evaluate_value(condition.operand, state)
            return None if truth is None else bool(truth)
        case Compare():
            left = evaluate_value(condition.left, state)
            right = evaluate_value(condition.right, state)
            if left is None or right is None:
                return None
            return bool(COMPARE[condition.operator](left, right))
        case Within():
            return _within(condition, state)
        case Missing():
            return state.inputs[condition.input].missing
        case Unknown():
            return _is_unknown(condition, state)
        case Age():
            counted_ns = state.inputs[condition.input].counted_ns
            if counted_ns is None:
                return None
            return COMPARE[condition.operator](t_ns - counted_ns, condition.bound_ns)
        case Frequency():
            return t_ns - state.first_of(condition) >= condition.elapsed_ns
        case Not():
            verdict = evaluate_condition(condition.operand, state, t_ns)
            return None if verdict is None else not verdict
        case And():
            verdicts = [evaluate_condition(each, state, t_ns) for each in condition.operands]
            return conjunction(*verdicts)
        case Or():
            verdicts = [evaluate_condition(each, state, t_ns) for each in condition.operands]
            return disjunction(*verdicts)
        case For() | Once() | Times() | Since():
            return _temporal(condition, state, t_ns)
        case Begins():
            lasts = evaluate_condition(condition.operand, state, t_ns)
            began = remembered(condition.operand, state) != NEVER
            return None if lasts is None else began and not lasts
        case Failsafe():
            verdict = evaluate_condition(condition.operand, state, t_ns)
            awaited = any(state.inputs[index].awaited for index in condition.inputs)
            return True if verdict is None and not awaited else verdict
        case RuleRef():
            return state.verdicts[condition.rule]
        case Active():
            return state.active[condition.action]


def _is_unknown(condition: Unknown, state: State) -> bool:
    if state.inputs[condition.input].awaited:
        return False
    if condition.operand is None:
        return not state.inputs[condition.input].known
    return evaluate_value(condition.operand, state) is None


def _within(condition: Within, state: State) -> Verdict:
    operand = evaluate_value(condition.operand, state)
    lower = evaluate_value(condition.lower, state)
    upper = evaluate_value(condition.upper, state)
    if operand is None or lower is None or upper is None:
        return None
    above = operand >= lower if condition.lower_closed else operand > lower
    below = operand <= upper if condition.upper_closed else operand < upper
    return bool(above and below)


def remembered(condition: Temporal, state: State) -> Remembered:
    """Return what a temporal condition remembers as of the last event."""
    return state.remembered.get(condition.index, condition.row.memory.initial)


def _temporal(condition: Temporal, state: State, t_ns: int) -> Verdict:
    operands = [evaluate_condition(each, state, t_ns) for each in walk.operands(condition)]
    names: dict[str, Remembered] = {"now": t_ns, **dict(zip("pq", operands, strict=False))}
    if isinstance(condition, Since):
        counted = (state.inputs[index].counted_ns for index in condition.inputs)
        names["came"] = None not in counted
    else:
        names["T"] = condition.duration_ns
    if isinstance(condition, Times):
        names["N"] = condition.count
    before = remembered(condition, state)
    state.remembered[condition.index], verdict = condition.row.step(before, names)
    return verdict


def per_second(messages: int, elapsed_ns: int) -> float:
    """Return a frequency as it is told, in Hz: without what is less than 1 µHz.

    If no time has passed it is infinite.
    """
    return messages * 10**15 // elapsed_ns / 1e6 if elapsed_ns > 0 else math.inf


def term_value(program: Program, term: Term, state: State, t_ns: int) -> Scalar | None:
    """Return the value of a term as it is told; ``None`` is unknown, an age is in seconds."""
    match term:
        case Missing() | Unknown() | Active():
            return evaluate_condition(term, state, t_ns)
        case Age():
            counted_ns = state.inputs[term.input].counted_ns
            return None if counted_ns is None else (t_ns - counted_ns) / 1e9
        case Frequency():
            return per_second(term.messages, t_ns - state.first_of(term))
        case Read() | Apply() | Compute() | Tuned():
            value: Scalar | None = evaluate_value(term, state)
            if isinstance(value, float) and is_single(program, term):
                return shortest_decimal(value)
            return value
