"""The arithmetic of a program, and its conditions on entries and points, as functions in C."""

from __future__ import annotations

from functools import lru_cache

from deros.generators.monitor import computed
from deros.generators.monitor.c.code.names import RESERVED
from deros.generators.monitor.computed import ComputedFunction, EntriesFunction, PointsFunction
from deros.rules.program.ir import Apply, Compute, Program


@lru_cache(maxsize=8)
def computed_functions(program: Program) -> dict[Compute, ComputedFunction]:
    """Return the function of each arithmetic term of a program, in the order of the rules."""
    return computed.computed_functions(program, "compute", RESERVED)


@lru_cache(maxsize=8)
def entries_functions(program: Program) -> dict[Apply, EntriesFunction]:
    """Return the function of each condition on entries, in the order of the rules."""
    return computed.entries_functions(program, "matches", RESERVED)


@lru_cache(maxsize=8)
def points_functions(program: Program) -> tuple[PointsFunction, ...]:
    """Return the functions that count points in zones, in the order of the rules."""
    return tuple(computed.points_functions(program).values())
