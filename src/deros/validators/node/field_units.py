"""Checks of the units of fields, as nodes and topics declare them."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Span, report
from deros.interfaces import rep103
from deros.interfaces.fields import FieldError, parse_path, resolve
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.interfaces.units import Unit, UnitRegistry, is_same
from deros.models.node import FieldUnit
from deros.names import names


def check_field_unit(
    kind: InterfaceType, annotation: FieldUnit, store: InterfaceStore, units: UnitRegistry
) -> Iterator[Diagnostic]:
    """Yield the findings about the unit of one field of a message type."""
    path = parse_path(annotation.path)
    found = resolve(store, kind, path)
    if isinstance(found, FieldError):
        yield report(
            codes.UNKNOWN_FIELD_OF_PORT,
            f"{kind.short}: {found.message}",
            annotation.span,
            hint=names.did_you_mean(found.candidates),
        )
    unit = units.parse(annotation.unit)
    if unit is None:
        yield unknown_unit(units, annotation.unit, annotation.unit_span)
        return
    if annotation.wrapping and dict(unit.exponents) != {"rad": 1}:
        yield report(
            codes.WRAPPING_NOT_AN_ANGLE,
            f"'{annotation.path}' is in {unit.text} ({unit.dimension}): only an angle wraps around"
            " after a full turn",
            annotation.unit_span,
            f"write '[{annotation.unit}]'",
        )
    expected = rep103.usual_unit(store, units, kind, path)
    if expected is not None and not units.compatible(unit, expected):
        yield report(
            codes.UNIT_CONFLICTS_WITH_REP103,
            f"REP 103 gives '{annotation.path}' of {kind.short} {in_unit(expected)}, and"
            f" {unit.text} has another dimension",
            annotation.unit_span,
            hint=f"publish the field {in_unit(expected)}, and omit the unit",
        )
    elif rep103.is_share(store, kind, path) and not is_same(unit, expected):
        yield report(
            codes.SHARE_IN_ANOTHER_UNIT,
            f"'{annotation.path}' is in {unit.text} here, and {kind.short} defines it from 0 to 1",
            annotation.unit_span,
            "publish it from 0 to 1, and omit the unit; for a node that cannot be changed, allow"
            " this finding: rules convert",
        )


def in_unit(unit: Unit) -> str:
    """Return in words that a value has a unit: ``in m/s``; 1 is not a unit to show."""
    return "as a plain number" if unit.text == "1" else f"in {unit.text}"


def unknown_unit(units: UnitRegistry, text: str, span: Span) -> Diagnostic:
    """Return the finding that a unit is not known."""
    return report(
        codes.UNKNOWN_UNIT,
        f"unknown unit '{text}'",
        span,
        hint=names.did_you_mean(units.suggest(text)),
    )
