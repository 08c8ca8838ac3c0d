"""Checks of suspicious bearings: degrees without a unit, and odd sectors."""

from __future__ import annotations

import math
from collections.abc import Sequence

from deros import codes
from deros.diagnostics import Related, Span
from deros.models import rules
from deros.rules.compiler.scope.resolved import Quantity
from deros.rules.compiler.scope.scope import Scope
from deros.rules.program.bounds import rounded

_TURN = 2.0 * math.pi
_SLACK = 1e-3
"""Radians that count as a rounding of what is written; no scanner has beams so close together."""


def check_sector(scope: Scope, terms: Sequence[rules.Term], bearings: Sequence[Quantity]) -> None:
    """Report suspicious ends of a sector; all of them are well defined."""
    radian = scope.units.parse("rad")
    plausible = [
        _check_bearing(scope, term, bearing, rounded(bearing.in_unit(radian)))
        for term, bearing in zip(terms, bearings, strict=True)
    ]
    if all(plausible):
        start, end = (rounded(each.in_unit(radian)) for each in bearings)
        _check_width(scope, terms, start, end)


def _check_bearing(scope: Scope, term: rules.Term, bearing: Quantity, radians: float) -> bool:
    """Report one bearing that is probably mistyped; return whether it is plausible."""
    related = _declaration(scope, term)
    written = term.span.text
    if bearing.unit is None and (
        abs(radians) > _TURN + _SLACK or (bearing.whole and bearing.value != 0)
    ):
        number = bearing.value if bearing.whole else float(bearing.value)
        scope.fault(
            codes.SUSPECT_BEARING,
            f"the bearing '{written}' has no unit and is taken as radians,"
            f" which is {_degrees(radians)}",
            term.span,
            f"write '{number} deg', or '{number} rad' if radians are meant",
            related,
        )
        return False
    if abs(radians) > _TURN + _SLACK:
        scope.fault(
            codes.SUSPECT_BEARING,
            f"the bearing '{written}' is more than a full turn",
            term.span,
            f"it is the bearing {_degrees(math.fmod(radians, _TURN))}",
            related,
        )
        return False
    return True


def _check_width(scope: Scope, terms: Sequence[rules.Term], start: float, end: float) -> None:
    width = end - start if end >= start else end - start + _TURN
    first, last = (each.span.text for each in terms)
    if width <= _SLACK:
        wrong = "is a single bearing: it holds one beam at most"
        hint = "for the whole scan write '-180 deg, 180 deg'"
    elif width > _TURN + _SLACK:
        wrong = f"is {_degrees(width)} wide, more than a full turn: every beam counts"
        hint = "for the whole scan write '-180 deg, 180 deg'"
    elif width > _TURN - _SLACK and not _is_whole_scan(start):
        wrong = "is a full turn, because both are the same bearing: every beam counts"
        hint = "if that is meant, write '-180 deg, 180 deg'"
    elif end < start and width > 0.75 * _TURN:
        wrong = f"runs through the back, {_degrees(width)} wide, and leaves out the rest"
        hint = f"sectors run counter-clockwise; the rest is '{last}, {first}'"
    else:
        return
    scope.fault(
        codes.SUSPECT_SECTOR,
        f"the sector from {first} to {last} {wrong}",
        Span(terms[0].span.source, terms[0].span.start, terms[1].span.end),
        hint,
    )


def _is_whole_scan(start: float) -> bool:
    """Return whether a full turn that starts here is a usual way to write the whole scan."""
    return any(abs(start - usual) <= _SLACK for usual in (-math.pi, 0.0, -_TURN))


def _declaration(scope: Scope, term: rules.Term) -> tuple[Related, ...]:
    """Return the declaration of the constant that a bearing names."""
    while isinstance(term, rules.Negative):
        term = term.operand
    declared = scope.constants.get(term.name.text) if isinstance(term, rules.NamePath) else None
    return (Related(declared.span, "declared here"),) if declared is not None else ()


def _degrees(radians: float) -> str:
    return f"{round(math.degrees(radians), 1):.6g} deg"
