"""Resolves the gates of rules: limited fields, units, actions and times."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction

from deros import codes
from deros.diagnostics import Related, Span
from deros.interfaces.durations import NS_PER_S
from deros.interfaces.fields import FieldPath, ResolvedField, format_path
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import (
    INTEGER_RANGES,
    FieldType,
    InterfaceType,
    MessageDefinition,
)
from deros.interfaces.units import Unit
from deros.models import rules
from deros.models.common import Name
from deros.names.graph_names import resolve_name
from deros.rules.compiler.actions import Actions
from deros.rules.compiler.scope.resolved import MessageConstant, Quantity
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.terms.function_terms import compatible
from deros.rules.compiler.terms.terms import Terms
from deros.rules.program import ir
from deros.rules.program.bounds import as_float32, rounded, type_bounds
from deros.rules.program.commands import LAYOUT, QUATERNION, TIME

SLOWEST_HZ, FASTEST_HZ = 1, 1000
"""The range of the rate at which a gate publishes zeros."""

_INDIVISIBLE = {
    TIME: "a time stamp",
    QUATERNION: "a quaternion",
    LAYOUT: "the layout of an array",
}


class GateResolver:
    """Builds the gates of one program; errors are reported to the scope."""

    def __init__(self, scope: Scope, terms: Terms, actions: Actions) -> None:
        """Look up names in ``scope``, constants with ``terms``, and actions in ``actions``."""
        self._scope = scope
        self._terms = terms
        self._actions = actions

    def build(self, written: tuple[rules.Gate, ...]) -> tuple[ir.Gate, ...]:
        """Return the gates without errors, in the order written."""
        targets = (Name(resolve_name(each.target.text, "/"), each.target.span) for each in written)
        self._scope.check_duplicates(targets, "a gate to '{}'")
        built = (self._gate(index, each) for index, each in enumerate(written))
        return tuple(each for each in built if each is not None)

    def _gate(self, index: int, gate: rules.Gate) -> ir.Gate | None:
        source, target = (resolve_name(each.text, "/") for each in (gate.source, gate.target))
        if source == target:
            message = f"the gate publishes what it reads, '{target}'"
            hint = "let the controller publish on a topic of its own, and name that one first"
            self._scope.fault(codes.GATE_LOOP, message, gate.target.span, hint)
        for name in (gate.source, gate.target):
            self._scope.topic_name(name)
        period_ns = self._period_ns(gate.rate)
        definition = self._scope.message_type(gate.type, gate.type_span)
        if definition is None:
            return None
        self._check_type(gate, (source, target))
        lines = [self._line(line, gate, (target, source)) for line in gate.lines]
        if period_ns is None or None in lines:
            return None
        return ir.Gate(
            index,
            source,
            target,
            gate.type,
            period_ns,
            tuple(each for each in lines if each is not None),
            gate.span,
            gate.description,
            gate.resume is not None,
        )

    def _check_type(self, gate: rules.Gate, topics: tuple[str, str]) -> None:
        values = list(_values(self._scope.store, gate.type))
        unknown = [each.base for each in values if isinstance(each.base, InterfaceType)]
        if unknown:
            self._scope.message_type(unknown[0], gate.type_span)
        elif not any(each.is_number for each in values):
            message = f"{gate.type.short} has no number that could be limited or made zero"
            self._scope.fault(codes.GATE_WITHOUT_NUMBERS, message, gate.type_span)
        for topic in topics:
            known = self._scope.topics.get(topic)
            if known is not None and known.type is not None and known.type != gate.type:
                message = f"the gate is for {gate.type.short}, '{topic}' is of {known.type.short}"
                place = (Related(known.place, "the topic"),)
                self._scope.fault(codes.TYPE_MISMATCH, message, gate.type_span, related=place)

    def _period_ns(self, rate: rules.Number) -> int | None:
        """Return the time between two zeros, rounded down: the rate is kept or exceeded."""
        if rate.unit is None:
            message = f"the rate '{rate.value}' has no unit"
            self._scope.fault(codes.GATE_RATE, message, rate.span, f"write '{rate.value} Hz'")
            return None
        place = rate.unit_span or rate.span
        unit = self._scope.unit(rate.unit, place)
        if unit is None:
            return None
        if unit.exponents != (("s", Fraction(-1)),):
            message = f"a rate is needed, but '{rate.unit}' is a unit of {unit.dimension}"
            self._scope.fault(codes.INCOMPATIBLE_UNITS, message, place, "write '20 Hz'")
            return None
        hertz = Fraction(rate.value) * unit.factor
        if not SLOWEST_HZ <= hertz <= FASTEST_HZ:
            message = f"the rate of a gate is {SLOWEST_HZ} to {FASTEST_HZ} Hz"
            self._scope.fault(codes.GATE_RATE, message, rate.span)
            return None
        return math.floor(NS_PER_S / hertz)

    # Lines --------------------------------------------------------------------------------------

    def _line(
        self, line: rules.GateLine, gate: rules.Gate, topics: tuple[str, str]
    ) -> ir.GateLine | None:
        limits = tuple(self._limits(line, gate, topics))
        if line.until_reset and line.limits:
            message = "a limit cannot last until a reset, only a zero can"
            hint = "write 'zero until reset', or leave 'until reset' out"
            self._scope.fault(codes.GATE_LIMIT_UNTIL_RESET, message, line.span, hint)
            return None
        action = lost_ns = None
        if line.action is not None:
            action = self._actions.bound(line.action)
        elif line.duration is not None:
            lost_ns = self._lost_ns(line.duration)
        if len(limits) < len(line.limits) or (action is None and lost_ns is None):
            return None
        return ir.GateLine(action, line.lost, lost_ns, limits, line.span, line.until_reset)

    def _lost_ns(self, duration: rules.Number) -> int | None:
        lost_ns = self._scope.duration_ns(duration)
        if lost_ns == 0:
            message = "a time of 0 means always lost"
            self._scope.fault(codes.BAD_DURATION, message, duration.span)
            return None
        return lost_ns

    # Limits -------------------------------------------------------------------------------------

    def _limits(
        self, line: rules.GateLine, gate: rules.Gate, topics: tuple[str, str]
    ) -> Iterator[ir.Limit]:
        first: dict[FieldPath, rules.GateLimit] = {}
        for limit in line.limits:
            earlier = first.setdefault(limit.path, limit)
            if earlier is not limit:
                message = f"'{format_path(limit.path)}' is limited twice in one line"
                place = (Related(earlier.span, "first limited here"),)
                self._scope.fault(
                    codes.DUPLICATE_RULE_NAME, message, limit.path_span, related=place
                )
            field = self._field(limit, gate)
            ends = self._ends(limit, field, gate, topics) if field else None
            if field and ends:
                yield ir.Limit(limit.path, field.type, *ends)

    def _field(self, limit: rules.GateLimit, gate: rules.Gate) -> ResolvedField | None:
        """Resolve the limited field; report one that is not a number, or not one by itself."""
        span = limit.path_span
        before = Span(span.source, span.start, span.start)
        found = self._scope.field(gate.type, limit.path, before, span, len(limit.path))
        if found is None:
            return None
        if not found.type.is_number:
            kind = found.type
            text = str(kind).replace(str(kind.base), getattr(kind.base, "short", str(kind.base)))
            message = (
                f"a number is needed here, but '{format_path(limit.path)}' is {_article(text)}"
            )
            hint = "name one of its elements, as in 'data[0]'" if kind.is_array else ""
            self._scope.fault(codes.FIELD_NOT_NUMERIC, message, span, hint)
            return None
        whole = _INDIVISIBLE.get(found.parent.type) if found.parent else None
        if whole is not None:
            message = f"'{found.name}' of {whole} cannot be limited by itself"
            self._scope.fault(codes.GATE_LIMIT, message, span)
            return None
        return found

    def _unit(
        self, limit: rules.GateLimit, gate: rules.Gate, topics: tuple[str, str]
    ) -> Unit | None:
        """Return the unit of the field: from node descriptions, else from REP 103."""
        for topic in topics:
            if self._scope.topics.get(topic) is not None:
                unit = self._scope.field_units.unit_of(topic, gate.type, limit.path)
                if unit is not None:
                    return unit
        return self._scope.field_units.unit_of(topics[0], gate.type, limit.path)

    def _ends(
        self,
        limit: rules.GateLimit,
        field: ResolvedField,
        gate: rules.Gate,
        topics: tuple[str, str],
    ) -> tuple[int | float, int | float] | None:
        unit, common = self._unit(limit, gate, topics), None
        if limit.unit is not None:
            common = self._common_unit(limit, limit.unit, unit)
            if common is None:
                return None
        ends = [self._end(term, common, field.parent) for term in (limit.lower, limit.upper)]
        lower, upper = ends
        if lower is None or upper is None:
            return None
        wanted = unit or common or lower.shown_in or upper.shown_in
        for end, term in ((lower, limit.lower), (upper, limit.upper)):
            given = end.shown_in
            if given and wanted and not compatible(self._scope, given, wanted, term):
                return None
        least, greatest = lower.in_unit(wanted), upper.in_unit(wanted)
        if unit is None and (wanted is not None or least or greatest):
            fields = tuple((topic, limit.path) for topic in topics)
            self._scope.field_units.compare(fields[:1], fields[1:])
            self._scope.field_units.use(fields[:1], wanted, limit.interval_span)
        if not self._is_limit(limit, field.type, least, greatest):
            return None
        return _held(least, field.type), _held(greatest, field.type)

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

    def _end(
        self, term: rules.Term, common: Unit | None, message: MessageDefinition | None
    ) -> Quantity | None:
        """Return one end of an interval; a plain number is in the unit after the interval."""
        found = self._terms.resolve(term, message)
        if found is None:
            return None
        if isinstance(found, MessageConstant) and isinstance(found.constant.value, int | float):
            value = found.constant.value
            if math.isfinite(value) and not isinstance(value, bool):
                found = Quantity(Fraction(value), None, None, isinstance(value, int))
        if not isinstance(found, Quantity):
            message_text = f"the end of a limit must be a constant number, not '{term.span.text}'"
            self._scope.fault(codes.WRONG_OPERAND, message_text, term.span)
            return None
        if found.unit is None and common is not None:
            return Quantity(found.value, common, common, found.whole)
        return found

    def _is_limit(
        self, limit: rules.GateLimit, kind: FieldType, least: Fraction, greatest: Fraction
    ) -> bool:
        """Return whether a gate can keep the field between two ends; report why it cannot."""
        code, hint = codes.GATE_LIMIT, ""
        shown = limit.interval_span.text
        if least > greatest:
            code = codes.EMPTY_INTERVAL
            message = f"the interval {shown} runs backwards: no value lies in it"
            hint = "write the lesser end first"
        elif not (limit.lower_closed and limit.upper_closed):
            message = f"the interval {shown} is open: a limit needs a value at each end"
            hint = "write it with '[' and ']'"
        elif not least <= 0 <= greatest:
            message = f"the limits must include 0, {shown} does not"
            hint = "a limit may slow the robot, but never make it move"
        elif kind.base in INTEGER_RANGES and (least.denominator, greatest.denominator) != (1, 1):
            number = _article(str(kind))
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


def _values(store: InterfaceStore, kind: InterfaceType) -> Iterator[FieldType]:
    """Yield the type of every value of a command, in arrays and nested messages too.

    An unknown message type is yielded itself.
    """
    definition = store.message(kind)
    if definition is None:
        yield FieldType(kind)
    elif kind not in (TIME, LAYOUT):
        for _, each in definition.fields:
            if isinstance(each.base, str):
                yield each.element
            else:
                yield from _values(store, each.base)


def _article(kind: str) -> str:
    return f"{'an' if kind[0] in 'aeio' else 'a'} {kind}"
