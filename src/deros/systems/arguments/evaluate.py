"""What the expressions and conditions of a system mean, given the values of its arguments.

Numbers are calculated as Python does it: integers stay integers in ``+ - *``, and ``/`` gives a
double. Only numbers are compared by order. Of two values to choose from, the other one is not
calculated. Text in quotes may contain the values of texts and
integers; how a double or a bool is spelled is nobody's business but the reader's, so they may not.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Generic, TypeVar

from deros.diagnostics import Span
from deros.interfaces.types import INT64
from deros.models.arguments import (
    Argument,
    Calculation,
    Chosen,
    Compared,
    Condition,
    Expression,
    Holds,
    Interpolation,
    Joined,
    Literally,
    Lookup,
    Not,
    OneOf,
    Opposite,
    arguments_in,
    launch_text,
)
from deros.models.common import Scalar
from deros.models.launch_files import XacroFile
from deros.models.node import ParameterType
from deros.names.names import check_package_name

Values = Mapping[str, Scalar]
"""The values of arguments, by name, and of what has been looked up, by key."""

_CALCULATE: dict[str, Callable[[float, float], float]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}
COMPARE: dict[str, Callable[[Scalar, Scalar], bool]] = {
    "=": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,  # only numbers come here
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}

_WORDS = {
    ParameterType.BOOL: "a bool",
    ParameterType.INTEGER: "an integer",
    ParameterType.DOUBLE: "a double",
    ParameterType.STRING: "a text",
}


class CannotEvaluate(Exception):  # noqa: N818 - it is a fault of the model, not of the program
    """An expression or a condition has no value; ``missing``: an argument is unknown."""

    def __init__(self, message: str, span: Span, missing: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.span = span
        self.missing = missing


class Unavailable(str):
    """Stands for what could not be looked up, and says why: no expression with it has a value."""

    __slots__ = ()


About = TypeVar("About")


class AtStart(str, Generic[About]):
    """Stands for texts that depend on values of arguments, where a system is started.

    Such are the share folder of a package whose name is computed, and the path of a made file.
    """

    __slots__ = ("of",)

    def __new__(cls, of: Callable[[About], str]) -> AtStart[About]:
        """Return one that calls ``of`` with what the text is about; ValueError: there is none."""
        found = super().__new__(cls)
        found.of = of
        return found

    of: Callable[[About], str]


def type_of(value: Scalar) -> ParameterType:
    """Return the parameter type of a value."""
    if isinstance(value, bool):
        return ParameterType.BOOL
    if isinstance(value, str):
        return ParameterType.STRING
    return ParameterType.INTEGER if isinstance(value, int) else ParameterType.DOUBLE


def expression_type(found: Expression, types: Mapping[str, ParameterType]) -> ParameterType:
    """Return the type of an expression, of a choice between numbers the one that has both.

    Args:
        found: without faults.
        types: of the arguments that it uses.
    """
    match found:
        case Argument(name):
            return types.get(name, ParameterType.STRING)  # unknown ones are reported as such
        case Literally(value):
            return type_of(value)
        case Lookup():
            return type_of(found.usual)
        case Opposite(operand):
            return expression_type(operand, types)
        case Chosen(chosen=one, otherwise=other) | Calculation(left=one, right=other):
            both = {expression_type(one, types), expression_type(other, types)}
            is_double = isinstance(found, Calculation) and found.operator == "/"
            return ParameterType.DOUBLE if is_double or len(both) > 1 else both.pop()
    return ParameterType.STRING


def evaluate(found: Expression, values: Values) -> Scalar:
    """Return the value of an expression.

    Raises:
        CannotEvaluate: it uses an unknown argument, calculates with what is no number, divides by
            zero, or leaves the numbers that a parameter can hold.
    """
    match found:
        case Literally(value):
            return value
        case Lookup():
            looked_up = values.get(found.key, found.usual)
            if isinstance(looked_up, Unavailable):
                raise CannotEvaluate(looked_up, found.span)
            if found.made is not None and isinstance(looked_up, AtStart):
                return str(looked_up.of(_evaluated_file(found.made, values)))
            if found.name_from is not None:
                return _share(found, found.name_from, looked_up, values)
            return looked_up
        case Argument(name):
            if name not in values:
                raise CannotEvaluate(f"unknown argument '{name}'", found.span, name)
            return values[name]
        case Interpolation(pieces):
            return "".join(
                each if isinstance(each, str) else _text(each, values) for each in pieces
            )
        case Chosen(condition, chosen, otherwise):
            is_chosen = holds(condition, values)
            value = evaluate(chosen if is_chosen else otherwise, values)
            if type(value) is int and _is_double(otherwise if is_chosen else chosen, values):
                return float(value)
            return value
        case Opposite(operand):
            return _in_range(-_number(operand, values), found.span)
        case Calculation(word, left, right):
            one, other = _number(left, values), _number(right, values)
            if word == "/" and other == 0:
                raise CannotEvaluate("this divides by zero", right.span)
            try:
                return _in_range(_CALCULATE[word](one, other), found.span)
            except OverflowError:
                raise CannotEvaluate("number out of range", found.span) from None


def _is_double(found: Expression, values: Values) -> bool:
    uses = (each.name for each in arguments_in(found))
    types = {name: type_of(values[name]) for name in uses if name in values}
    return expression_type(found, types) is ParameterType.DOUBLE


def _share(found: Lookup, name: Expression, looked_up: Scalar, values: Values) -> str:
    package = evaluate(name, values)
    fault = check_package_name(package) if isinstance(package, str) else "is no text"
    if fault is not None:
        message = f"'{package}' cannot be the name of a package: it {fault}"
        raise CannotEvaluate(message, found.span)
    if isinstance(looked_up, AtStart):
        try:
            return str(looked_up.of(package))
        except ValueError as error:
            raise CannotEvaluate(str(error), found.span) from None
    return f"share:{package}"


def _evaluated_file(found: XacroFile, values: Values) -> XacroFile:
    path: Scalar = found.path
    if found.path_from is not None:
        path = evaluate(found.path_from, values)
    given = (
        each
        if each.value_from is None
        else replace(each, value=launch_text(evaluate(each.value_from, values)), value_from=None)
        for each in found.arguments
    )
    return replace(found, path=str(path), path_from=None, arguments=tuple(given))


def _number(found: Expression, values: Values) -> float:
    value = evaluate(found, values)
    if isinstance(value, bool | str):
        raise CannotEvaluate(f"this is {_WORDS[type_of(value)]}, not a number", found.span)
    return value


def _in_range(value: float, span: Span) -> float:
    fits = value in INT64 if isinstance(value, int) else not math.isnan(value)
    if not fits:
        raise CannotEvaluate("number out of range", span)
    return value


def _text(found: Expression, values: Values) -> str:
    value = evaluate(found, values)
    if isinstance(value, bool | float):
        name = found.span.text.strip("${}")
        message = f"'{name}' is {_WORDS[type_of(value)]}, of which several spellings exist"
        raise CannotEvaluate(message, found.span)
    return str(value)


def holds(found: Condition, values: Values) -> bool:
    """Return whether a condition holds.

    Raises:
        CannotEvaluate: it uses an unknown argument, or compares what cannot be compared.
    """
    match found:
        case Holds(operand):
            value = evaluate(operand, values)
            if not isinstance(value, bool):
                message = f"'{found.span.text}' is {_WORDS[type_of(value)]}, not a condition"
                raise CannotEvaluate(message, found.span)
            return value
        case Compared(word, left, right):
            one, other = evaluate(left, values), evaluate(right, values)
            _comparable(one, other, word, found.span)
            return COMPARE[word](one, other)
        case OneOf(operand, choices):
            value = evaluate(operand, values)
            for choice in choices:
                _comparable(value, choice.value, "=", choice.span)
            return any(value == choice.value for choice in choices)
        case Not(operand):
            return not holds(operand, values)
        case Joined(word, operands):
            # Each is evaluated, so that a fault shows whatever the others are.
            results = [holds(each, values) for each in operands]
            return all(results) if word == "and" else any(results)


def _comparable(one: Scalar, other: Scalar, word: str, span: Span) -> None:
    kinds = {_kind(one), _kind(other)}
    if len(kinds) > 1:
        message = f"{_WORDS[type_of(one)]} and {_WORDS[type_of(other)]} cannot be compared"
        raise CannotEvaluate(message, span)
    if word not in ("=", "!=") and kinds != {"number"}:
        message = f"'{word}' compares numbers, and this is {_WORDS[type_of(one)]}"
        raise CannotEvaluate(message, span)


def _kind(value: Scalar) -> str:
    kind = type_of(value)
    is_number = kind in (ParameterType.INTEGER, ParameterType.DOUBLE)
    return "number" if is_number else kind.value
