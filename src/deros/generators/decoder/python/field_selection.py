"""The selection of fields that a decoder reads, as a tree with the structure of the message."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from deros.generators.decoder.python.module import is_view
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.fields import FieldPath, Key, PathStep
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType, MessageDefinition


@dataclass(frozen=True, slots=True)
class Pick:
    """An element that is looked up when all of its array has been read.

    Attributes:
        name: the variable for it.
        values: the one that holds the array.
        step: its index, or its key.
        keys: the variable that holds what the elements are called.
    """

    name: str
    values: str
    step: PathStep
    keys: str = ""


@dataclass(slots=True)
class FieldSelection:
    """The selected parts of one field.

    Attributes:
        name: the variable for its value; ``None`` if at most parts of it are selected.
        parts: the selections of its fields by name, or of its elements by index or key.
        each: what is read of every element, of an array of messages of which one is looked up.
        lists: the variables that it is read to, with those that collect it.
        picks: what is looked up when the field has been read.
    """

    name: str | None = None
    parts: dict[PathStep, FieldSelection] = field(default_factory=dict)
    each: FieldSelection | None = None
    lists: dict[str, str] = field(default_factory=dict)
    picks: list[Pick] = field(default_factory=list)

    @property
    def elements(self) -> list[tuple[int, FieldSelection]]:
        """The selected elements of an array, sorted by index."""
        return sorted((key, part) for key, part in self.parts.items() if isinstance(key, int))

    @property
    def keys(self) -> list[Key]:
        """The keys of selected elements of an array."""
        return [step for step in self.parts if isinstance(step, Key)]

    def names(self) -> Iterator[str]:
        """Yield the variables of all selected values."""
        for _, part in self.walk():
            yield str(part.name)

    def walk(self, path: FieldPath = ()) -> Iterator[tuple[FieldPath, FieldSelection]]:
        """Yield what has a variable, with its path."""
        if self.name is not None:
            yield path, self
        for step, part in self.parts.items():
            yield from part.walk((*path, step))

    def at(self, path: FieldPath) -> FieldSelection:
        """Return the selection at a path, which is made if it is not there."""
        here = self
        for step in path:
            here = here.parts.setdefault(step, FieldSelection())
        return here


NOTHING = FieldSelection()
"""The selection of nothing: the field is skipped."""


def select(paths: Sequence[FieldPath], names: Mapping[FieldPath, str]) -> FieldSelection:
    """Return the selection of all ``paths``, with the variable of each."""
    root = FieldSelection()
    for path in paths:
        root.at(path).name = names[path]
    return root


def look_up(
    selection: FieldSelection,
    store: InterfaceStore,
    kind: InterfaceType,
    names: UniqueNames,
    path: FieldPath = (),
) -> None:
    """Add what must be read so that elements are found by their keys.

    Args:
        selection: the fields of a message.
        store: the definitions.
        kind: the type of the message.
        names: makes the variables.
        path: of the message.
    """
    definition = store.message(kind)
    if definition is None:
        return
    for name, type_ in definition.fields:
        part = selection.parts.get(name)
        if part is None:
            continue
        here = (*path, name)
        if not isinstance(type_.base, InterfaceType):
            _look_up_beside(selection, definition, name, names, path)
        elif not type_.is_array:
            look_up(part, store, type_.base, names, here)
        elif part.keys:
            part.each = _look_up_inside(part, names, here)
            look_up(part.each, store, type_.base, names, here)
        else:
            for index, element in part.elements:
                look_up(element, store, type_.base, names, (*here, index))


def _look_up_beside(
    message: FieldSelection,
    definition: MessageDefinition,
    array: str,
    names: UniqueNames,
    path: FieldPath,
) -> None:
    """Have the whole array read, and the arrays of its keys."""

    def whole(name: str) -> str:
        part, kind = message.at((name,)), definition.field(name)
        part.name = part.name or names.new(*path, name)
        return f"{part.name}.tolist()" if kind is not None and is_view(kind) else part.name

    part = message.parts[array]
    for key in part.keys:
        message.picks.append(Pick(str(part.parts[key].name), whole(array), key, whole(key.name)))


def _look_up_inside(array: FieldSelection, names: UniqueNames, path: FieldPath) -> FieldSelection:
    """Return what is read of each element of an array of messages."""
    each = FieldSelection()

    def column(inner: FieldPath) -> str:
        part = each.at(inner)
        part.name = part.name or names.new(*path, *inner)
        return array.lists.setdefault(part.name, names.new(f"{part.name}s"))

    for step, element in array.parts.items():
        keys = column((step.name,)) if isinstance(step, Key) else ""
        for inner, part in element.walk():
            array.picks.append(Pick(str(part.name), column(inner), step, keys))
    return each
