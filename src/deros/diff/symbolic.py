"""One version of a system at run time, in terms of its arguments: what its comparison reads."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass

from deros.diff.expressions import conjuncts, expression_text, piece_text
from deros.diff.texts import joined as listed
from deros.diff.texts import value_text
from deros.models.arguments import Condition, Expression
from deros.models.common import Value
from deros.models.system import System
from deros.systems.arguments.symbolic import (
    SymbolicNode,
    SymbolicSystem,
    SymbolicTopic,
    as_written,
    joined,
)
from deros.systems.flatten import flatten


class Version:
    """One version of a system: its programs and declared topics, and their texts."""

    def __init__(self, system: System) -> None:
        """Expand ``system``, which is without errors.

        Raises:
            TooManyCombinations: of the arguments that its conditions depend on.
        """
        self.system = system
        self._symbolic = SymbolicSystem(system) if system.is_computed else None
        if self._symbolic is None:
            flat = flatten(system)
            self.programs = tuple(SymbolicNode(each, None) for each in flat.parts)
            self.topics = tuple(SymbolicTopic(each, None) for each in flat.topics)
        else:
            self.programs, self.topics = self._symbolic.nodes, self._symbolic.topics

    def name(self, name: str) -> str:
        """Return a graph name, with what is computed in ``${…}``."""
        return "".join(map(piece_text, self._pieces(joined(name))))

    def text(self, text: str) -> str:
        """Return a text without quotes, with what is computed in ``${…}``."""
        return "".join(map(piece_text, self._pieces(as_written(text))))

    def value(self, value: Value) -> str:
        """Return the value of a parameter as systems write it."""
        if isinstance(value, tuple):
            return f"[{listed(map(self.value, value))}]"
        if not isinstance(value, str):
            return value_text(value)
        pieces = self._pieces(as_written(value))
        if all(isinstance(each, str) for each in pieces):
            return value_text("".join(map(str, pieces)))
        if len(pieces) == 1 and not isinstance(pieces[0], str):
            return expression_text(pieces[0])
        return f'"{"".join(map(piece_text, pieces))}"'

    def _pieces(self, text: str) -> tuple[str | Expression, ...]:
        return (text,) if self._symbolic is None else self._symbolic.pieces(text)


@dataclass(frozen=True, slots=True)
class Way:
    """One of the ways in which something may be there: a value, and the conditions of it."""

    value: str
    when: frozenset[str]


def common(conditions: Iterable[frozenset[str]]) -> frozenset[str]:
    """Return the conditions that hold in all ways."""
    found = list(conditions)
    return frozenset.intersection(*found) if found else frozenset()


def in_ways(ways: Iterable[Way], every: Collection[frozenset[str]]) -> Iterator[str]:
    """Yield each value once, sorted, with the conditions in which something has it.

    Args:
        ways: the values.
        every: the conditions of all ways in which that something is there. What holds in all of
            them is not said again.
    """
    known = common(every)
    conditions: dict[str, list[frozenset[str]]] = {}
    for way in ways:
        conditions.setdefault(way.value, []).append(way.when)
    for value, when in sorted(conditions.items()):
        needed = common(when) - known
        if needed:
            yield f"{value} when {condition_list(needed)}"
        elif len(set(when)) < len(set(every)):
            either = sorted(condition_list(each - known) for each in set(when))
            yield f"{value} when {' or '.join(either)}"
        else:
            yield value


def condition_list(conditions: Iterable[str]) -> str:
    """Return conditions that all hold as one."""
    return " and ".join(sorted(conditions))


def when_of(condition: Condition | None) -> frozenset[str]:
    """Return the conditions that together make up one."""
    return conjuncts(condition)
