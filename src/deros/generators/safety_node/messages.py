"""Properties of the messages of a safety node."""

from __future__ import annotations

from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType
from deros.rules.program.commands import HEADER


def is_stamped(store: InterfaceStore, kind: InterfaceType) -> bool:
    """Return whether messages of a type have a header with a time stamp."""
    definition = store.message(kind)
    return definition is not None and definition.field("header") == FieldType(HEADER)
