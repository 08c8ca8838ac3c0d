"""Checks of the units that both ends of a topic give its fields.

An end that says nothing means the unit of REP 103 or of the message definition, if there is one.
Safety nodes and gates mean what the other ends say: rules convert.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.interfaces import rep103
from deros.interfaces.fields import FieldPath, format_path
from deros.interfaces.store import InterfaceStore
from deros.interfaces.units import Unit, UnitRegistry, is_same
from deros.models.node import PortKind
from deros.models.system import Topic
from deros.systems.flat import FlatSystem
from deros.systems.safety_nodes import is_gate, is_safety_node
from deros.validators.node.field_units import in_unit
from deros.validators.wiring.graph import End, Vertex, publishers, subscribers

if TYPE_CHECKING:
    import networkx as nx


@dataclass(frozen=True, slots=True)
class _Meaning:
    """The unit that a field has for an end of a topic, or for its declaration.

    Attributes:
        unit: the unit.
        clause: who means it, and how, as in ``/ins (imu) publishes it in deg/s``.
        span: where the end is connected, or the topic declared.
        place: where the unit is written; ``None`` where nothing is.
    """

    unit: Unit
    clause: str
    span: Span
    place: Span | None


def check_topic_units(
    flat: FlatSystem, graph: nx.MultiDiGraph[Vertex], store: InterfaceStore
) -> Iterator[Diagnostic]:
    """Yield the ends of topics that mean another unit of a field than the first one does."""
    units = UnitRegistry()
    declared: dict[str, list[Topic]] = {}
    for flat_topic in flat.topics:
        declared.setdefault(flat_topic.name, []).append(flat_topic.declaration)
    for vertex in (each for each in graph if each[0] == "topic"):
        ends = [*publishers(graph, vertex), *subscribers(graph, vertex)]
        topics = declared.get(vertex[1], [])
        said = [unit for topic in topics for unit in topic.units]
        said += [unit for end in ends for unit in end.port.port.units]
        if said and len({end.type for end in ends}) == 1:  # other types are another finding
            for path in dict.fromkeys(each.field_path for each in said):
                usual = rep103.usual_unit(store, units, ends[0].type, path)
                meanings = [*_of_topics(topics, path, units), *_of_ends(ends, path, usual, units)]
                yield from _differing(f"'{format_path(path)}' of '{vertex[1]}'", meanings)


def _differing(field: str, meanings: list[_Meaning]) -> Iterator[Diagnostic]:
    """Yield the ends that mean another unit of a field than the first one."""
    for other in meanings[1:]:
        first = meanings[0]
        if is_same(first.unit, other.unit):
            continue
        places = [(each.place, each.clause) for each in (first, other)]
        yield report(
            codes.UNITS_DIFFER,
            f"{field} has two units: {first.clause}, and {other.clause}",
            other.span,
            "let one of the two nodes convert, or correct the description that is wrong",
            tuple(Related(place, clause) for place, clause in places if place is not None),
        )


def _of_topics(topics: list[Topic], path: FieldPath, units: UnitRegistry) -> Iterator[_Meaning]:
    """Yield what the declarations of a topic say about a field."""
    for each in topics:
        for said in (unit for unit in each.units if unit.field_path == path):
            unit = units.parse(said.unit)
            if unit is not None:  # else that is the finding
                clause = f"it is declared {in_unit(unit)}"
                yield _Meaning(unit, clause, each.name_span, said.unit_span)


def _of_ends(
    ends: list[End], path: FieldPath, usual: Unit | None, units: UnitRegistry
) -> Iterator[_Meaning]:
    """Yield what the ends of a topic mean; who says nothing means what is ``usual``."""
    for end in ends:
        does = "publishes" if end.port.port.kind is PortKind.PUBLISHER else "expects"
        said = [each for each in end.port.port.units if each.field_path == path]
        unit = units.parse(said[0].unit) if said else usual
        if unit is None or (not said and _is_safety(end)):
            continue
        clause = f"{end.name} {does} it {in_unit(unit)}"
        place = said[0].unit_span if said else None
        yield _Meaning(unit, clause if said else f"{clause} (REP 103)", end.span, place)


def _is_safety(end: End) -> bool:
    node = end.node.type
    return node is None or is_safety_node(node) or is_gate(node.name)
