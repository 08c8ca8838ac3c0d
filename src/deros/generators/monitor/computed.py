"""The arithmetic of a program, as functions that every target prints from its formulas."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from deros.generators.text.unique_names import UniqueNames
from deros.rules.functions.reads import term_name
from deros.rules.program import walk
from deros.rules.program.formulas import Formula, renamed
from deros.rules.program.ir import Compute, Program


@dataclass(frozen=True, slots=True)
class ComputedFunction:
    """One function: its name, its parameters in the order of the operands, and what it computes."""

    name: str
    parameters: tuple[str, ...]
    formula: Formula
    wording: str


def computed_functions(
    program: Program, prefix: str, reserved: Iterable[str]
) -> dict[Compute, ComputedFunction]:
    """Return the functions of a program; parameters are called like what is handed in for them.

    Args:
        program: the rules.
        prefix: what the functions' names begin with; before it stands nothing that a model names.
        reserved: what no parameter is called.
    """
    found: dict[Compute, ComputedFunction] = {}
    for condition in walk.conditions(program):
        for value in walk.computed(condition):
            if value not in found:
                name = f"{prefix}_{len(found) + 1}"
                found[value] = _function(program, value, name, frozenset(reserved))
    return found


def _function(
    program: Program, value: Compute, name: str, reserved: frozenset[str]
) -> ComputedFunction:
    assigned = {each for each, _ in value.formula.assignments}
    # Contracts call the result and an array's elements by these names.
    names = UniqueNames(reserved | assigned | {"r", "n", "values", "before"})
    parameters = tuple(
        names.new(re.sub(r"\W+", "_", term_name(program, each)).strip("_"))
        for each in value.operands
    )
    formula = renamed(value.formula, dict(zip(value.names, parameters, strict=True)))
    return ComputedFunction(name, parameters, formula, value.wording)
