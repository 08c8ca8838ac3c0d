"""The arithmetic of a program as functions in C."""

from __future__ import annotations

from functools import lru_cache

from deros.generators.monitor import computed
from deros.generators.monitor.c.code.names import RESERVED
from deros.generators.monitor.computed import ComputedFunction
from deros.rules.program.ir import Compute, Program


@lru_cache(maxsize=8)
def computed_functions(program: Program) -> dict[Compute, ComputedFunction]:
    """Return the function of each arithmetic term of a program, in the order of the rules."""
    return computed.computed_functions(program, "compute", RESERVED)
