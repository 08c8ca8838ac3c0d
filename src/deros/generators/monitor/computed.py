"""Arithmetic, and conditions on entries and points, as functions that every target prints."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from deros.generators.text.unique_names import UniqueNames
from deros.rules.functions.reads import term_name
from deros.rules.program import walk
from deros.rules.program.beams import reach
from deros.rules.program.formulas import Expression, Formula, renamed
from deros.rules.program.ir import Apply, Compute, Leaf, Program, Read, Tuned, Zone
from deros.rules.program.zones import X, Y, is_inside


@dataclass(frozen=True, slots=True)
class ComputedFunction:
    """One function: its name, its parameters in the order of the operands, and what it computes.

    ``wording`` is the term as rules write it, ``zone`` the zone in which it asks for a point.
    """

    name: str
    parameters: tuple[str, ...]
    formula: Formula
    wording: str
    zone: Zone | None = None


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
                suffix = f"_{value.zone.name}" if value.zone is not None else ""
                name = f"{prefix}_{len(found) + 1}{suffix}"
                found[value] = _function(program, value, name, frozenset(reserved))
    return found


@dataclass(frozen=True, slots=True)
class EntriesFunction:
    """A function that counts the entries of arrays that satisfy a condition.

    Attributes:
        name: of the function.
        arrays: the leaf of each array, and what it is called; so are its entries in ``entry``.
        entry: the condition.
        wording: the same, as rules write it.
    """

    name: str
    arrays: tuple[tuple[Leaf, str], ...]
    entry: Expression
    wording: str


def entries_functions(
    program: Program, prefix: str, reserved: Iterable[str]
) -> dict[Apply, EntriesFunction]:
    """Return the functions of a program that count entries; see :func:`computed_functions`."""
    found: dict[Apply, EntriesFunction] = {}
    for value in walk.values(walk.conditions(program)):
        if isinstance(value, Apply) and value.entry is not None and value not in found:
            reads = [each for each in value.arguments if isinstance(each, Read)]
            names = UniqueNames(frozenset(reserved) | {"count", "found", "i", "k", "r"})
            called = [_argument(program, each, names) for each in reads]
            renames = dict(zip(value.names, called, strict=True))
            entry = renamed(Formula((), value.entry), renames).result
            leaves = (program.leaves[each.leaf] for each in reads)
            arrays = tuple(zip(leaves, called, strict=True))
            name = f"{prefix}_{len(found) + 1}"
            found[value] = EntriesFunction(name, arrays, entry, value.wording)
    return found


@dataclass(frozen=True, slots=True)
class PointsFunction:
    """What counts the beams of a scan that show a point in a zone.

    Attributes:
        name: of the function that counts.
        test: of the one that tells whether a point is in the zone.
        inside: that condition, of ``x`` and ``y`` in the coordinates of the scanner.
        reach: no point of the zone is farther away.
        zone: in these coordinates.
        wording: as rules write it.
    """

    name: str
    test: str
    inside: Formula
    reach: float
    zone: Zone
    wording: str


def points_functions(program: Program) -> dict[Apply, PointsFunction]:
    """Return the functions of a program that count points in zones, in the order of the rules."""
    found: dict[Apply, PointsFunction] = {}
    for value in walk.values(walk.conditions(program)):
        if isinstance(value, Apply) and value.zone is not None and value not in found:
            named: dict[str, Expression] = {}
            condition = is_inside(value.zone.shape, named)
            inside = Formula(tuple(named.items()), condition)
            found[value] = PointsFunction(
                points_name(value),
                f"is_in_{value.zone.name}_{value.input}",
                renamed(inside, {X.name: "x", Y.name: "y"}),
                reach(value.zone.shape),
                value.zone,
                term_name(program, value),
            )
    return found


def points_name(value: Apply) -> str:
    """Return the name of the function that counts the points of an input in a zone."""
    assert value.zone is not None
    return f"points_in_{value.zone.name}_{value.input}"


def _argument(program: Program, value: Read | Apply | Tuned, names: UniqueNames) -> str:
    return names.new(re.sub(r"\W+", "_", term_name(program, value)).strip("_"))


def _function(
    program: Program, value: Compute, name: str, reserved: frozenset[str]
) -> ComputedFunction:
    assigned = {each for each, _ in value.formula.assignments}
    # Contracts call the result and an array's elements by these names.
    names = UniqueNames(reserved | assigned | {"r", "n", "values", "before"})
    parameters = tuple(_argument(program, each, names) for each in value.operands)
    formula = renamed(value.formula, dict(zip(value.names, parameters, strict=True)))
    return ComputedFunction(name, parameters, formula, value.wording, value.zone)
