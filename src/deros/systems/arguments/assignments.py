"""The values that arguments may have, and their combinations.

Conditions tell only some values of an argument apart: those of a bool, those of ``one_of``, and the
sides of the constants that it is compared with. One value stands for each side, so the combinations
are finite. They are numbered by how many arguments differ from their defaults. A set of them is a
decision diagram, so that how many there are does not matter.
"""

from __future__ import annotations

import contextlib
import itertools
import math
from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence

from deros.models.arguments import Condition, Expression, Joined, Not, arguments_in
from deros.models.common import Interval, Scalar
from deros.models.node import Parameter, ParameterType
from deros.systems.arguments.diagrams import Assignments, Diagrams, TooManyCombinations
from deros.systems.arguments.evaluate import CannotEvaluate, holds
from deros.systems.arguments.numbering import Numbering
from deros.systems.arguments.scopes import Scope, points, usual_values
from deros.systems.arguments.told_apart import told_apart

MOST_CLASSES = 1 << 14
"""Combinations of the values in one comparison or expression, and forms of one part."""

_OTHER = "other"


class MadeUp(str):
    """A text that stands for all those that conditions do not name."""

    __slots__ = ()


_Decided = tuple[Assignments, Assignments]
"""The assignments for which a condition holds, and those for which it cannot be evaluated."""


class Space:
    """All combinations of the values that conditions and expressions tell apart.

    Attributes:
        values: of each argument that varies, its usual one first.
        count: of all combinations.
        everything: the set of all assignments.
        nothing: the empty set.
    """

    def __init__(self, values: Mapping[str, Sequence[Scalar]]) -> None:
        """Number the combinations of ``values``."""
        self.values = {name: tuple(found) for name, found in values.items() if len(found) > 1}
        sizes = [len(found) for found in self.values.values()]
        self._places = {name: place for place, name in enumerate(self.values)}
        self._diagrams = Diagrams(sizes)
        self._numbering = Numbering(sizes)
        self.count = self._numbering.count
        self.everything = self._diagrams.full
        self.nothing = self._diagrams.empty
        self._by_number: dict[int, dict[int, int]] = {}
        self._known: dict[tuple[int, int], tuple[_Decided, Condition, Scope]] = {}

    def classes(self, names: Iterable[str]) -> Iterator[tuple[dict[str, Scalar], Assignments]]:
        """Yield each combination of the values of some arguments, with its assignments.

        Raises:
            TooManyCombinations: there are more than :data:`MOST_CLASSES`.
        """
        wanted = set(names)
        varied = [name for name in self.values if name in wanted]
        if math.prod(len(self.values[name]) for name in varied) > MOST_CLASSES:
            raise TooManyCombinations
        places = [self._places[name] for name in varied]
        for chosen in itertools.product(*(enumerate(self.values[name]) for name in varied)):
            positions = dict(zip(places, (position for position, _ in chosen), strict=True))
            values = dict(zip(varied, (value for _, value in chosen), strict=True))
            yield values, self._diagrams.cube(positions)

    def classes_of(
        self, found: Expression | Condition, scope: Scope
    ) -> Iterator[tuple[dict[str, Scalar], Assignments]]:
        """Yield each combination of the arguments that decide the value of an expression.

        Raises:
            TooManyCombinations: there are more than :data:`MOST_CLASSES`.
        """
        try:
            yield from self.classes(self._deciding(found, scope))
        except TooManyCombinations:
            raise TooManyCombinations(found.span) from None

    def _deciding(self, found: Expression | Condition, scope: Scope) -> set[str]:
        """Return the arguments that decide a value, also through the defaults of others."""
        waiting = list(scope.origins(each.name for each in arguments_in(found)))
        while scope.outer is not None:
            scope = scope.outer
        defaults = {each.name: each.default_from for each in scope.arguments}
        names: set[str] = set()
        while waiting:
            name = waiting.pop()
            default = defaults.get(name)
            if default is not None and name not in names and name not in self.values:
                waiting += (each.name for each in arguments_in(default))
            names.add(name)
        return names

    def decided(self, condition: Condition, scope: Scope) -> _Decided:
        """Return where a condition holds, and where it cannot be evaluated.

        Args:
            condition: of the system at one place where it is used.
            scope: the arguments at that place.

        Raises:
            TooManyCombinations: one comparison depends on too many arguments.
        """
        key = id(condition), id(scope)
        if key not in self._known:  # with both, so that the ids remain theirs
            self._known[key] = self._decide(condition, scope), condition, scope
        return self._known[key][0]

    def _decide(self, condition: Condition, scope: Scope) -> _Decided:
        if isinstance(condition, Not):
            holding, failing = self.decided(condition.operand, scope)
            return self.everything - holding - failing, failing
        if isinstance(condition, Joined):
            operands = [self.decided(each, scope) for each in condition.operands]
            is_all = condition.word == "and"
            holding, failing = self.everything if is_all else self.nothing, self.nothing
            for each, fails in operands:
                holding = holding & each if is_all else holding | each
                failing |= fails  # whatever the others are, as evaluated
            return holding - failing, failing
        holding, known = self.nothing, self.nothing
        for values, mask in self.classes_of(condition, scope):
            with contextlib.suppress(CannotEvaluate):
                if holds(condition, scope.values(values)):
                    holding |= mask
                known |= mask
        return holding, self.everything - known

    def where(self, condition: Condition, scope: Scope) -> Assignments:
        """Return the assignments in which a condition holds.

        Raises:
            CannotEvaluate: it does not hold or fail to for all of them.
            TooManyCombinations: one comparison depends on too many arguments.
        """
        holding, failing = self.decided(condition, scope)
        if failing:
            holds(condition, scope.values(self.assignment(self.smallest(failing))))
        return holding

    def smallest(self, found: Assignments) -> int:
        """Return the number of the assignment of a set in which the fewest arguments differ."""
        return self._numbering.number(found.smallest)

    def assignment(self, number: int) -> dict[str, Scalar]:
        """Return the values of the arguments that vary."""
        values = {name: found[0] for name, found in self.values.items()}
        return {**values, **self.difference(number)}

    def difference(self, number: int, other: int = 0) -> dict[str, Scalar]:
        """Return the values of an assignment that another, by default the usual one, has not."""
        one, two = self._positions(number), self._positions(other)
        return {
            name: found[one.get(place, 0)]
            for place, (name, found) in enumerate(self.values.items())
            if one.get(place, 0) != two.get(place, 0)
        }

    def _positions(self, number: int) -> dict[int, int]:
        if number not in self._by_number:
            _, places, positions = self._numbering.deviation(number)
            self._by_number[number] = dict(zip(places, positions, strict=True))
        return self._by_number[number]


