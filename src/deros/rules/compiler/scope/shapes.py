"""Which message parts a function of the table can be applied to.

A quaternion is a message of exactly the numbers x, y, z and w, a vector one of x, y and, unless it
is plane, z. A point is a vector, or one of x, y and theta. So messages of one's own are as good as
those of ``geometry_msgs``.
"""

from __future__ import annotations

from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType
from deros.rules.functions.functions import Argument, Function

_SEARCH_DEPTH = 3


def fits(store: InterfaceStore, row: Function, kind: FieldType) -> bool:
    """Return whether the function can be applied to a part of this type."""
    match row.argument:
        case Argument.ARRAY:
            return kind.is_array
        case Argument.NUMBERS:
            return kind.is_array and kind.element.is_number
        case Argument.QUATERNION:
            return _numbers_of(store, kind) == {"x", "y", "z", "w"}
        case Argument.VECTOR:
            return _numbers_of(store, kind) in ({"x", "y"}, {"x", "y", "z"})
        case Argument.POINT:
            numbers = _numbers_of(store, kind) or set()
            return numbers in ({"x", "y"}, {"x", "y", "z"}, {"x", "y", "theta"})
        case Argument.SCAN:
            first, *others = (leaf_type(store, kind, name) for name in row.leaves)
            beams = first is not None and first.is_array and first.element.is_float
            return beams and all(other is not None and other.is_float for other in others)
        case _:
            return False


def leaf_type(store: InterfaceStore, kind: FieldType, name: str) -> FieldType | None:
    """Return the type of a part's field, or of the part itself for the empty name."""
    if not name:
        return kind
    if kind.is_array or not isinstance(kind.base, InterfaceType):
        return None
    definition = store.message(kind.base)
    return definition.field(name) if definition else None


def fitting_fields(
    store: InterfaceStore, row: Function, kind: FieldType, depth: int = _SEARCH_DEPTH
) -> list[tuple[str, ...]]:
    """Return the paths of the fields below a message that the function can be applied to."""
    if depth == 0 or kind.is_array or not isinstance(kind.base, InterfaceType):
        return []
    definition = store.message(kind.base)
    found: list[tuple[str, ...]] = []
    for name, field_type in definition.fields if definition else ():
        if row.argument is Argument.NUMBER:
            fit = field_type.is_number
        else:
            fit = fits(store, row, field_type)
        if fit:
            found.append((name,))
        else:
            inner = fitting_fields(store, row, field_type, depth - 1)
            found.extend((name, *path) for path in inner)
    return found


def _numbers_of(store: InterfaceStore, kind: FieldType) -> set[str] | None:
    """Return the field names of a message that holds nothing but single numbers, else ``None``."""
    if kind.is_array or not isinstance(kind.base, InterfaceType):
        return None
    definition = store.message(kind.base)
    if definition is None or not all(each.is_number for _, each in definition.fields):
        return None
    return {name for name, _ in definition.fields}
