"""Constants as values of message fields."""

from __future__ import annotations

from deros.interfaces.types import FLOAT32_MAX, FLOAT_TYPES, FieldType
from deros.interfaces.units import Unit, UnitRegistry
from deros.rules.compiler.scope.resolved import (
    Fixed,
    MessageConstant,
    Plain,
    Quantity,
    family,
    family_of,
)
from deros.rules.program import ir
from deros.rules.program.bounds import as_float32, rounded, type_bounds


def held_value(
    units: UnitRegistry, kind: FieldType, unit: Unit | None, value: Fixed
) -> ir.Scalar | None:
    """Return a constant as a field of this type and unit holds it, or ``None`` if it cannot."""
    if not isinstance(value, Quantity):
        scalar = value.value if isinstance(value, Plain) else value.constant.value
        if isinstance(value, MessageConstant) and value.constant.type != kind.base:
            return None
        too_long = isinstance(scalar, str) and len(scalar) > (kind.string_bound or len(scalar))
        return scalar if family_of(scalar) == family(kind) and not too_long else None
    if family(kind) != "number":
        return None
    if unit and value.unit and not units.compatible(value.unit, unit):
        return None
    number = value.in_unit(unit)
    if kind.base in FLOAT_TYPES:
        if kind.base == "float64":
            return rounded(number)
        # What is published must be what a reader, such as a gate, finds in the message.
        return as_float32(rounded(number)) if abs(number) <= FLOAT32_MAX else None
    least, greatest = type_bounds(kind)
    fits = number.denominator == 1 and least <= number <= greatest
    return int(number) if fits else None