# What conditions tell apart -----------------------------------------------------------------------


def space_of(
    arguments: Sequence[Parameter],
    used: Container[str],
    conditions: Iterable[tuple[Scope, Condition]],
) -> Space:
    """Return the space of the arguments that are used, as far as conditions tell values apart."""
    compared, usual = told_apart(arguments, conditions), usual_values(arguments)
    return Space(
        {
            each.name: _apart(each, usual[each.name], compared[each.name])
            for each in arguments
            if each.name in used
        }
    )


def _close_to_bounds(constants: Iterable[float], bounds: Interval | None) -> Iterator[float]:
    """Yield what lies between a bound and the constant next to it, where a step leads out."""
    ordered = sorted(filter(math.isfinite, constants))
    if bounds is None or not ordered:
        return
    for bound, nearest, step in (bounds.lower, ordered[0], -1), (bounds.upper, ordered[-1], 1):
        if nearest in bounds and bound != nearest and nearest + step not in bounds:
            yield (bound + nearest) / 2


def _apart(argument: Parameter, usual: Scalar, constants: Collection[Scalar]) -> tuple[Scalar, ...]:
    """Return the values of an argument that are told apart, its usual one first."""
    if argument.type is ParameterType.BOOL:
        return usual, not usual
    if argument.choices is not None:
        return tuple(dict.fromkeys((usual, *argument.choices)))
    if not constants:
        return (usual,)
    if argument.type is ParameterType.STRING:
        texts = sorted(each for each in constants if isinstance(each, str))
        others = (f"{_OTHER}{number or ''}" for number in itertools.count())
        other: Scalar = usual
        if usual in texts:
            other = MadeUp(next(each for each in others if each not in texts))
        return tuple(dict.fromkeys((usual, *texts, other)))
    numbers = [float(each) for each in constants if not isinstance(each, str | bool)]
    close = list(_close_to_bounds(numbers, argument.interval))
    if isinstance(usual, int | float):
        numbers.append(float(usual))
    if not any(map(math.isfinite, numbers)):
        numbers.append(0.0)
    finite = [*points(numbers), *close]
    found: Iterable[Scalar] = [*finite, *filter(math.isinf, numbers)]
    if argument.type is ParameterType.INTEGER:
        found = sorted({math.floor(each) for each in finite})
    bounds = argument.interval
    allowed = [
        each for each in found if bounds is None or (not isinstance(each, str) and each in bounds)
    ]
    return tuple(dict.fromkeys((usual, *allowed)))
