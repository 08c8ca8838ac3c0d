"""What an ``input`` line declares of a laser scanner: its mounting, and its range for "nothing"."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction
from typing import TYPE_CHECKING

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.interfaces.fields import FieldError, resolve
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType
from deros.models import rules
from deros.rules.compiler.scope import shapes
from deros.rules.compiler.scope.lengths import unit_of_length
from deros.rules.compiler.scope.resolved import DeclaredInput, Mounted
from deros.rules.functions.functions import FUNCTIONS

if TYPE_CHECKING:
    from deros.rules.compiler.scope.scope import Scope

FARTHEST_M = 100
"""The greatest coordinate of a sensor on a robot, in metres."""

_AT_ORIGIN = Mounted(Fraction(0), Fraction(0), Fraction(1), Fraction(0))


def declare_scanner(
    scope: Scope, written: rules.Input, declared: DeclaredInput
) -> Iterator[Diagnostic]:
    """Note what a line says of a laser scanner; yield a finding where it cannot be."""
    yield from _declare_no_return(scope.store, written, declared)
    if written.mounting is not None:
        # One with a fault is still one, so that nothing follows from it.
        declared.mounted = _mounted(scope, written, written.mounting, declared) or _AT_ORIGIN


def _declare_no_return(
    store: InterfaceStore, written: rules.Input, declared: DeclaredInput
) -> Iterator[Diagnostic]:
    if written.no_return is None:
        return
    span = written.no_return.span
    if not _is_scan(store, declared):
        yield report(
            codes.BAD_NO_RETURN,
            f"'no_return' tells what a laser scanner reports, '{written.term.span.text}' is no"
            " laser scan",
            span,
            "leave it out",
        )
    elif written.no_return.value != 0:
        yield report(
            codes.BAD_NO_RETURN,
            f"'{span.text}' cannot be what a scanner reports where nothing is there: 0 can",
            span,
            "leave it out: '+Inf' and what lies beyond 'range_max' mean so without it",
        )
    else:
        declared.zero_is_free = True


def _mounted(
    scope: Scope, written: rules.Input, mounting: rules.Mounting, declared: DeclaredInput
) -> Mounted | None:
    """Return where a scanner is mounted; report what cannot be."""
    if mounting.described_span is not None:
        message = "a mounting out of a robot description is not supported yet"
        hint = "write it out: 'mounted (0.25, 0, 0.1) m yaw 90 deg'"
        scope.fault(codes.BAD_MOUNTING, message, mounting.described_span, hint)
        return None
    if not _is_scan(scope.store, declared):
        message = (
            "'mounted' tells where a laser scanner is on the robot,"
            f" '{written.term.span.text}' is no laser scan"
        )
        scope.fault(codes.BAD_MOUNTING, message, mounting.span, "leave it out")
        return None
    what, place = "a mounting", mounting.place_span
    unit = unit_of_length(scope, mounting.unit, mounting.unit_span, place, what, what)
    turned = _turned(scope, mounting.yaw)
    if unit is None or turned is None:
        return None
    x, y = (Fraction(each) * unit.factor for each in (mounting.x, mounting.y))
    z = Fraction(mounting.z or 0) * unit.factor
    if max(abs(x), abs(y), abs(z)) > FARTHEST_M:
        message = f"'{mounting.place_span.text}' is more than {FARTHEST_M} m from the robot"
        hint = f"'{mounting.unit}' is the unit of all three"
        scope.fault(codes.BAD_MOUNTING, message, mounting.place_span, hint)
        return None
    return Mounted(x, y, *turned)


def _turned(scope: Scope, yaw: rules.Number | None) -> tuple[Fraction, Fraction] | None:
    """Return cosine and sine of an angle, exact for quarter turns; report what is no angle."""
    if yaw is None:
        return Fraction(1), Fraction(0)
    if yaw.unit is None:
        message = f"the angle '{yaw.span.text}' has no unit"
        hint = f"write '{yaw.span.text} deg'"
        scope.fault(codes.INCOMPATIBLE_UNITS, message, yaw.span, hint)
        return None
    unit, degree = scope.unit(yaw.unit, yaw.unit_span or yaw.span), scope.units.parse("deg")
    if unit is None or degree is None:
        return None
    if unit.exponents != degree.exponents:
        message = f"an angle is needed, '{yaw.unit}' is a unit of {unit.dimension}"
        scope.fault(codes.INCOMPATIBLE_UNITS, message, yaw.unit_span or yaw.span)
        return None
    angle = Fraction(yaw.value) * unit.factor
    degrees = angle / degree.factor
    if abs(degrees) > 360:
        message = f"the angle '{yaw.span.text}' is more than a full turn"
        scope.fault(codes.BAD_MOUNTING, message, yaw.span)
        return None
    if degrees % 90 == 0:
        quarters = int(degrees / 90) % 4
        return Fraction((1, 0, -1, 0)[quarters]), Fraction((0, 1, 0, -1)[quarters])
    return Fraction(math.cos(angle)), Fraction(math.sin(angle))


def _is_scan(store: InterfaceStore, declared: DeclaredInput) -> bool:
    kind = FieldType(declared.type)
    if declared.path:
        found = resolve(store, declared.type, declared.path)
        if isinstance(found, FieldError):
            return False
        kind = found.type
    return shapes.fits(store, FUNCTIONS["nearest"], kind)
