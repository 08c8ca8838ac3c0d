"""Existing fields of messages that the rules name."""

from __future__ import annotations

from collections.abc import Iterator

from deros.interfaces.fields import FieldPath, ResolvedField, resolve
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType


def field_type(store: InterfaceStore, kind: InterfaceType, path: FieldPath) -> FieldType:
    """Return the type of the field at ``path``, which a message of type ``kind`` has."""
    found = resolve(store, kind, path)
    assert isinstance(found, ResolvedField), found
    return found.type


def request_field(store: InterfaceStore, kind: InterfaceType, name: str) -> FieldType:
    """Return the type of a field that the request of a service of type ``kind`` has."""
    definitions = store.service(kind)
    found = definitions[0].field(name) if definitions else None
    assert found is not None, f"{kind} {name}"
    return found


def unsized_arrays(
    store: InterfaceStore, kind: InterfaceType, path: FieldPath
) -> Iterator[tuple[FieldPath, int]]:
    """Yield the arrays on the way to a field that may be too short for it, the outermost first.

    Each comes as its own path, with the index that ``path`` goes on by, which is no key.
    """
    for position, part in enumerate(path):
        before = path[:position]
        if isinstance(part, int) and field_type(store, kind, before).array != "fixed":
            yield before, part
