"""The unit behind coordinates of zones and mountings, which is one of length."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from deros import codes
from deros.diagnostics import Span
from deros.interfaces.units import Unit

if TYPE_CHECKING:
    from deros.rules.compiler.scope.scope import Scope

LENGTH = (("m", Fraction(1)),)
"""The exponents of a unit of length."""


def unit_of_length(
    scope: Scope, written: str | None, span: Span | None, place: Span, named: str, kind: str
) -> Unit | None:
    """Return the unit of coordinates; report one that is missing or is not of length.

    Args:
        scope: that of the rules.
        written: the unit; ``None`` if there is none.
        span: of the unit.
        place: of the coordinates without their unit.
        named: what they are those of, as ``zone 'front'``.
        kind: the same of any, as ``a zone``.
    """
    if written is None or span is None:
        message = f"the coordinates of {named} have no unit"
        hint = f"write for instance '{_shortened(place.text)} m'"
        scope.fault(codes.INCOMPATIBLE_UNITS, message, place, hint)
        return None
    unit = scope.unit(written, span)
    if unit is not None and unit.exponents != LENGTH:
        message = (
            f"the coordinates of {kind} are lengths, '{written}' is a unit of {unit.dimension}"
        )
        scope.fault(codes.INCOMPATIBLE_UNITS, message, span)
        return None
    return unit


def _shortened(text: str) -> str:
    words = text.split()
    return " ".join(words) if len(words) <= 8 else f"… {' '.join(words[-2:])}"
