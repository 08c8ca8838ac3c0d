"""Checks that both sides of a comparison are in units that can be held against one another."""

from __future__ import annotations

from deros import codes
from deros.diagnostics import Span
from deros.interfaces.units import Unit, is_difference_of, is_one
from deros.models import rules
from deros.rules.compiler.scope.field_units import plain_beside
from deros.rules.compiler.scope.resolved import Quantity, Value, family
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.terms.conversions import compatible
from deros.rules.program import ir


class ComparedUnits:
    """Reports what cannot be compared, and notes in which unit a field without one is read."""

    def __init__(self, scope: Scope) -> None:
        """Report to a scope."""
        self._scope = scope

    def fit(self, side: Quantity | Value, value: Value, term: rules.Term) -> bool:
        """Return whether the other side of a comparison, ``term``, fits a value; else report it."""
        if isinstance(side, Quantity) and side.unit is None:
            return self._plain(side, value, term)
        unit = side.shown_in if isinstance(side, Quantity) else side.unit
        if value.unit is None or unit is None:
            return self._undeclared(side, unit, value, term)
        if not compatible(self._scope, unit, value.unit, term):
            return False
        side_is_computed = isinstance(side, Value) and _is_computed(side)
        if _is_computed(value) and is_difference_of(value.unit, unit):
            self._difference(side, unit, term.span)
            return False
        if side_is_computed and is_difference_of(unit, value.unit):
            self._difference(side, value.unit, term.span)
            return False
        return True

    def _plain(self, number: Quantity, value: Value, term: rules.Term) -> bool:
        if number.value:
            self._scope.field_units.use(value.undeclared, None, term.span)
        if value.unit is None or not isinstance(value.expression, ir.Compute):
            return True
        computed = value.expression.wording
        found = list(plain_beside(number.value, computed, value.unit, term.span))
        self._scope.diagnostics += found
        return not found

    def _undeclared(
        self, side: Quantity | Value, unit: Unit | None, value: Value, term: rules.Term
    ) -> bool:
        """Note the unit of a field that is read as it is; of what is computed, report it."""
        if isinstance(side, Value) and family(side.type) != "number":
            return True
        if unit is None and value.unit is None:
            assert isinstance(side, Value)
            if _is_read(side) and _is_read(value):
                self._scope.field_units.compare(side.undeclared, value.undeclared)
            return True
        if unit is None:
            assert isinstance(side, Value)
            open_, known = side, value.unit
        else:
            open_, known = value, unit
        plain = known is not None and is_one(known)
        if plain or _is_read(open_):
            self._scope.field_units.use(open_.undeclared, None if plain else known, term.span)
            return True
        quantity = term.span.text if open_ is value else str(known)
        units = self._scope.field_units
        self._scope.diagnostics += units.undeclared(open_.undeclared, quantity, term.span)
        return False

    def _difference(self, side: Quantity | Value, scale: Unit, place: Span) -> None:
        hint = "a difference of temperatures is in K"
        if isinstance(side, Quantity):
            kelvin = float(side.in_unit(side.unit) * scale.factor)
            hint = f"{hint}: write '{kelvin:g} K'"
        message = f"a difference of temperatures cannot be held against a temperature in {scale}"
        self._scope.fault(codes.INCOMPATIBLE_UNITS, message, place, hint)


def _is_computed(value: Value) -> bool:
    return isinstance(value.expression, ir.Compute)


def _is_read(value: Value) -> bool:
    return isinstance(value.expression, ir.Read)
