"""How diagnostics name the terms of the rules."""

from __future__ import annotations

from deros.interfaces.types import FieldType, InterfaceType
from deros.monitor.resolved import (
    AgeOf,
    MessageConstant,
    MissingOf,
    Part,
    Plain,
    Quantity,
    Resolved,
    UnknownOf,
    Value,
)


def counted(arguments: int) -> str:
    """Return a number of arguments in words."""
    return {0: "no argument", 1: "1 argument"}.get(arguments, f"{arguments} arguments")


def describe(found: Resolved) -> str:
    """Return the description of a term for diagnostics."""
    match found:
        case Quantity():
            return "a constant number"
        case Plain():
            return "a constant"
        case MessageConstant():
            return "a constant of the message"
        case Value(type=kind):
            return f"{'an' if str(kind).startswith('i') else 'a'} {kind}"
        case Part(type=kind):
            return f"an array ({_short(kind)})" if kind.is_array else f"a {_short(kind)}"
        case AgeOf():
            return "an age"
        case MissingOf() | UnknownOf():
            return "a condition"


def _short(kind: FieldType) -> str:
    if isinstance(kind.base, InterfaceType):
        return str(kind).replace(str(kind.base), kind.base.short)
    return str(kind)
