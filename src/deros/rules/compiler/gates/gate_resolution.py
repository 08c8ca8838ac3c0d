"""Resolves the gates of rules: limited fields, units, actions and times."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction

from deros import codes
from deros.diagnostics import Related, Span
from deros.interfaces.durations import NS_PER_S
from deros.interfaces.fields import ResolvedField, format_path
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
from deros.rules.compiler.gates.gate_fields import (
    GateFields,
    check_once,
    with_article,
    zeroed_fields,
)
from deros.rules.compiler.gates.gate_stops import StopResolver
from deros.rules.compiler.scope.resolved import MessageConstant, Quantity
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.scope.tuned import refuse_tuned
from deros.rules.compiler.terms.function_terms import compatible
from deros.rules.compiler.terms.terms import Terms
from deros.rules.program import ir
from deros.rules.program.bounds import as_float32, rounded, type_bounds
from deros.rules.program.commands import QUATERNION

SLOWEST_HZ, FASTEST_HZ = 1, 1000
"""The range of the rate at which a gate publishes zeros."""


class GateResolver:
    """Builds the gates of one program; errors are reported to the scope."""

    def __init__(self, scope: Scope, terms: Terms, actions: Actions) -> None:
        """Look up names in ``scope``, constants with ``terms``, and actions in ``actions``."""
        self._scope = scope
        self._terms = terms
        self._actions = actions
        self._stops = StopResolver(scope, terms)

    def build(self, written: tuple[rules.Gate, ...]) -> tuple[ir.Gate, ...]:
        """Return the gates without errors, in the order written."""
        targets = (Name(resolve_name(each.target.text, "/"), each.target.span) for each in written)
        order = "gate /a for 0.5 sec over /b for 0.5 sec -> …"
        hint = f"one gate takes several sources in order: '{order}'"
        self._scope.check_duplicates(targets, "a gate to '{}'", hint)
        built = (self._gate(index, each) for index, each in enumerate(written))
        return tuple(each for each in built if each is not None)

    def _gate(self, index: int, gate: rules.Gate) -> ir.Gate | None:
        names = [Name(resolve_name(e.topic.text, "/"), e.topic.span) for e in gate.sources]
        target = resolve_name(gate.target.text, "/")
        if target in [each.text for each in names]:
            message = f"the gate publishes what it reads, '{target}'"
            hint = "let the controller publish on a topic of its own, and name that one first"
            self._scope.fault(codes.GATE_LOOP, message, gate.target.span, hint)
        for name in (*(each.topic for each in gate.sources), gate.target):
            self._scope.topic_name(name)
        self._scope.check_duplicates(names, "the source '{}' of this gate")
        sources = [self._source(each) for each in gate.sources]
        is_timed = self._check_times(gate)
        period_ns = self._period_ns(gate.rate)
        definition = self._scope.message_type(gate.type, gate.type_span)
        if definition is None:
            return None
        topics = tuple(each.text for each in names)
        fields = GateFields(self._scope, gate.type, (target, *topics))
        if self._check_type(gate, (*topics, target)):
            self._stops.check_zero(gate, fields)
        self._check_standing(gate)
        lines = [self._line(line, fields) for line in gate.lines]
        if period_ns is None or not is_timed or None in lines or None in sources:
            return None
        return ir.Gate(
            index,
            tuple(each for each in sources if each is not None),
            target,
            gate.type,
            period_ns,
            tuple(each for each in lines if each is not None),
            gate.span,
            gate.description,
            gate.resume is not None,
        )

    def _check_type(self, gate: rules.Gate, topics: tuple[str, ...]) -> bool:
        """Return whether the type is known as a whole, and that of its topics; report it if not."""
        for _, kind in zeroed_fields(self._scope.store, gate.type):
            if isinstance(kind.base, InterfaceType) and kind.base != QUATERNION:
                self._scope.message_type(kind.base, gate.type_span)
                return False
        known = [each for each in map(self._scope.topics.get, topics) if each is not None]
        others = [each for each in known if each.type is not None and each.type != gate.type]
        for topic in others:
            of_topic = topic.type.short if topic.type is not None else ""
            message = f"the gate is for {gate.type.short}, '{topic.name}' is of {of_topic}"
            place = (Related(topic.place, "the topic"),)
            self._scope.fault(
                codes.TYPE_MISMATCH, message, gate.type_span, related=place, subjects=(of_topic,)
            )
        return not others

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

    # Sources ------------------------------------------------------------------------------------

    def _source(self, source: rules.GateSource) -> ir.Source | None:
        topic, silent_ns = resolve_name(source.topic.text, "/"), None
        if source.duration is not None:
            silent_ns = self._lost_ns(source.duration)
            if silent_ns is None:
                return None
        return ir.Source(topic, silent_ns, source.from_zero)

    def _check_times(self, gate: rules.Gate) -> bool:
        """Return whether each loss has one time: its own, or that of the sources; report others."""
        timed = [each for each in gate.sources if each.duration is not None]
        faults: list[tuple[str, Span, str]] = []
        if timed or len(gate.sources) > 1:
            for each in gate.sources:
                if each.duration is None:
                    message = f"nothing says how long the last command on '{each.topic}' counts"
                    hint = f"write '{each.topic} for 0.5 sec'"
                    faults.append((message, each.topic.span, hint))
        for line in gate.lines:
            if line.duration is not None and line.lost == "input" and timed:
                message = "the input is lost when all sources are, and each has its own time"
                faults.append((message, line.duration.span, "write 'lost input: …'"))
            needs_time = line.lost == "heartbeat" or (len(gate.sources) == 1 and not timed)
            if line.lost is not None and line.duration is None and needs_time:
                message = f"nothing says after which silence the {line.lost} is lost"
                hint = f"write 'lost {line.lost} for 0.5 sec: …'"
                faults.append((message, line.span, hint))
        for message, span, hint in faults:
            self._scope.fault(codes.TIME_OF_LOSS, message, span, hint)
        return not faults

    # Lines --------------------------------------------------------------------------------------

    def _line(self, line: rules.GateLine, fields: GateFields) -> ir.GateLine | None:
        limits = tuple(self._limits(line, fields))
        if line.until_reset and line.limits:
            message = "a limit cannot last until a reset, only a stop can"
            hint = "write 'zero until reset', or leave 'until reset' out"
            self._scope.fault(codes.GATE_LIMIT_UNTIL_RESET, message, line.span, hint)
            return None
        stop = self._stops.stop(line.stop, fields) if line.stop is not None else None
        action = lost_ns = None
        if line.action is not None:
            action = self._actions.bound(line.action)
        elif line.duration is not None:
            lost_ns = self._lost_ns(line.duration)
        elif line.lost is not None:
            lost_ns = 0  # the sources have the time
        wait_ns = None if line.wait is None else self._lost_ns(line.wait)
        if line.wait is not None and wait_ns is None:
            return None
        is_known = action is not None or lost_ns is not None or line.is_standing
        if len(limits) < len(line.limits) or not is_known or (line.stop and stop is None):
            return None
        return ir.GateLine(
            action, line.lost, lost_ns, limits, line.span, line.until_reset, stop, wait_ns
        )

    def _check_standing(self, gate: rules.Gate) -> None:
        """Report fields that two standing lines limit: which one holds must not be a question."""
        standing = [each for line in gate.lines if line.is_standing for each in line.limits]
        if standing:
            check_once(self._scope, tuple(standing), "limited")

    def _lost_ns(self, duration: rules.Number) -> int | None:
        lost_ns = self._scope.duration_ns(duration)
        if lost_ns == 0:
            message = "a time of 0 means always lost, or no wait at all"
            self._scope.fault(codes.BAD_DURATION, message, duration.span)
            return None
        return lost_ns

    # Limits -------------------------------------------------------------------------------------

    def _limits(self, line: rules.GateLine, fields: GateFields) -> Iterator[ir.Limit]:
        if not line.is_standing:
            check_once(self._scope, line.limits, "limited")
        for limit in line.limits:
            field = fields.number(limit.path, limit.path_span, "limited")
            ends = self._ends(limit, field, fields) if field else None
            if field and ends:
                yield ir.Limit(limit.path, field.type, *ends)

    def _ends(
        self, limit: rules.GateLimit, field: ResolvedField, gate: GateFields
    ) -> tuple[int | float, int | float] | None:
        unit, common = gate.unit(limit.path), None
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
            fields = tuple((topic, limit.path) for topic in gate.topics)
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
        if found is None or refuse_tuned(self._scope, found, term.span, "the end of a limit"):
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
