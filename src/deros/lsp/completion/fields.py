"""Fields of messages, step by step with type and unit, and the functions that fit them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deros.interfaces.fields import FieldError, FieldPath, parse_path, resolve
from deros.interfaces.rep103 import usual_unit
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType
from deros.interfaces.units import Unit, UnitRegistry
from deros.lsp.analysis import Analysis
from deros.lsp.completion.offers import Kind, Offer, Place
from deros.models.rules import Rules
from deros.names.graph_names import resolve_name
from deros.rules.compiler.build import BuildResult
from deros.rules.compiler.scope import shapes
from deros.rules.functions.functions import WRITTEN, Argument, Function


@dataclass(frozen=True, slots=True)
class Located:
    """A field of the messages of a topic, or the whole message.

    Attributes:
        topic: its graph name.
        type: of its messages.
        path: of the field.
        is_input: whether it is what an ``input`` names, as a whole.
    """

    topic: str
    type: InterfaceType
    path: FieldPath
    is_input: bool


def rules_of(analysis: Analysis) -> tuple[Rules, BuildResult] | None:
    """Return the rules of an analysis with what the compiler made of them."""
    model = analysis.file.model
    return (model, analysis.workspace.builds.of(model)) if isinstance(model, Rules) else None


def after_dot(place: Place) -> Iterator[Offer]:
    """Yield what may follow the names that are written, in rules."""
    found = rules_of(place.analysis)
    if found is None:
        return
    model, built = found
    entity = next((each for each in model.entities if each.name.text == place.chain), None)
    if entity is not None:
        for rule in entity.rules:
            yield Offer(rule.name.text, Kind.Event, "rule", rule.description)
    if any(each.name.text == place.chain for each in model.actions):
        yield Offer("active", Kind.Keyword, "whether the action is active")
    located = locate(model, built, place.chain)
    if located is not None:
        yield from _fields(place.analysis.workspace.store, built, located)
        yield from _functions(place.analysis.workspace.store, located)


def locate(model: Rules, built: BuildResult, chain: str) -> Located | None:
    """Return the field that a chain of names means; ``None`` for all else."""
    head, _, tail = chain.partition(".")
    head, opening, index = head.partition("[")
    tail = f"{opening}{index}.{tail}"
    own = next((each for each in model.inputs if each.name.text == head), None)
    if own is not None:
        topic, path = resolve_name(own.term.topic.text, "/"), own.term.path
    elif head.startswith("/"):
        topic, path = resolve_name(head, "/"), ()
    else:
        return None
    known = built.topics.get(topic)
    if known is None or known.type is None or "(" in tail:
        return None
    try:
        written = parse_path(tail)
    except ValueError:
        return None
    return Located(topic, known.type, (*path, *written), own is not None and not written)


def unit_of(built: BuildResult, located: Located) -> Unit | None:
    """Return the unit of a field, as it is declared or usual."""
    return built.units.unit_of(located.topic, located.type, located.path)


def _fields(store: InterfaceStore, built: BuildResult, at: Located) -> Iterator[Offer]:
    kind = _type_of(store, at.type, at.path)
    for name, inner in fields_of(store, kind):
        unit = built.units.unit_of(at.topic, at.type, (*at.path, name))
        yield field_offer(name, inner, unit)


def fields_of(store: InterfaceStore, kind: FieldType | None) -> list[tuple[str, FieldType]]:
    """Return the fields of a message by name; none of anything else."""
    if kind is None or kind.is_array or not isinstance(kind.base, InterfaceType):
        return []
    definition = store.message(kind.base)
    return [] if definition is None else list(definition.fields)


def field_offer(name: str, kind: FieldType, unit: Unit | None) -> Offer:
    """Return the offer of a field, with its type and its unit."""
    shown = str(kind)
    if isinstance(kind.base, InterfaceType):
        shown = shown.replace(str(kind.base), kind.base.short)
    return Offer(name, Kind.Field, shown if unit is None else f"{shown} in {unit}", rank=0)


def below(store: InterfaceStore, kind: InterfaceType, chain: str) -> Iterator[Offer]:
    """Yield the fields behind a path in messages of a type, with their usual units."""
    units = UnitRegistry()
    path = parse_path(chain)
    for name, inner in fields_of(store, _type_of(store, kind, path)):
        yield field_offer(name, inner, usual_unit(store, units, kind, (*path, name)))


def _type_of(store: InterfaceStore, kind: InterfaceType, path: FieldPath) -> FieldType | None:
    found = resolve(store, kind, path)
    return None if isinstance(found, FieldError) else found.type


def _functions(store: InterfaceStore, at: Located) -> Iterator[Offer]:
    kind = _type_of(store, at.type, at.path)
    for row in WRITTEN.values():
        if kind is not None and _fits(store, row, kind, at):
            yield Offer(f"{row.name}()", Kind.Method, row.gives)


def _fits(store: InterfaceStore, row: Function, kind: FieldType, at: Located) -> bool:
    match row.argument:
        case Argument.NUMBER:
            return kind.is_number
        case Argument.INPUT | Argument.ANY:
            return at.is_input
        case Argument.STAMPED:
            return at.is_input and _is_stamped(store, at.type)
        case Argument.CONSTANT:
            return False
        case _:
            return shapes.fits(store, row, kind)


def _is_stamped(store: InterfaceStore, kind: InterfaceType) -> bool:
    """Return whether messages of a type have a header with a stamp."""
    return not isinstance(resolve(store, kind, ("header", "stamp")), FieldError)
