"""Checks for unhandled unknown values and unused timeouts."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Container, Iterable, Iterator
from dataclasses import replace

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models import rules
from deros.rules.compiler.scope.resolved import AppliedFunction
from deros.rules.functions.functions import FUNCTIONS, Argument
from deros.rules.program import ir, walk
from deros.validators.rules.losses.rules_losses import (
    Function,
    Key,
    header_of,
    key_of,
    key_of_input,
)
from deros.validators.rules.losses.rules_noticed import Answer, Noticed


def check_unknown(
    written: rules.Rules,
    program: ir.Program,
    noticed: Noticed,
    functions: Iterable[AppliedFunction],
) -> Iterator[Diagnostic]:
    """Yield the findings about unknown values in rules without errors."""
    yield from _unnoticed(program, noticed, functions)
    yield from _unasked(written, program, noticed)


# Functions that are unknown of known messages ---------------------------------------------------


def _unnoticed(
    program: ir.Program, noticed: Noticed, functions: Iterable[AppliedFunction]
) -> Iterator[Diagnostic]:
    """Yield one finding per rule and function whose loss no rule detects."""
    fallible = sorted((each for each in functions if _is_fallible(each, noticed.nan)), key=_start)
    starts = [_start(each) for each in fallible]
    for rule in noticed.used.rules:
        if isinstance(rule.condition, ir.Failsafe) or rule.index not in noticed.used.exposed:
            continue
        reported: set[Key] = set()
        read = [part for part in walk.parts(rule.condition) if not isinstance(part, ir.Unknown)]
        asked = {key_of(each) for each in walk.values(read) if isinstance(each, Function)}
        first, end = (bisect_left(starts, place) for place in (rule.span.start, rule.span.end))
        for each in fallible[first:end]:
            key = key_of(each.expression)
            if key not in asked or key in reported:
                continue
            again = _starts_over(each.expression)
            answer = noticed.answer_to(key, rule.index, at_once=again)
            if again and answer != "noticed":
                answer = noticed.answer_to_unknown(_input_of(each), rule.index, at_once=True)
            if answer != "noticed" and (nearest := _nearest_of(each.expression)) is not None:
                answer = noticed.answer_to(key_of(nearest), rule.index)
            if answer == "noticed":
                continue
            reported.add(key)
            yield _unreacted(program, rule, each, answer)


_REACTIONS: dict[Answer, str] = {
    "none": "no rule reacts to that",
    "conditional": "whether a rule reacts to that depends on other conditions",
    "logged": "that is only logged",
}


def _unreacted(
    program: ir.Program, rule: ir.Rule, each: AppliedFunction, answer: Answer
) -> Diagnostic:
    when = f"while {_reason(each)}"
    hint = f"write 'failsafe {rule.name}: …'"
    related: tuple[Related, ...] = ()
    if isinstance(each.expression, ir.Apply):
        hint += f", or use '{each.span.text}.unknown()' in a rule"
        owner = program.inputs[each.expression.input]
        related = (Related(owner.span, "its messages still arrive: it is not missing"),)
        if _starts_over(each.expression):
            # As a failsafe rule it would act at each start, before there is a message before.
            when = f"at the message after a NaN, where '{each.span.text}' starts over"
            hint = f"use '{owner.name}.unknown()' in a rule"
    message = f"'{rule.full_name}' is unknown {when}, and {_REACTIONS[answer]}"
    return report(codes.UNHANDLED_UNKNOWN, message, each.span, hint, related)


def _start(function: AppliedFunction) -> int:
    return function.span.start


def _is_fallible(function: AppliedFunction, nan: Container[int]) -> bool:
    """Return whether a function can be unknown for a valid message; ``nan``: inputs with NaN."""
    if isinstance(function.expression, ir.Compute):
        return bool(function.unknown_while)
    match FUNCTIONS[function.expression.function].argument:
        case Argument.QUATERNION | Argument.SCAN | Argument.STAMPED:
            return True
        case Argument.NUMBERS | Argument.ENTRIES:
            return not (function.type.array == "fixed" and function.type.size)
        case _:
            if _starts_over(function.expression):
                return function.expression.input in nan
            return bool(header_of(function.expression))


def _nearest_of(function: Function) -> ir.Apply | None:
    """Return the nearest range of a sector whose blindness is asked for: unknown without beams."""
    if isinstance(function, ir.Apply) and function.function in ("blind", "blind_gap"):
        return replace(function, function="nearest")
    return None


def _starts_over(function: Function) -> bool:
    """Return whether a function remembers messages, and nothing but a NaN makes it forget them."""
    if isinstance(function, ir.Compute) or header_of(function):
        return False
    row = FUNCTIONS[function.function]
    remembers = row.step is not None or row.memory is not None
    return remembers and (row.is_written or row.over_span)


def _input_of(function: AppliedFunction) -> int:
    assert isinstance(function.expression, ir.Apply)
    return function.expression.input


def _reason(function: AppliedFunction) -> str:
    if isinstance(function.expression, ir.Compute):
        return function.unknown_while
    match FUNCTIONS[function.expression.function].argument:
        case Argument.QUATERNION:
            return "the quaternion has length zero"
        case Argument.SCAN:
            if function.expression.zone is not None:
                return "most beams to the zone are blind"
            is_nearest = FUNCTIONS[function.expression.function].told
            return (
                "most beams of the sector are blind" if is_nearest else "no beam is in the sector"
            )
        case Argument.STAMPED:
            return "the header stamp is zero"
        case Argument.NUMBER:
            return "the header stamps do not advance"
        case Argument.ENTRIES if len(function.expression.arguments) > 1:
            return "the arrays are empty or differ in length"
        case _:
            return "the array is empty"


# Timeouts ---------------------------------------------------------------------------------------


def _unasked(written: rules.Rules, program: ir.Program, noticed: Noticed) -> Iterator[Diagnostic]:
    """Yield one finding per input whose timeout no rule of a behaviour uses."""
    aged: set[int] = set()
    for rule in noticed.used.rules:
        aged.update(part.input for part in walk.parts(rule.condition) if isinstance(part, ir.Age))
    names = {each.name.text: each.name for each in reversed(written.inputs)}
    for each in program.inputs:
        if each.timeout_ns is None or each.name not in names:
            continue
        # Before the first message there is no age, so age() does not detect that none arrives.
        when = f"messages on {each.topic} {'never arrive' if each.index in aged else 'stop'}"
        answer = noticed.answer_to(key_of_input("silence", each.index))
        if answer == "noticed" and each.index in noticed.nan:
            answer = noticed.answer_to(key_of_input("nan", each.index))
            when = "it is NaN"
        if answer != "noticed":
            yield _unused(each.name, names[each.name].span, when, answer)


def _unused(name: str, span: Span, when: str, answer: Answer) -> Diagnostic:
    """Return the finding about an input whose loss leads to too little."""
    message = f"no rule notices that '{name}' is unknown: when {when}, nothing reacts"
    hint = f"react to '{name}.missing()' or '{name}.unknown()', or declare a rule on it 'failsafe'"
    if answer == "logged":
        message = f"that '{name}' is unknown is only logged: when {when}, no action runs"
        hint = f"run an action on '{name}.missing()' or '{name}.unknown()' as well"
    elif answer == "conditional":
        message = (
            f"not everywhere is it noticed that '{name}' is unknown: when {when}, it depends on"
            " other conditions whether anything reacts"
        )
        hint = (
            f"ask '{name}.missing()' or '{name}.unknown()' beside each rule that reads '{name}',"
            " with 'or', and under no other conditions than that rule"
        )
    return report(codes.UNUSED_TIMEOUT, message, span, hint)
