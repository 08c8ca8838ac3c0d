"""Checks of laser scans: single beams, and sectors whose blind beams nobody asks for.

A single beam need not look where a reader believes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.rules.compiler.scope.resolved import AppliedFunction, ResolvedComparison
from deros.rules.functions.functions import FUNCTIONS, Argument
from deros.rules.program import ir, walk
from deros.validators.findings.hints import SHOWN

_SECTOR = "nearest(-10 deg, 10 deg)"


def check_beams(
    program: ir.Program, comparisons: Iterable[ResolvedComparison]
) -> Iterator[Diagnostic]:
    """Yield one finding per laser scan of which rules compare single ranges."""
    found: dict[str, list[tuple[Span, ir.Leaf]]] = {}
    for comparison in comparisons:
        for leaf in _beams(program, comparison):
            topic = program.inputs[leaf.input].topic
            found.setdefault(topic, []).append((comparison.condition.span, leaf))
    for beams in found.values():
        beams.sort(key=lambda each: each[0].start)
        span, leaf = beams[0]
        number = leaf.path[1]
        where = "at 'angle_min'" if number == 0 else f"{number} steps from 'angle_min'"
        others = dict.fromkeys(each for each, _ in beams if each != span)
        yield report(
            codes.SINGLE_BEAM,
            f"'{span.text}' looks along one beam, {where}: which way that is depends on the"
            " scanner, and what stands beside it is not seen",
            span,
            _hint(program.inputs[leaf.input]),
            tuple(Related(each, "so does this") for each in list(others)[:SHOWN]),
        )


def check_blindness(
    program: ir.Program, functions: Iterable[AppliedFunction]
) -> Iterator[Diagnostic]:
    """Yield one finding per sector with a nearest range, but without a rule on its blindness.

    So for a sector with a zone, in which points are counted.
    """
    looking: dict[tuple[str, float, float], AppliedFunction] = {}
    asked: list[tuple[str, float, float]] = []
    for each in functions:
        if not isinstance(each.expression, ir.Apply):
            continue
        row = FUNCTIONS[each.expression.function]
        if row.argument is Argument.SCAN:
            sector = _sector(program, each.expression)
            if "blind" in row.told:
                looking.setdefault(sector, each)
            else:
                asked.append(sector)
    for sector, each in looking.items():
        if any(_contains(other, sector) for other in asked):
            continue
        written = " ".join(each.span.text.split())
        subject, bearings = _asking(each, written)
        yield report(
            codes.UNASKED_BLINDNESS,
            f"no rule asks how many beams are blind where '{written}' looks: with up to half of"
            " them dirty or covered, it is what the others see",
            each.span,
            f"add a rule on '{subject}.blind({bearings})', their share, or on"
            f" '{subject}.blind_gap({bearings})', their widest gap",
        )


def _asking(function: AppliedFunction, written: str) -> tuple[str, str]:
    """Return what is before the name of a function, and the bearings of its sector."""
    assert isinstance(function.expression, ir.Apply)
    subject, _, rest = written.rpartition(f".{function.expression.function}(")
    if function.expression.zone is None:
        return subject, rest.removesuffix(")")
    start, end = _bearings(function.expression)
    # Rounded outwards, so that the sector holds the zone.
    return subject, f"{_tenths(start, math.floor)} deg, {_tenths(end, math.ceil)} deg"


def _tenths(bearing: float, rounded: Callable[[float], int]) -> str:
    return f"{rounded(math.degrees(bearing) * 10.0) / 10.0:.6g}"


_TURN = 2.0 * math.pi
_SLACK = 1e-6


def _sector(program: ir.Program, function: ir.Apply) -> tuple[str, float, float]:
    """Return the topic, the bearing at which a sector starts, and its width, in radians."""
    start, end = _bearings(function)
    width = end - start if end >= start else end - start + _TURN
    return program.inputs[function.input].topic, start, width


def _bearings(function: ir.Apply) -> tuple[float, float]:
    start, end = (each.value for each in function.arguments[5:7] if isinstance(each, ir.Const))
    assert isinstance(start, float)
    assert isinstance(end, float)
    return start, end


def _contains(outer: tuple[str, float, float], inner: tuple[str, float, float]) -> bool:
    """Return whether a sector contains another one of the same topic."""
    if outer[0] != inner[0]:
        return False
    offset = (inner[1] - outer[1] + _SLACK) % _TURN
    return outer[2] >= _TURN - _SLACK or offset + inner[2] <= outer[2] + 2.0 * _SLACK


def _beams(program: ir.Program, comparison: ResolvedComparison) -> list[ir.Leaf]:
    """Return the single ranges that a comparison reads; one with the range before is no look."""
    values = [comparison.operand.expression]
    values += [comparison.other[1].expression] if comparison.other is not None else []
    if any(isinstance(each, ir.Apply) and each.function == "previous" for each in values):
        return []
    leaves = (program.leaves[index] for value in values for index in walk.leaves(value))
    return [each for each in leaves if _is_beam(program, each)]


def _is_beam(program: ir.Program, leaf: ir.Leaf) -> bool:
    kind = program.inputs[leaf.input].type
    if (kind.package, kind.name) != ("sensor_msgs", "LaserScan"):
        return False
    return len(leaf.path) == 2 and leaf.path[0] == "ranges" and isinstance(leaf.path[1], int)


def _hint(scan: ir.Input) -> str:
    if not scan.path:
        return f"write '{scan.name}.{_SECTOR}' for a sector"
    return f"read the whole scan, 'input scan = topic {scan.topic}', and write 'scan.{_SECTOR}'"
