"""How diagnostics name the terms of the rules."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from deros.interfaces.types import FieldType, InterfaceType
from deros.names.names import near
from deros.rules.compiler.scope.resolved import (
    AgeOf,
    EntriesHold,
    FrequencyOf,
    InsideOf,
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
            return shortened(kind)
        case AgeOf():
            return "an age"
        case FrequencyOf():
            return "a frequency"
        case MissingOf() | UnknownOf() | EntriesHold() | InsideOf():
            return "a condition"


def rules_called(name: str, rules_of: Mapping[str, Iterable[str]]) -> list[str]:
    """Return the rules, as ``entity.rule``, that have a name or one that nearly matches.

    ``rules_of`` has the names of each entity's rules.
    """
    everyone = dict.fromkeys(rule for known in rules_of.values() for rule in known)
    meant = [name] if name in everyone else near(name, everyone)
    return [
        f"{entity}.{rule}" for entity, known in rules_of.items() for rule in known if rule in meant
    ]


def shortened(kind: FieldType) -> str:
    """Return the description of a part of a message."""
    short = _short(kind)
    if kind.is_array:
        return f"an array ({short})"
    return f"{'an' if short.startswith('i') else 'a'} {short}"


def _short(kind: FieldType) -> str:
    if isinstance(kind.base, InterfaceType):
        return str(kind).replace(str(kind.base), kind.base.short)
    return str(kind)
