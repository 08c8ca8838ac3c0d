"""What a system looks up where it is started."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator

from deros.models.arguments import Lookup, lookups_in
from deros.models.system import System
from deros.systems.arguments.evaluate import CannotEvaluate, Unavailable
from deros.systems.arguments.symbolic import inlined
from deros.systems.arguments.varied import parts_of


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
        for scope, expression in part.computed:
            with contextlib.suppress(CannotEvaluate):  # which is reported where it is written
                yield from lookups_in(inlined(expression, scope))
