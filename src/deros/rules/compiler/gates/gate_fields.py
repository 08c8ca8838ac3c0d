"""The fields of the commands of one gate: their types and their units."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deros import codes
from deros.diagnostics import Related, Span
from deros.interfaces.fields import FieldPath, Key, ResolvedField, format_path
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import STRING_TYPES, FieldType, InterfaceType
from deros.interfaces.units import Unit
from deros.models import rules
from deros.rules.compiler.scope.scope import Scope
from deros.rules.program.commands import HEADER, LAYOUT, QUATERNION, TIME

_INDIVISIBLE = {
    TIME: "a time stamp",
    QUATERNION: "a quaternion",
    LAYOUT: "the layout of an array",
}


@dataclass(frozen=True, slots=True)
class GateFields:
    """The fields of the commands of a gate; errors are reported to the scope.

    Attributes:
        type: of the commands.
        topics: those that say the units of its fields, the target first.
        states: those that the gate reads the states of actions from.
    """

    scope: Scope
    type: InterfaceType
    topics: tuple[str, ...]
    states: frozenset[str] = frozenset()

    def number(self, path: FieldPath, span: Span, done: str) -> ResolvedField | None:
        """Resolve a field that something is ``done`` to; report one that is not a number."""
        found = self.own(path, span, done)
        if found is None or found.type.is_number:
            return found
        kind, text = found.type, type_text(found.type)
        message = f"a number is needed here, but '{format_path(path)}' is {with_article(text)}"
        hint = "name one of its elements, as in 'data[0]'" if kind.is_array else ""
        self.scope.fault(codes.FIELD_NOT_NUMERIC, message, span, hint)
        return None

    def own(self, path: FieldPath, span: Span, done: str) -> ResolvedField | None:
        """Resolve a field; report one that is only a part of a value, such as a quaternion."""
        before = Span(span.source, span.start, span.start)
        found = self.scope.field(self.type, path, before, span, len(path))
        if found is None:
            return None
        if by_key(path):
            message = f"'{format_path(path)}' is found by a key, which a gate does not look up"
            self.scope.fault(codes.GATE_LIMIT, message, span, "name its index, as in 'position[0]'")
            return None
        whole = next((_INDIVISIBLE[each] for each in found.around if each in _INDIVISIBLE), None)
        if whole is not None:
            message = f"'{found.name}' of {whole} cannot be {done} by itself"
            self.scope.fault(codes.GATE_LIMIT, message, span)
            return None
        return found

    def unit(self, path: FieldPath) -> Unit | None:
        """Return the unit of a field: from node descriptions, else from REP 103."""
        units = self.scope.field_units
        for topic in self.topics:
            if self.scope.topics.get(topic) is not None:
                unit = units.unit_of(topic, self.type, path)
                if unit is not None:
                    return unit
        return units.unit_of(self.topics[0], self.type, path)


def by_key(path: FieldPath) -> bool:
    """Return whether a path leads through an element that a key names."""
    return any(isinstance(step, Key) for step in path)


def check_once(scope: Scope, named: Sequence[rules.StopField | rules.GateLimit], done: str) -> None:
    """Report each field that is named more than once, of what is ``done`` to it."""
    first: dict[FieldPath, Span] = {}
    for each in named:
        earlier = first.setdefault(each.path, each.path_span)
        if earlier is not each.path_span:
            message = f"'{format_path(each.path)}' is {done} twice"
            place = (Related(earlier, f"first {done} here"),)
            scope.fault(codes.DUPLICATE_RULE_NAME, message, each.path_span, related=place)


def type_text(kind: FieldType) -> str:
    """Return a type as messages name it, without the 'msg' of a message."""
    return str(kind).replace(str(kind.base), getattr(kind.base, "short", str(kind.base)))


def with_article(kind: str) -> str:
    """Return a type as a sentence names it: ``a bool``, ``an int8``."""
    return f"{'an' if kind[0] in 'aeio' else 'a'} {kind}"


def zeroed_fields(
    store: InterfaceStore, kind: InterfaceType, before: FieldPath = ()
) -> Iterator[tuple[FieldPath, FieldType]]:
    """Yield the fields that a zero changes, by their paths; of an array, the first element.

    The stamps of headers and the layout of arrays command nothing. A quaternion comes as a whole,
    and so does a message that is unknown.
    """
    definition = store.message(kind)
    for name, field in definition.fields if definition is not None else ():
        path = (*before, name, *((0,) if field.is_array else ()))
        if field.base in (HEADER, LAYOUT, TIME) or field.base in STRING_TYPES:
            continue
        is_nested = isinstance(field.base, InterfaceType) and field.base != QUATERNION
        if isinstance(field.base, InterfaceType) and is_nested and store.message(field.base):
            yield from zeroed_fields(store, field.base, path)
        else:
            yield path, field.element
