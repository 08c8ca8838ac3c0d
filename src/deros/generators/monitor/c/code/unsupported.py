"""Rules that C cannot express; these are rejected, as are comparisons of two texts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NoReturn

from deros import codes
from deros.diagnostics import Span, report
from deros.generators.api.protocol import GenerationError
from deros.generators.monitor.c.code.formulas import printed
from deros.generators.monitor.c.code.layout import rule_parts
from deros.generators.monitor.c.code.value_types import compared, type_of
from deros.generators.monitor.functions import refuse_unknown
from deros.interfaces.durations import LATEST_NS
from deros.interfaces.types import INT64
from deros.rules.functions.functions import FUNCTIONS, Argument, Function, Result
from deros.rules.program import walk
from deros.rules.program.ir import (
    Age,
    Apply,
    Condition,
    Const,
    For,
    Frequency,
    Program,
    Read,
    Trigger,
    ValueExpression,
)

_LIBRARY = ("fabs",)
"""What is called without a text of ours."""


def refuse_unsupported(program: Program) -> None:
    """Reject rules that C would give another meaning.

    Raises:
        GenerationError: the program has such a rule.
    """
    refuse_unknown(program, knows, "C")
    for condition, span in rule_parts(program):
        _refuse_integer(program, condition, span)
        _refuse_wide(program, condition, span)
        _refuse_mixed(program, condition, span)
    for duration_ns, span in _durations(program):
        if duration_ns > LATEST_NS:
            _refuse("a duration is longer than 146 years", span)
    for behaviour in walk.behaviours(program):
        for item in behaviour.body:
            if isinstance(item, Trigger):
                _refuse_great(item)


def knows(row: Function) -> bool:
    """Return whether the function of a row can be emitted as C."""
    if row.memory is not None and not row.over_span:
        return False
    return bool(row.reads_length or printed(row) or row.c_call in _LIBRARY)


def _refuse(message: str, span: Span, hint: str = "") -> NoReturn:
    raise GenerationError([report(codes.UNSUPPORTED_BY_TARGET, message, span, hint)])


def _refuse_integer(program: Program, condition: Condition, span: Span) -> None:
    """Reject a function of integers that C has for floating-point numbers only."""
    for value in walk.values([condition]):
        if not isinstance(value, Apply):
            continue
        row = FUNCTIONS[value.function]
        if (
            not row.c_integer
            and row.result is Result.ELEMENT
            and type_of(program, value) != "double"
        ):
            _refuse(f"{row.name}() of an integer does not exist in C", span)


def _refuse_wide(program: Program, condition: Condition, span: Span) -> None:
    """Reject functions of 64-bit integers, which a double does not hold."""
    for term in walk.values([condition]):
        if not isinstance(term, Apply) or FUNCTIONS[term.function].argument is not Argument.NUMBER:
            continue
        if _is_wide(program, term.arguments[0]):
            is_written = FUNCTIONS[term.function].is_written  # else it is a part of a rate
            name = term.function if is_written else "rate"
            _refuse(f"{name}() of a 64-bit integer does not fit the numbers of C", span)


def _refuse_mixed(program: Program, condition: Condition, span: Span) -> None:
    """Reject comparisons in which C would convert a 64-bit integer to a narrower type."""
    values = compared(condition)
    types = {type_of(program, each) for each in values}
    if len(types) > 1 and any(_is_wide(program, each) for each in values):
        message = "a 64-bit integer is compared with a number of another type"
        _refuse(message, span, "C has no type that holds both: compare each with constants")


def _refuse_great(item: Trigger) -> None:
    for each in item.arguments:
        if isinstance(each, int) and each not in INT64:
            _refuse("an argument does not fit the integers of C", item.span)


def _is_wide(program: Program, value: ValueExpression) -> bool:
    """Return whether a value is an integer that a double does not hold."""
    match value:
        case Read():
            return program.leaves[value.leaf].type.base in ("int64", "uint64")
        case Apply() if FUNCTIONS[value.function].result is Result.ELEMENT:
            return _is_wide(program, value.arguments[0])
        case _:
            return False


def _durations(program: Program) -> Iterator[tuple[int, Span]]:
    for each in program.inputs:
        if each.timeout_ns is not None:
            yield each.timeout_ns, each.span
    for rule in program.rules:
        for value in walk.values(walk.parts(rule.condition)):
            if isinstance(value, Apply) and FUNCTIONS[value.function].over_span:
                span = value.arguments[1]
                assert isinstance(span, Const)
                assert isinstance(span.value, int)
                yield span.value, rule.span
        yield from _durations_of(rule.condition, rule.span)
    for behaviour in walk.behaviours(program):
        yield from _durations_of(behaviour.condition, behaviour.span)


def _durations_of(condition: Condition, span: Span) -> Iterator[tuple[int, Span]]:
    for part in walk.parts(condition):
        if isinstance(part, For):
            yield part.duration_ns, span
        elif isinstance(part, Age):
            yield part.bound_ns, span
        elif isinstance(part, Frequency):
            yield part.elapsed_ns, span
