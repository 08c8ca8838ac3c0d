"""Sets of assignments as decision diagrams: how large they are depends on what they say.

A set of assignments of 40 arguments has billions of members, but ``a and not b`` looks at two of
them. A node of a diagram is an argument, with a branch for each of its values; arguments that do
not matter are left out, and equal nodes are one, so that sets are equal if their nodes are
(R. E. Bryant, *Graph-Based Algorithms for Boolean Function Manipulation*, 1986).

The smallest assignment of a set stands at its node, and is the same in each run. An SMT solver has
to search for it, for milliseconds each time, and would be the largest dependency by far.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from deros.diagnostics import Span

_EMPTY, _FULL = 0, 1

MOST_STEPS = 1 << 22
"""Of work on the sets of one space; some seconds. Only conditions made for it need more."""

Deviation = tuple[int, tuple[int, ...], tuple[int, ...]]
"""How an assignment differs from the usual one: in how many places, in which, with which values.

Fewer differences come first, then those in places declared earlier.
"""

USUAL: Deviation = (0, (), ())


class TooManyCombinations(Exception):  # noqa: N818 - it is a property of the model
    """The combinations of arguments are too many to tell apart.

    Attributes:
        span: what alone has too many, if that is why.
    """

    def __init__(self, span: Span | None = None) -> None:
        super().__init__("too many combinations of arguments")
        self.span = span


def _intersection(one: int, other: int) -> int | None:
    if _EMPTY in (one, other):
        return _EMPTY
    if one in (_FULL, other):
        return other
    return one if other == _FULL else None


def _union(one: int, other: int) -> int | None:
    if _FULL in (one, other):
        return _FULL
    if one in (_EMPTY, other):
        return other
    return one if other == _EMPTY else None


def _difference(one: int, other: int) -> int | None:
    if one in (_EMPTY, other) or other == _FULL:
        return _EMPTY
    return one if other == _EMPTY else None


_Settle = Callable[[int, int], int | None]


class Assignments:
    """A set of assignments, with the operators of sets; of one space only."""

    __slots__ = ("_diagrams", "node")

    def __init__(self, diagrams: Diagrams, node: int) -> None:
        self._diagrams = diagrams
        self.node = node

    def __and__(self, other: Assignments) -> Assignments:
        return self._combined(_intersection, other)

    def __or__(self, other: Assignments) -> Assignments:
        return self._combined(_union, other)

    def __sub__(self, other: Assignments) -> Assignments:
        return self._combined(_difference, other)

    def __bool__(self) -> bool:
        return self.node != _EMPTY

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Assignments) and self.node == other.node

    def __hash__(self) -> int:
        return self.node

    def _combined(self, settle: _Settle, other: Assignments) -> Assignments:
        return Assignments(self._diagrams, self._diagrams.combine(settle, self.node, other.node))

    @property
    def smallest(self) -> Deviation:
        """The first assignment in the order of :data:`Deviation`; the set is not empty."""
        found = self._diagrams.smallest[self.node]
        assert found is not None
        return found

    @property
    def first(self) -> tuple[int, ...]:
        """The first assignment in the order of its values; the set is not empty."""
        return self._diagrams.first(self.node)


class Diagrams:
    """The nodes of all sets of one space.

    Attributes:
        smallest: of the set of each node; ``None`` of the empty one.
    """

    def __init__(self, sizes: Sequence[int]) -> None:
        """Begin with the empty and the full set.

        Args:
            sizes: the number of values in each place.
        """
        self._sizes = sizes
        self._nodes: list[tuple[int, tuple[int, ...]]] = [(len(sizes), ())] * 2
        self._numbers: dict[tuple[int, tuple[int, ...]], int] = {}
        self.smallest: list[Deviation | None] = [None, USUAL]
        self._combined: dict[_Settle, dict[tuple[int, int], int]] = {
            each: {} for each in (_intersection, _union, _difference)
        }
        self._steps = 0
        self.empty = Assignments(self, _EMPTY)
        self.full = Assignments(self, _FULL)

    def cube(self, positions: Mapping[int, int]) -> Assignments:
        """Return the assignments that have some values in some places."""
        node = _FULL
        for place in sorted(positions, reverse=True):
            branches = [_EMPTY] * self._sizes[place]
            branches[positions[place]] = node
            node = self._node(place, tuple(branches))
        return Assignments(self, node)

    def combine(self, settle: _Settle, one: int, other: int) -> int:
        """Return the node of the intersection, union or difference of two sets.

        Recursion would be as deep as there are arguments, so what is to be combined is stacked.

        Raises:
            TooManyCombinations: the work on all sets exceeds :data:`MOST_STEPS`.
        """
        self._step()
        combined = self._combined[settle]
        found = settle(one, other)
        if found is not None:
            return found
        waiting = [(one, other)]
        while waiting:
            pair = waiting[-1]
            if pair in combined:
                waiting.pop()
                continue
            self._step()
            level, pairs = self._branches(*pair)
            branches: list[int] = []
            for each in pairs:
                settled = settle(*each)
                settled = combined.get(each) if settled is None else settled
                if settled is None:
                    waiting.append(each)
                else:
                    branches.append(settled)
            if len(branches) == len(pairs):
                combined[pair] = self._node(level, tuple(branches))
                waiting.pop()
        return combined[one, other]

    def first(self, node: int) -> tuple[int, ...]:
        """Return the positions of the first assignment of a set in the order of its values."""
        found = [0] * len(self._sizes)
        while node != _FULL:
            level, branches = self._nodes[node]
            found[level] = next(place for place, each in enumerate(branches) if each != _EMPTY)
            node = branches[found[level]]
        return tuple(found)

    def _branches(self, one: int, other: int) -> tuple[int, list[tuple[int, int]]]:
        """Return the first place that either set looks at, and what each has for its values."""
        (level, branches), (other_level, other_branches) = self._nodes[one], self._nodes[other]
        if level > other_level:
            return other_level, [(one, each) for each in other_branches]
        if level < other_level:
            return level, [(each, other) for each in branches]
        return level, list(zip(branches, other_branches, strict=True))

    def _node(self, level: int, branches: tuple[int, ...]) -> int:
        if branches.count(branches[0]) == len(branches):
            return branches[0]
        key = level, branches
        if key not in self._numbers:
            self._numbers[key] = len(self._nodes)
            self._nodes.append(key)
            self.smallest.append(self._smallest(level, branches))
        return self._numbers[key]

    def _smallest(self, level: int, branches: tuple[int, ...]) -> Deviation:
        """Return the smallest of what the branches have: of each branch it is that of its node."""
        found: list[Deviation] = []
        for position, each in enumerate(branches):
            inner = self.smallest[each]
            if inner is not None:
                count, places, positions = inner
                found.append(
                    (count + 1, (level, *places), (position, *positions)) if position else inner
                )
        return min(found)

    def _step(self) -> None:
        self._steps += 1
        if self._steps > MOST_STEPS:
            raise TooManyCombinations
