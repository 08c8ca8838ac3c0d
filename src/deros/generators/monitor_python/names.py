"""Identifiers of the emitted module: telling names, never a keyword, never the same twice."""

from __future__ import annotations

import builtins
import keyword
from collections.abc import Sequence

from deros.generators.names import python_identifier
from deros.monitor.functions import FUNCTIONS

MODULE_NAMES = frozenset(
    {
        *("Callable", "Collection", "Sequence", "NamedTuple", "functools", "math", "np"),
        *("Event", "Explanation", "Monitor", "RuleState", "explained", "scan_beams"),
        *("RateWindow", "because", "shown", "stamp_of", "unknown_of"),
        *("all_of", "any_of", "given"),
        *("NAN", "NEVER", "OPTIONAL", "RULES_OF"),
    }
)
METHOD_NAMES = frozenset(
    {
        *("act", "advance", "catch_up", "earliest", "enable", "evaluate", "explain", "refuse"),
        *("disabled", "reset", "restart", "rules_of", "waiting"),
    }
)
LOCAL_NAMES = frozenset(
    {
        *("changed", "due", "emit", "fresh", "now", "self", "started", "t", "verdict"),
        *("causes", "found", "rules"),
        *("cosine", "length", "sine", "ux", "uy", "uz", "uw"),
    }
)

_FUNCTION_NAMES = {row.python_call for row in FUNCTIONS.values()} | {
    row.guard.python_call for row in FUNCTIONS.values() if row.guard
}
RESERVED = (
    MODULE_NAMES
    | METHOD_NAMES
    | LOCAL_NAMES
    | _FUNCTION_NAMES
    | frozenset(keyword.kwlist)
    | frozenset(name for name in dir(builtins) if name.islower())
)


class Names:
    """Hands out identifiers that differ from each other and from all reserved ones."""

    def __init__(self, taken: frozenset[str] = RESERVED) -> None:
        """Start with the names that are ``taken``."""
        self._taken = set(taken)

    def new(self, *parts: str | int, endings: Sequence[str] = ()) -> str:
        """Return an identifier made of ``parts``; a number is added where it is taken already.

        Args:
            parts: the words of the identifier.
            endings: what others end in that are made of it; they are as free as it is, and taken.
        """
        words = (python_identifier(str(part)).strip("_") for part in parts)
        base = "_".join(word for word in words if word) or "value"
        if base[0].isdigit():
            base = f"n{base}"
        name, number = base, 2
        while not self._taken.isdisjoint(wanted := {name, *(name + each for each in endings)}):
            name, number = f"{base}_{number}", number + 1
        self._taken |= wanted
        return name
