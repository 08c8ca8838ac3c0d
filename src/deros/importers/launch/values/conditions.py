"""Values and conditions of a launch file, as simple as they can be."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import takewhile
from typing import Literal

from deros.diagnostics import SourceFile, Span
from deros.importers.launch.values.substitutions import InexpressibleError
from deros.models.arguments import (
    Chosen,
    Compared,
    Condition,
    Expression,
    Holds,
    Interpolation,
    Joined,
    Literally,
    Not,
    merged,
)

NOWHERE = Span(SourceFile("", ""), 0, 0)
_TRUE = frozenset({"true", "1"})
_FALSE = frozenset({"false", "0"})


def literally(value: bool | int | float | str) -> Literally:
    """Return a value as an expression."""
    return Literally(value, NOWHERE)


def text_of(pieces: tuple[str | Expression, ...]) -> Expression:
    """Return a text as an expression, the simplest that it can be."""
    found = merged(pieces)
    if not found:
        return literally("")
    if len(found) == 1:
        return literally(found[0]) if isinstance(found[0], str) else found[0]
    return Interpolation(found, NOWHERE)


def truth(condition: Condition | bool, words: tuple[str, str] = ("true", "false")) -> Expression:
    """Return a condition as the text that it is."""
    if isinstance(condition, bool):
        return literally(words[0] if condition else words[1])
    return Chosen(condition, literally(words[0]), literally(words[1]), NOWHERE)


def holds(value: Expression) -> Condition | bool:
    """Return when a value is true, as launch takes texts.

    Raises:
        InexpressibleError: it is neither true nor false.
    """
    if isinstance(value, Literally):
        word = str(value.value).strip().lower()
        if word not in _TRUE | _FALSE:
            raise InexpressibleError(f"is neither true nor false: '{value.value}'")
        return word in _TRUE
    if isinstance(value, Chosen):
        chosen, otherwise = holds(value.chosen), holds(value.otherwise)
        first = all_of((value.condition, chosen))
        return any_of((first, all_of((negated(value.condition), otherwise))))
    return Holds(value, NOWHERE)


def negated(found: Condition | bool) -> Condition | bool:
    """Return when a condition does not hold."""
    if isinstance(found, bool):
        return not found
    if isinstance(found, Not):
        return found.operand
    if isinstance(found, Compared) and found.operator in ("=", "!="):
        return Compared("!=" if found.operator == "=" else "=", found.left, found.right, NOWHERE)
    return Not(found, NOWHERE)


def all_of(operands: Iterable[Condition | bool]) -> Condition | bool:
    """Return when all of some conditions hold."""
    return _joined("and", operands, False)


def any_of(operands: Iterable[Condition | bool]) -> Condition | bool:
    """Return when at least one of some conditions holds."""
    return _joined("or", operands, True)


def compared(operator: Literal["=", "!="], left: Expression, right: Expression) -> Condition | bool:
    """Return when two values are equal, or differ; what both begin with does not matter."""
    left, right = _without_common_start(left, right)
    if isinstance(left, Literally) and not isinstance(right, Literally):
        left, right = right, left
    if isinstance(left, Literally) and isinstance(right, Literally):
        return (str(left.value) == str(right.value)) == (operator == "=")
    if isinstance(left, Chosen) and isinstance(right, Literally):
        inner = left.condition
        chosen = compared(operator, left.chosen, right)
        otherwise = compared(operator, left.otherwise, right)
        return any_of((all_of((inner, chosen)), all_of((negated(inner), otherwise))))
    return Compared(operator, left, right, NOWHERE)


def _without_common_start(left: Expression, right: Expression) -> tuple[Expression, Expression]:
    first, second = merged((left,)), merged((right,))
    if first[:1] and second[:1] and isinstance(first[0], str) and isinstance(second[0], str):
        pairs = takewhile(lambda pair: pair[0] == pair[1], zip(first[0], second[0], strict=False))
        start = sum(1 for _ in pairs)
        if start and (len(first) > 1 or len(second) > 1):
            return (
                text_of((first[0][start:], *first[1:])),
                text_of((second[0][start:], *second[1:])),
            )
    return left, right


def _joined(
    word: Literal["and", "or"], operands: Iterable[Condition | bool], decides: bool
) -> Condition | bool:
    """Return conditions joined; one that ``decides`` makes the others irrelevant."""
    found: list[Condition] = []
    for each in operands:
        if isinstance(each, bool):
            if each is decides:
                return decides
        elif each not in found:
            found.append(each)
    if not found:
        return not decides
    return found[0] if len(found) == 1 else Joined(word, tuple(found), NOWHERE)
