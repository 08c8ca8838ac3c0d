"""The words of node descriptions."""

from __future__ import annotations

from collections.abc import Iterator

from deros.diagnostics import Span
from deros.interfaces.types import InterfaceType
from deros.models.node import FieldUnit, NodeType, Parameter, Port
from deros.words.words import Word, WordKind


def words_of_node(node: NodeType) -> Iterator[Word]:
    """Yield the words of a node description."""
    yield node_type_word(node.name_span, node)
    for parameter in node.parameters:
        yield parameter_word(parameter.name_span, parameter)
        if parameter.unit is not None and parameter.unit_span is not None:
            yield unit_word(parameter.unit_span, parameter.unit)
    for port in node.ports:
        yield port_word(port.name_span, port)
        yield type_word(port.type_span, port.type)
        yield from _via(node, port)
        yield from words_of_units(port.type, port.units)
    for timer in node.timers:
        yield Word(
            timer.name_span,
            WordKind.TIMER,
            timer.name,
            timer.name_span,
            description=timer.description,
            meaning=timer,
        )


def _via(node: NodeType, port: Port) -> Iterator[Word]:
    if port.via is None or port.via_span is None:
        return
    parameter = node.parameter(port.via)
    if parameter is not None:
        yield parameter_word(port.via_span, parameter)


def words_of_units(kind: InterfaceType, units: tuple[FieldUnit, ...]) -> Iterator[Word]:
    """Yield the units that are declared for fields, and these fields."""
    for each in units:
        yield unit_word(each.unit_span, each.unit)
        end = each.span.start + len(each.path)
        field = Span(each.span.source, each.span.start, end)
        if field.text == each.path:
            name = f"{kind.short}.{each.path}"
            yield Word(field, WordKind.FIELD, name, unit=each.unit, meaning=(kind, each.field_path))


def node_type_word(span: Span, node: NodeType) -> Word:
    """Return the word for a node type."""
    return Word(
        span,
        WordKind.NODE_TYPE,
        node.name,
        node.name_span,
        type=node.package,
        description=node.description,
        meaning=node,
    )


def parameter_word(span: Span, parameter: Parameter, kind: WordKind = WordKind.PARAMETER) -> Word:
    """Return the word for a parameter, or for an argument, which is declared as one."""
    return Word(
        span,
        kind,
        parameter.name,
        parameter.name_span,
        parameter.type.value,
        parameter.unit or "",
        parameter.description,
        parameter,
    )


def port_word(span: Span, port: Port) -> Word:
    """Return the word for a port."""
    return Word(
        span,
        WordKind.PORT,
        port.name,
        port.name_span,
        port.type.short,
        description=port.description,
        meaning=port,
    )


def type_word(span: Span, kind: InterfaceType) -> Word:
    """Return the word for the type of a message, service or action."""
    return Word(span, WordKind.TYPE, kind.short, type=kind.kind, meaning=kind)


def unit_word(span: Span, unit: str) -> Word:
    """Return the word for a unit."""
    return Word(span, WordKind.UNIT, unit)
