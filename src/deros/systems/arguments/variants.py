"""The assignments of its arguments for which a system has to be looked at.

What is wrong with a system is wrong at a name: a topic without publishers, two nodes called alike,
a frame with two parents. So whatever parts there are at a name, in any combination of the
arguments, has to be seen at that name once; the rest of the system may be in any state. That needs
few assignments, where all combinations are thousands.

A part may be there in several *forms*, by the conditions and expressions in it, and each form is
there for a set of assignments. The sets at one name, cut into one another, give the combinations of
forms that can come together. The smallest assignment of each is looked at, which is also the one to
name in a finding.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deros.models.node import PortKind
from deros.models.system import System
from deros.names.graph_names import resolve_name
from deros.systems.arguments.assignments import Space
from deros.systems.arguments.diagrams import Assignments, TooManyCombinations
from deros.systems.arguments.evaluate import CannotEvaluate
from deros.systems.arguments.forms import forms_of
from deros.systems.arguments.resolve import resolved
from deros.systems.arguments.varied import Place, Varied, place_of, varied
from deros.systems.flat import FlatNode, FlatSystem, listed_nodes
from deros.systems.flatten import flatten
from deros.systems.running.readiness import names_awaited

_MOST_CELLS = 64
"""With more combinations at one name, the pairs are looked at, and each part without the others."""

MOST_WITHOUT_SETS = 512
"""Assignments to look at where the combinations of the arguments cannot be told apart."""

_Names = dict[tuple[str, str], set[str]]
"""The names at which a part is, each with the kinds of its ends there."""

_SIMULATED = ("time", "simulated")
"""A name that every node has: pairs of nodes may differ in their time, or be in two domains."""

_SWITCH = "use_sim_time"


@dataclass(frozen=True, slots=True)
class _End:
    """A form of a part, as it is at one name: where it is there, and the kinds of its ends."""

    part: int
    mask: Assignments
    kinds: set[str]


class Variants:
    """The variants of a system that have to be looked at.

    Attributes:
        space: all assignments of the arguments.
        numbers: of those to look at; 0 is the usual one, and later ones differ from it in more.
        gap: why these may not show all that is wrong, if they may not.
    """

    def __init__(self, system: System) -> None:
        """Find the parts of ``system`` that vary, and the combinations of them."""
        self._system = system
        self._varied: Varied = varied(system)
        self.space: Space = self._varied.space
        self._flat: dict[int, tuple[FlatSystem, tuple[CannotEvaluate, ...]]] = {}
        self._names: dict[int, dict[Place, _Names]] = {}
        self.gap: TooManyCombinations | None = None
        try:
            self.numbers: list[int] = sorted(self._numbers())
        except TooManyCombinations as gap:
            self.gap = gap
            self.numbers = list(range(min(self.space.count, MOST_WITHOUT_SETS)))

    def flat(self, number: int) -> FlatSystem:
        """Return the system at run time for an assignment."""
        return self._at(number)[0]

    def faults(self, number: int) -> tuple[CannotEvaluate, ...]:
        """Return what has no value for an assignment, and has been left out."""
        return self._at(number)[1]

    def _at(self, number: int) -> tuple[FlatSystem, tuple[CannotEvaluate, ...]]:
        if number not in self._flat:
            found, faults = resolved(self._system, self.space.assignment(number))
            self._flat[number] = flatten(found), faults
        return self._flat[number]

    def _numbers(self) -> set[int]:
        numbers = {0}
        sets: dict[tuple[str, str], list[_End]] = defaultdict(list)
        for index, part in enumerate(self._varied.parts):
            for mask in forms_of(part, self.space):
                number = self.space.smallest(mask)
                numbers.add(number)
                for name, kinds in self._names_at(number).get(part.place, {}).items():
                    sets[name].append(_End(index, mask, kinds))
            for each in part.apart:
                numbers.update(map(self.space.smallest, forms_of(each, self.space)))
        for name, found in sets.items():
            if name != _SIMULATED:
                numbers.update(self._combinations(found))
        numbers.update(self._pairs(sets.get(_SIMULATED, [])))
        return numbers

    def _names_at(self, number: int) -> dict[Place, _Names]:
        """Return the names that each part has to do with in a variant."""
        if number not in self._names:
            self._names[number] = self._named(self.flat(number))
        return self._names[number]

    @staticmethod
    def _named(flat: FlatSystem) -> dict[Place, _Names]:
        found: dict[Place, _Names] = defaultdict(lambda: defaultdict(set))
        for topic in flat.topics:
            place = (topic.path, topic.declaration.name_span)
            found[place]["topic", topic.name].add("declaration")
        for node in flat.nodes:
            names = found[place_of(node)]
            for kind, name, end in _names_of(node):
                names[kind, name].add(end)
            names["program", "/".join((*node.path, node.instance.name))].add("node")
        for process in flat.processes:
            found[place_of(process)]["program", process.full_name].add("process")
        for launch in flat.launches:
            found[place_of(launch)]["program", launch.full_name].add("launch file")
        for program in flat.parts:
            for kind, name, role in names_awaited(program):
                found[place_of(program)][kind, name].add(role)
        return found

    def _combinations(self, found: Sequence[_End]) -> Iterator[int]:
        """Yield the smallest assignment of each combination of the forms at a name."""
        everything = self.space.everything
        cells = [everything]
        for mask in dict.fromkeys(each.mask for each in found if each.mask != everything):
            cells = [part for cell in cells for part in (cell & mask, cell - mask) if part]
            if len(cells) > _MOST_CELLS:
                yield from self._of_many(found)
                return
        yield from map(self.space.smallest, cells)

    def _of_many(self, found: Sequence[_End]) -> Iterator[int]:
        yield from self._pairs(found)
        for kind in sorted({kind for each in found for kind in each.kinds}):
            without = self.space.everything
            for each in found:
                if kind in each.kinds:
                    without -= each.mask
            for each in found:
                if both := each.mask & without:
                    yield self.space.smallest(both)
        for each in found:
            alone = each.mask
            for other in found:
                if other.part != each.part and (left := alone - other.mask):
                    alone = left
            yield self.space.smallest(alone)

    def _pairs(self, found: Sequence[_End]) -> Iterator[int]:
        """Yield the smallest assignment in which two forms are there together, for all pairs.

        Of one part there are never two, and each of them alone is looked at anyway.
        """
        parts: dict[Assignments, set[int]] = defaultdict(set)
        for each in found:
            parts[each.mask].add(each.part)
        masks = list(parts)
        for place, one in enumerate(masks):
            for other in masks[:place]:
                if len(parts[one] | parts[other]) > 1:
                    for both in (one & other, one - other, other - one):
                        if both:
                            yield self.space.smallest(both)


def _names_of(node: FlatNode) -> Iterator[tuple[str, str, str]]:
    """Yield the names at which something may be wrong with a node and others."""
    yield "node", node.full_name, "node"
    if node.instance.activated_by is not None:
        yield "activated", node.instance.activated_by.rpartition("/")[2], "activated"
    yield "activated", node.instance.name, "node"
    if node.instance.is_container:
        yield "container", node.instance.name, "node"
    if node.instance.into is not None:
        yield "container", node.instance.into.container.rpartition("/")[2], "into"
    for owner in {node.instance.inside.process} if node.instance.inside is not None else ():
        yield "process", owner, "inside"
    if node.inside:
        yield "process", node.instance.name, "owner"
    for name in listed_nodes(node):
        yield "activated", name.rpartition("/")[2], "manager"
    for end in node.ports:
        kind = end.port.kind.word
        yield "topic", end.topic, kind
        if end.port.kind is PortKind.CLIENT and end.topic.endswith("/change_state"):
            yield "node", end.topic.rpartition("/")[0], "manager"
        for frame in end.port.frames:
            child = frame.child.filled_in(dict(node.parameters))
            yield "frame", child or node.full_name, "frame"
    for wiring in node.instance.wirings:  # of a port that is connected twice, each
        yield "topic", resolve_name(wiring.target, node.namespace, node.instance.name), "wiring"
    yield *_SIMULATED, str(dict(node.parameters).get(_SWITCH) is True)
