"""What is started of a system that is computed from arguments, or why that cannot be said."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import report
from deros.generators.api.protocol import GenerationError
from deros.models.system import System
from deros.systems.arguments.diagrams import TooManyCombinations
from deros.systems.arguments.symbolic import SymbolicSystem
from deros.systems.flat import FlatProgram
from deros.systems.flatten import flatten


def expanded(system: System, root: str) -> SymbolicSystem:
    """Return what a system that is started in a namespace consists of, in terms of its arguments.

    Raises:
        GenerationError: if a node is there in too many ways, or its conditions cannot be told
            apart.
    """
    try:
        return SymbolicSystem(system, root)
    except TooManyCombinations as fault:
        finding = report(
            codes.UNSUPPORTED_BY_TARGET,
            "what is started depends on the arguments in more ways than can be told apart",
            system.name_span if fault.span is None else fault.span,
            "divide what depends on so many arguments, or give them fewer values to choose from",
        )
        raise GenerationError([finding]) from None


def programs_in(system: System) -> Iterator[FlatProgram]:
    """Yield the programs of a system, in each form in which it has them."""
    if not system.is_computed:
        yield from flatten(system).programs
        return
    yield from (each.node for each in SymbolicSystem(system).nodes)
