"""The values that arguments may have, and their combinations.

Conditions tell only some values of an argument apart: those of a bool, those of ``one_of``, and the
sides of the constants that it is compared with. One value stands for each side, so the combinations
are finite. They are numbered by how many arguments differ from their defaults, and a set of them is
an integer with a bit for each: the lowest bit of a set is the smallest assignment in it.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Collection, Container, Iterable, Iterator, Mapping, Sequence

from deros.models.arguments import Condition, arguments_in
from deros.models.common import Scalar
from deros.models.node import Parameter, ParameterType
from deros.systems.arguments.evaluate import holds
from deros.systems.arguments.scopes import Scope, points, usual_values
from deros.systems.arguments.told_apart import told_apart

MOST_COMBINATIONS = 1 << 14
"""More are not enumerated."""

_OTHER = "other"


class MadeUp(str):
    """A text that stands for all those that conditions do not name."""

    __slots__ = ()


Given = Callable[[Mapping[str, Scalar]], Mapping[str, Scalar]]


class Space:
    """All combinations of the values that conditions and expressions tell apart.

    Attributes:
        values: of each argument that varies, its usual one first.
        everything: the set of all assignments.
        is_complete: whether all combinations are in it; else only those in which few arguments
            differ from their usual values.
    """

    def __init__(self, values: Mapping[str, Sequence[Scalar]]) -> None:
        """Number the combinations of ``values``."""
        self.values = {name: tuple(found) for name, found in values.items() if len(found) > 1}
        self._assignments, self.is_complete = _combinations(tuple(self.values.values()))
        self.everything = (1 << len(self._assignments)) - 1
        self._masks = dict(zip(self.values, self._columns(), strict=True))

    def _columns(self) -> Iterator[dict[Scalar, int]]:
        """Yield for each argument the set of assignments in which it has each of its values."""
        for place, found in enumerate(self.values.values()):
            column = [assignment[place] for assignment in reversed(self._assignments)]
            yield {
                value: int("".join("01"[each == position] for each in column), 2)
                for position, value in enumerate(found)
            }

    def classes(self, names: Iterable[str]) -> Iterator[tuple[dict[str, Scalar], int]]:
        """Yield each combination of the values of some arguments, with its assignments."""
        wanted = set(names)
        varied = [name for name in self.values if name in wanted]
        for chosen in itertools.product(*(self.values[name] for name in varied)):
            found = dict(zip(varied, chosen, strict=True))
            mask = self.everything
            for name, value in found.items():
                mask &= self._masks[name][value]
            if mask:
                yield found, mask

    def where(self, condition: Condition, given: Given) -> int:
        """Return the assignments in which a condition holds.

        Args:
            condition: of the outermost system.
            given: returns the values of all arguments, given those of the ones that vary.

        Raises:
            CannotEvaluate: it does not hold or fail to for all of them.
        """
        classes = self.classes(each.name for each in arguments_in(condition))
        return sum(mask for values, mask in classes if holds(condition, given(values)))

    def smallest(self, mask: int) -> int:
        """Return the number of the assignment of a set in which the fewest arguments differ."""
        return (mask & -mask).bit_length() - 1

    def assignment(self, number: int) -> dict[str, Scalar]:
        """Return the values of the arguments that vary."""
        positions = self._assignments[number]
        return {
            name: found[position]
            for (name, found), position in zip(self.values.items(), positions, strict=True)
        }

    def difference(self, number: int, other: int = 0) -> dict[str, Scalar]:
        """Return the values of an assignment that another, by default the usual one, has not."""
        one, two = self.assignment(number), self.assignment(other)
        return {name: value for name, value in one.items() if value != two[name]}


def _combinations(values: Sequence[Sequence[Scalar]]) -> tuple[list[tuple[int, ...]], bool]:
    """Return combinations by the positions of their values, the usual one first."""
    found: list[tuple[int, ...]] = []
    for count in range(len(values) + 1):
        for places in itertools.combinations(range(len(values)), count):
            others = (range(1, len(values[place])) for place in places)
            for positions in itertools.product(*others):
                if len(found) == MOST_COMBINATIONS:
                    return found, False
                by_place = dict(zip(places, positions, strict=True))
                found.append(tuple(by_place.get(place, 0) for place in range(len(values))))
    return found, True


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
    if isinstance(usual, int | float):
        numbers.append(float(usual))
    if not any(map(math.isfinite, numbers)):
        numbers.append(0.0)
    found: Iterable[Scalar] = [*points(numbers), *filter(math.isinf, numbers)]
    if argument.type is ParameterType.INTEGER:
        found = sorted({math.floor(each) for each in points(numbers)})
    bounds = argument.interval
    allowed = [
        each for each in found if bounds is None or (not isinstance(each, str) and each in bounds)
    ]
    return tuple(dict.fromkeys((usual, *allowed)))
