"""The values of arguments at which a comparison may turn, whatever lies between it and them.

A condition in a used system compares an argument that gets ``$speed * 2``, so it is the half of its
constant that tells the values of ``speed`` apart. Each use of an argument is solved for by itself,
with all others at their usual values, their bounds, or what other comparisons tell apart: exact
where an argument occurs once in a comparison, as nearly all do.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

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
    Not,
    OneOf,
    Opposite,
    arguments_in,
)
from deros.models.common import Scalar
from deros.models.node import Parameter
from deros.models.terms import ArithmeticOperator
from deros.systems.arguments.evaluate import CannotEvaluate, Values, evaluate
from deros.systems.arguments.scopes import Scope, points, usual_values

_ROUNDS = 3
"""What one comparison tells apart counts for those that it shares an argument with, so far; in the
last round with the values between, so that two arguments can both lie beyond a constant, apart."""

_MOST = 32
"""Values of one argument; more would give combinations that nobody can check."""

_Found = Mapping[str, Mapping[Scalar, None]]
"""Values by argument, in the order found: what does not depend on hashes is the same each time."""


def told_apart(
    arguments: Sequence[Parameter], conditions: Iterable[tuple[Scope, Condition]]
) -> Mapping[str, Collection[Scalar]]:
    """Return for each argument of the outermost system the values that comparisons tell apart.

    Args:
        arguments: of the outermost system.
        conditions: each with the place where it is written.
    """
    comparisons = [each for scope, found in conditions for each in _comparisons(scope, found)]
    found: dict[str, dict[Scalar, None]] = {each.name: {} for each in arguments}
    bounds = {each.name: dict.fromkeys(_bounds(each)) for each in arguments}
    usual = usual_values(arguments)
    for left in reversed(range(_ROUNDS)):
        known = (
            found if left else {name: _between(each, usual[name]) for name, each in found.items()}
        )
        for each in comparisons:
            for name, value in list(each.turns(known, bounds)):
                if name in found and len(found[name]) < _MOST and _is_possible(value):
                    found[name][value] = None
    return found


def _between(constants: Mapping[Scalar, None], usual: Scalar) -> Mapping[Scalar, None]:
    """Return constants, and numbers on all sides of them and of the usual one."""
    numbers = [float(each) for each in (*constants, usual) if not isinstance(each, str)]
    return dict.fromkeys((*constants, *points(numbers))) if constants else constants


def _is_possible(value: Scalar) -> bool:
    """Return whether a value is one that some argument can have."""
    return isinstance(value, str | float) or abs(value) <= sys.float_info.max


def _bounds(argument: Parameter) -> Iterator[Scalar]:
    """Yield the values between which, or at which alone, an argument may lie."""
    yield from argument.choices or ()
    if argument.interval is not None:
        yield from filter(math.isfinite, (argument.interval.lower, argument.interval.upper))


def choices_in(scope: Scope, found: Expression) -> Iterator[tuple[Scope, Condition]]:
    """Yield the conditions by which values in an expression are chosen, each with its place."""
    match found:
        case Argument(name):
            meaning = scope.meaning(name)
            if meaning is not None:
                yield from choices_in(meaning[1], meaning[0])
        case Interpolation(pieces):
            for each in pieces:
                if not isinstance(each, str):
                    yield from choices_in(scope, each)
        case Calculation(left=left, right=right):
            yield from choices_in(scope, left)
            yield from choices_in(scope, right)
        case Opposite(operand):
            yield from choices_in(scope, operand)
        case Chosen(condition, chosen, otherwise):
            yield scope, condition
            yield from choices_in(scope, chosen)
            yield from choices_in(scope, otherwise)


def _comparisons(scope: Scope, found: Condition) -> Iterator[_Comparison]:
    match found:
        case Holds(operand):
            yield from _of_choices(scope, operand)
        case Compared(left=left, right=right):
            yield _Comparison(scope, left, right)
            yield from _of_choices(scope, left)
            yield from _of_choices(scope, right)
        case OneOf(operand, choices):
            yield from _of_choices(scope, operand)
            yield from (_Comparison(scope, operand, choice) for choice in choices)
        case Not(operand):
            yield from _comparisons(scope, operand)
        case Joined(operands=operands):
            for each in operands:
                yield from _comparisons(scope, each)


def _of_choices(scope: Scope, found: Expression) -> Iterator[_Comparison]:
    for place, condition in choices_in(scope, found):
        yield from _comparisons(place, condition)


@dataclass(frozen=True, slots=True)
class _Comparison:
    """Two sides that are compared at one place where a system is used."""

    scope: Scope
    left: Expression
    right: Expression

    def turns(self, found: _Found, bounds: _Found) -> Iterator[tuple[str, Scalar]]:
        """Yield values of arguments at which the sides are equal, and, of several, their bounds."""
        uses = (*arguments_in(self.left), *arguments_in(self.right))
        names = list(dict.fromkeys(self.scope.origins(each.name for each in uses)))
        others: list[Values] = [{}]
        if len(names) > 1:
            for name in names:
                limits = bounds.get(name, {})
                yield from ((name, value) for value in limits)
                others += ({name: value} for value in (*limits, *found.get(name, ())))
        for values in others if names else ():
            yield from self._equal(self.left, self.right, values)
            yield from self._equal(self.right, self.left, values)

    def _equal(
        self, side: Expression, other: Expression, outermost: Values
    ) -> Iterator[tuple[str, Scalar]]:
        try:
            target = evaluate(other, self.scope.values(outermost))
            yield from _solved(side, target, self.scope, outermost)
        except (CannotEvaluate, OverflowError):
            return  # the first is reported where it is written


def _solved(
    found: Expression, target: Scalar, scope: Scope, outermost: Values
) -> Iterator[tuple[str, Scalar]]:
    """Yield arguments of the outermost system, with the value that makes an expression ``target``.

    Raises:
        CannotEvaluate: a part of the expression has no value.
    """
    match found:
        case Argument(name):
            if scope.outer is None:
                yield name, target
                return
            meaning = scope.meaning(name)
            if meaning is not None:
                yield from _solved(meaning[0], target, meaning[1], outermost)
        case Interpolation(pieces) if isinstance(target, str):
            yield from _solved_text(pieces, target, scope, outermost)
        case Chosen(chosen=chosen, otherwise=otherwise):
            yield from _solved(chosen, target, scope, outermost)
            yield from _solved(otherwise, target, scope, outermost)
        case Opposite(operand) if not isinstance(target, str):
            yield from _solved(operand, -target, scope, outermost)
        case Calculation(word, left, right) if not isinstance(target, str):
            values = scope.values(outermost)
            for side, other, is_left in ((left, right, True), (right, left, False)):
                known = evaluate(other, values)
                if not isinstance(known, str):
                    for value in _undone(word, target, known, is_left):
                        yield from _solved(side, value, scope, outermost)


def _undone(
    word: ArithmeticOperator, target: float, known: float, is_left: bool
) -> Iterator[float]:
    """Yield the operand on one side that gives ``target`` with the ``known`` one on the other."""
    if word == "+":
        yield target - known
    elif word == "-":
        yield target + known if is_left else known - target
    elif word == "*" and known:
        yield target / known
    elif word == "/" and is_left:
        yield target * known
    elif word == "/":
        yield 0  # where the quotient changes its sign
        if target:
            yield known / target


def _solved_text(
    pieces: Sequence[str | Expression], target: str, scope: Scope, outermost: Values
) -> Iterator[tuple[str, Scalar]]:
    values = scope.values(outermost)
    texts = [each if isinstance(each, str) else str(evaluate(each, values)) for each in pieces]
    for place, piece in enumerate(pieces):
        before, behind = "".join(texts[:place]), "".join(texts[place + 1 :])
        fits = len(before) + len(behind) <= len(target)
        if isinstance(piece, str) or not fits or not target.startswith(before):
            continue
        if target.endswith(behind):
            text = target[len(before) : len(target) - len(behind)]
            is_number = text.isascii() and text.removeprefix("-").isdigit()
            yield from _solved(piece, text, scope, outermost)
            if is_number:
                yield from _solved(piece, int(text), scope, outermost)
