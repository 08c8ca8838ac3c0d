"""What a system looks up where it is started."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator

from deros.models.arguments import Lookup, lookups_in
from deros.models.common import Value
from deros.models.system import System
from deros.systems.arguments.evaluate import CannotEvaluate, Unavailable
from deros.systems.arguments.symbolic import inlined
from deros.systems.arguments.varied import parts_of

AT_START = "\N{SYMBOL FOR NULL}at start"
"""Stands for texts that depend on where a system is started, so that nothing is known of them."""


def is_at_start(value: Value | None) -> bool:
    """Return whether a value, or an element of it, is known only where a system is started."""
    texts = value if isinstance(value, tuple) else (value,)
    return any(isinstance(each, str) and AT_START in each for each in texts)


def looked_up(system: System, look: Callable[[Lookup], str | bool]) -> dict[str, str | bool]:
    """Return what a system looks up, by the keys under which expressions find it.

    Args:
        system: as written.
        look: returns what one stands for; raises ValueError where that is nothing.
    """
    found: dict[str, str | bool] = {}
    for each in _lookups(system):
        if each.key not in found:
            try:
                found[each.key] = look(each)
            except ValueError as fault:
                found[each.key] = Unavailable(fault)
    return found


def _lookups(system: System) -> Iterator[Lookup]:
    for argument in system.arguments:
        if argument.default_from is not None:
            yield from lookups_in(argument.default_from)
    for part in parts_of(system):
        for scope, expression in part.expressions:
            with contextlib.suppress(CannotEvaluate):  # which is reported where it is written
                yield from lookups_in(inlined(expression, scope))
