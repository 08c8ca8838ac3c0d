"""Checks of single beams of a laser scan, which need not look where a reader believes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.rules.compiler.scope.resolved import ResolvedComparison
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
