"""Resolves the limits of gates: their fields, ends and units."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from deros import codes
from deros.interfaces.fields import ResolvedField, format_path
from deros.interfaces.types import INTEGER_RANGES, FieldType, MessageDefinition
from deros.interfaces.units import Unit
from deros.models import rules
from deros.rules.compiler.gates.gate_bounds import BoundResolver, ReadEnd
from deros.rules.compiler.gates.gate_fields import GateFields, check_once, with_article
from deros.rules.compiler.scope.resolved import FieldKey, MessageConstant, Quantity, Value
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.terms.conversions import compatible
from deros.rules.compiler.terms.terms import Terms
from deros.rules.program import ir
from deros.rules.program.bounds import as_float32, rounded, type_bounds

_End = Quantity | ReadEnd | ir.TunedBound
_Resolved = int | float | ir.InputBound | ir.TunedBound


@dataclass(frozen=True, slots=True)
class _Known:
    """What is known of an end before the gate runs: the least and the greatest it can be.

    ``None`` where messages give it.
    """

    least: Fraction | None
    greatest: Fraction | None
    is_fixed: bool


class LimitResolver:
    """Builds the limits of gates; errors are reported to the scope."""

    def __init__(self, scope: Scope, terms: Terms) -> None:
        """Look up names in ``scope``, and constants with ``terms``."""
        self._scope = scope
        self._terms = terms
        self._bounds = BoundResolver(scope)

    def of(self, line: rules.GateLine, fields: GateFields) -> Iterator[ir.Limit]:
        """Yield the limits of a line that have no errors."""
        if not line.is_standing:
            check_once(self._scope, line.limits, "limited")
        for limit in line.limits:
            field = fields.number(limit.path, limit.path_span, "limited")
            ends = self._ends(line, limit, field, fields) if field else None
            if field and ends:
                yield ir.Limit(limit.path, field.type, *ends)

    def _ends(
        self, line: rules.GateLine, limit: rules.GateLimit, field: ResolvedField, gate: GateFields
    ) -> tuple[_Resolved, _Resolved] | None:
        unit, common = gate.unit(limit.path), None
        if limit.unit is not None:
            common = self._common_unit(limit, limit.unit, unit)
            if common is None:
                return None
        terms = (limit.lower, limit.upper)
        ends = [self._end(line, term, common, field.parent, gate) for term in terms]
        lower, upper = ends
        if lower is None or upper is None:
            return None
        wanted = unit or common or self._shown_in(lower) or self._shown_in(upper)
        known = [
            self._known(end, wanted, term) for end, term in ((lower, terms[0]), (upper, terms[1]))
        ]
        low, high = known
        if low is None or high is None:
            return None
        if unit is None:
            is_number = wanted is not None or low.least or high.greatest
            self._use(gate, limit, wanted, bool(is_number), [lower, upper])
        if not self._is_limit(limit, field.type, low, high):
            return None
        resolved = [
            self._resolved(end, wanted, term, field.type)
            for end, term in ((lower, terms[0]), (upper, terms[1]))
        ]
        first, last = resolved
        return None if first is None or last is None else (first, last)

    def _use(
        self,
        gate: GateFields,
        limit: rules.GateLimit,
        wanted: Unit | None,
        is_number: bool,
        ends: list[_End],
    ) -> None:
        """Note what the limit says about the unit of a field without one."""
        fields: tuple[FieldKey, ...] = tuple((topic, limit.path) for topic in gate.topics)
        units = self._scope.field_units
        read = tuple(end.field for end in ends if isinstance(end, ReadEnd) and end.unit is None)
        if is_number or read:
            units.compare(fields[:1], (*fields[1:], *read))
        if is_number:
            units.use(fields[:1], wanted, limit.interval_span)

    def _common_unit(self, limit: rules.GateLimit, text: str, wanted: Unit | None) -> Unit | None:
        """Return the unit after the interval; report one that is not of the field's dimension."""
        place = limit.unit_span or limit.span
        found = self._scope.unit(text, place)
        if found is None or wanted is None or self._scope.units.compatible(found, wanted):
            return found
        message = (
            f"'{format_path(limit.path)}' is in {wanted.text} ({wanted.dimension}),"
            f" '{text}' is a unit of {found.dimension}"
        )
        self._scope.fault(codes.INCOMPATIBLE_UNITS, message, place)
        return None

    # Ends ---------------------------------------------------------------------------------------

    def _end(
        self,
        line: rules.GateLine,
        term: rules.Term,
        common: Unit | None,
        message: MessageDefinition | None,
        gate: GateFields,
    ) -> _End | None:
        """Return one end of an interval; a plain number is in the unit after the interval."""
        if self._bounds.is_read(term):
            is_refused = self._bounds.is_refused(term, None, line)
            taken = (*gate.topics, *gate.states)
            return None if is_refused else self._bounds.read(term, taken)
        found = self._terms.resolve(term, message)
        if found is None:
            return None
        if isinstance(found, Value) and found.is_tuned:
            is_refused = self._bounds.is_refused(term, found, line)
            return None if is_refused else self._bounds.tuned(term, found)
        if isinstance(found, MessageConstant) and isinstance(found.constant.value, int | float):
            value = found.constant.value
            if math.isfinite(value) and not isinstance(value, bool):
                found = Quantity(Fraction(value), None, None, isinstance(value, int))
        if isinstance(found, Value) and line.is_standing:
            self._bounds.refuse(term)
            return None
        if not isinstance(found, Quantity):
            message_text = f"the end of a limit must be a constant number, not '{term.span.text}'"
            self._scope.fault(codes.WRONG_OPERAND, message_text, term.span)
            return None
        if found.unit is None and common is not None:
            return Quantity(found.value, common, common, found.whole)
        return found

    def _shown_in(self, end: _End) -> Unit | None:
        if isinstance(end, Quantity):
            return end.shown_in
        if isinstance(end, ReadEnd):
            return end.unit
        return self._scope.units.parse(end.constant.unit) if end.constant.unit else None

    def _factor(self, end: _End, wanted: Unit | None, term: rules.Term) -> float | None:
        """Return what converts an open end to the unit of the field; report one that does not."""
        return self._bounds.factor(self._shown_in(end), wanted, term)

    def _known(self, end: _End, wanted: Unit | None, term: rules.Term) -> _Known | None:
        """Return what is known of an end; report a unit that is not of the field's dimension."""
        if isinstance(end, Quantity):
            given = end.shown_in
            if given and wanted and not compatible(self._scope, given, wanted, term):
                return None
            value = end.in_unit(wanted)
            return _Known(value, value, is_fixed=True)
        factor = self._factor(end, wanted, term)
        if factor is None:
            return None
        if isinstance(end, ReadEnd):
            return _Known(None, None, is_fixed=False)
        signed = Fraction(factor) * (1 if end.factor > 0 else -1)
        least, greatest = sorted(
            Fraction(each) * signed for each in (end.constant.lower, end.constant.upper)
        )
        return _Known(least, greatest, is_fixed=False)

    def _resolved(
        self, end: _End, wanted: Unit | None, term: rules.Term, kind: FieldType
    ) -> _Resolved | None:
        """Return an end as a gate has it, in the unit of the field."""
        if isinstance(end, Quantity):
            return _held(end.in_unit(wanted), kind)
        factor = self._factor(end, wanted, term)
        if factor is None:
            return None
        return self._bounds.scaled(end.bound if isinstance(end, ReadEnd) else end, factor)

    def _is_limit(
        self, limit: rules.GateLimit, kind: FieldType, lower: _Known, upper: _Known
    ) -> bool:
        """Return whether a gate can keep the field between two ends; report why it cannot."""
        code, hint = codes.GATE_LIMIT, ""
        shown = limit.interval_span.text
        low, high = lower.greatest, upper.least
        fixed = [end.least for end in (lower, upper) if end.is_fixed and end.least is not None]
        if low is not None and high is not None and low > high:
            code = codes.EMPTY_INTERVAL
            message = f"the interval {shown} runs backwards: no value lies in it"
            hint = "write the lesser end first"
            if len(fixed) < 2:
                message = f"the interval {shown} can be tuned so that no value lies in it"
                hint = "narrow the intervals of its constants"
        elif not (limit.lower_closed and limit.upper_closed):
            message = f"the interval {shown} is open: a limit needs a value at each end"
            hint = "write it with '[' and ']'"
        elif (low is not None and low > 0) or (high is not None and high < 0):
            is_tuned = len(fixed) < sum(each is not None for each in (low, high))
            message = f"the limits must include 0, {shown} does not"
            if is_tuned:
                message = f"the limits must include 0, but {shown} can be tuned so that it does not"
            hint = "a limit may slow the robot, but never make it move"
        elif kind.base in INTEGER_RANGES and any(each.denominator != 1 for each in fixed):
            number = with_article(str(kind))
            message = f"'{format_path(limit.path)}' is {number}: its limits must be whole numbers"
        else:
            return True
        self._scope.fault(code, message, limit.interval_span, hint)
        return False


def _held(number: Fraction, kind: FieldType) -> int | float:
    """Return an end as a value of the field: within its type's range, and rounded to it."""
    if kind.base in INTEGER_RANGES:
        least, greatest = type_bounds(kind)
        return int(min(max(number, least), greatest))
    value = rounded(number)
    return as_float32(value) if kind.base == "float32" else value
