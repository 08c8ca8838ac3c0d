"""Resolves what gates publish to stop, and whether that stops anything."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache

from deros import codes
from deros.diagnostics import Related
from deros.interfaces.fields import FieldPath, ResolvedField, format_path, without_indices
from deros.interfaces.types import FLOAT_TYPES, FieldType
from deros.interfaces.units import Unit, UnitRegistry
from deros.models import rules
from deros.rules.compiler.gates.gate_fields import GateFields, check_once, zeroed_fields
from deros.rules.compiler.held_values import held_value
from deros.rules.compiler.scope.resolved import MessageConstant, Plain, Quantity
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.scope.tuned import refuse_tuned
from deros.rules.compiler.terms.conversions import compatible
from deros.rules.compiler.terms.terms import Terms
from deros.rules.program import ir
from deros.rules.program.bounds import as_float32, rounded
from deros.rules.program.commands import QUATERNION

RATES_AND_EFFORTS = (
    *("m/s", "rad/s", "m/s^2", "rad/s^2", "m/s^3", "rad/s^3", "Hz", "m^3/s", "kg/s"),
    *("N", "N*m", "Pa", "A", "V", "W"),
)
"""Units of the dimensions in which zero is a stop: nothing moves, and nothing is pushed."""

_UNCHANGED = {"hold", "silence"}
"""The stops that make no command."""

_CHOICES = "'hold' (the last command that passed) or 'silence'"


class StopResolver:
    """Builds what the lines of gates stop with; errors are reported to the scope."""

    def __init__(self, scope: Scope, terms: Terms) -> None:
        """Look up names in ``scope``, and constants with ``terms``."""
        self._scope = scope
        self._terms = terms

    def check_zero(self, gate: rules.Gate, fields: GateFields) -> None:
        """Report the first zero of a gate for commands of which zero is not a stop."""
        stops = [line.stop for line in gate.lines if line.stop is not None]
        if gate.resume is not None and stops and {each.kind for each in stops} <= _UNCHANGED:
            message = "no line of this gate says which command is one that stops"
            hint = "write 'until reset' behind the lines instead"
            self._scope.fault(codes.ZERO_STOPS_NOTHING, message, gate.resume, hint)
            return
        zeros = [each.span for each in stops if each.kind == "zero"]
        if not stops:  # then what waits, waits at zero
            zeros = [gate.resume] if gate.resume is not None else []
            zeros += [line.span for line in gate.lines if line.wait is not None]
        found = _not_stopped(fields) if zeros else None
        if found is not None:
            path, rank, why, hint = found
            if rank == _UNKNOWN and not self._scope.topics.complete:
                self._scope.untold = True  # the part that could not be loaded may say the unit
                return
            self._scope.fault(codes.ZERO_STOPS_NOTHING, f"'{path}' {why}", zeros[0], hint)

    def stop(self, stop: rules.GateStop, fields: GateFields) -> ir.Stop | None:
        """Return what a line stops with, or ``None`` if something in it is wrong."""
        check_once(self._scope, stop.ramps, "given a ramp")
        check_once(self._scope, stop.sent, "sent")
        ramps = [self._ramp(each, fields) for each in stop.ramps]
        sent = [self._sent(each, fields) for each in stop.sent]
        if None in ramps or None in sent:
            return None
        return ir.Stop(
            stop.kind,
            tuple(each for each in ramps if each is not None),
            tuple(each for each in sent if each is not None),
        )

    def _ramp(self, ramp: rules.StopField, fields: GateFields) -> ir.StopField | None:
        field = fields.number(ramp.path, ramp.path_span, "given a ramp")
        term = ramp.value
        found = self._terms.resolve(term) if field and term else None
        if field is None or term is None or found is None:
            return None
        if refuse_tuned(self._scope, found, term.span, "the rate of a ramp"):
            return None
        if not isinstance(found, Quantity):
            message = f"the rate of a ramp is a constant number, not '{term.span.text}'"
            self._scope.fault(codes.WRONG_OPERAND, message, term.span)
            return None
        unit = fields.unit(ramp.path)
        wanted = self._scope.units.parse(f"{unit.text}/s") if unit else None
        if found.unit is None:
            example = f"'{term.span.text} {wanted.text if wanted else 'm/s^2'}'"
            message = f"the rate '{term.span.text}' has no unit"
            self._scope.fault(codes.GATE_RAMP, message, term.span, f"write {example}")
            return None
        if wanted and not compatible(self._scope, found.unit, wanted, term):
            return None
        rate = rounded(found.in_unit(wanted))
        if rate <= 0:
            message = "a ramp needs a rate above 0: with this one, the field never gets to zero"
            self._scope.fault(codes.GATE_RAMP, message, term.span)
            return None
        return ir.StopField(ramp.path, field.type, rate)

    def _sent(self, sent: rules.StopField, fields: GateFields) -> ir.StopField | None:
        field = fields.own(sent.path, sent.path_span, "sent")
        if field is None:
            return None
        if sent.value is None:
            return self._emptied(sent, field)
        value = self._terms.resolve(sent.value, field.parent)
        what = "what is sent"
        if value is None or refuse_tuned(self._scope, value, sent.value.span, what):
            return None
        unit = fields.unit(sent.path)
        text = sent.value.span.text
        if not isinstance(value, Quantity | Plain | MessageConstant):
            message, hint = f"what is sent is a constant, '{text}' is read from a topic", ""
        elif field.type.is_array or not isinstance(field.type.base, str):
            message = f"'{format_path(sent.path)}' is a {field.type}: no constant is one"
            hint = "name one of its fields or elements"
        else:
            given = value.shown_in if isinstance(value, Quantity) else None
            if unit and given and not compatible(self._scope, given, unit, sent.value):
                return None
            if unit is None and isinstance(value, Quantity) and (given or value.value):
                # As in limits, this says what the unit of the field is.
                target, *sources = ((topic, sent.path) for topic in fields.topics)
                self._scope.field_units.compare((target,), tuple(sources))
                self._scope.field_units.use((target,), given, sent.value.span)
            held = held_value(self._scope.units, field.type, unit, value)
            if held is not None:
                return ir.StopField(sent.path, field.type, held)
            message, hint = f"'{format_path(sent.path)}' ({field.type}) cannot hold '{text}'", ""
        self._scope.fault(codes.GATE_SEND, message, sent.value.span, hint)
        return None

    def check_sent(
        self,
        written: Sequence[rules.GateLine],
        lines: Sequence[ir.GateLine | None],
        gate: GateFields,
    ) -> None:
        """Report numbers that are sent outside the limits that always hold.

        An integer without a unit may be a code that no command has.
        """
        both = [each for each in zip(written, lines, strict=True) if each[1] is not None]
        limits = {
            limit.path: (limit, text)
            for at, line in both
            if line is not None and line.is_standing
            for limit, text in zip(line.limits, at.limits, strict=True)
        }
        for at, line in both:
            stop = line.stop if line is not None else None
            for sent, its in zip(stop.sent, at.stop.sent, strict=True) if stop and at.stop else ():
                limit, text = limits.get(sent.path, (None, None))
                is_code = sent.type.base not in FLOAT_TYPES and gate.unit(sent.path) is None
                if limit is None or text is None or is_code or its.value is None:
                    continue
                least, greatest = _widest(limit)
                if isinstance(sent.value, int | float) and not least <= sent.value <= greatest:
                    self._scope.fault(
                        codes.GATE_SEND,
                        f"'{its.value.span.text}' is outside the limits of"
                        f" '{format_path(sent.path)}' that always hold",
                        its.value.span,
                        "what is sent is not limited: send a value within them",
                        (Related(text.span, "the limits"),),
                    )

    def _emptied(self, sent: rules.StopField, field: ResolvedField) -> ir.StopField | None:
        if field.type.is_array and field.type.array != "fixed":
            return ir.StopField(sent.path, field.type, None)
        message = f"'{format_path(sent.path)}' ({field.type}) is no array that can be empty"
        self._scope.fault(codes.GATE_SEND, message, sent.span)
        return None


def _widest(limit: ir.Limit) -> tuple[float, float]:
    """Return the least and the greatest value that the ends of a limit can have."""
    reached: list[float] = []
    for end in limit.ends:
        if isinstance(end, ir.InputBound):
            reached += (-math.inf, math.inf)
        elif isinstance(end, ir.TunedBound):
            ends = [each * end.factor for each in (end.constant.lower, end.constant.upper)]
            reached += map(as_float32, ends) if limit.type.base == "float32" else ends
        else:
            reached.append(end)
    return min(reached), max(reached)


def _not_stopped(fields: GateFields) -> tuple[str, int, str, str] | None:
    """Return a field that zero does not stop, why, and what to write; ``None`` if it stops all.

    How good the reason is stands before it.
    """
    zeroed = list(zeroed_fields(fields.scope.store, fields.type))
    if not zeroed:
        why = "has nothing that zero would change"
        return fields.type.short, _PLACE, why, f"stop with {_CHOICES}"
    reasons = [(path, *_reason(path, kind, fields)) for path, kind in zeroed]
    bad = [(rank, path, why) for path, rank, why in reasons if why]
    if not bad:
        return None
    rank, path, why = min(bad, key=lambda each: each[0])
    hint = f"stop with {_example(path, fields)}{_CHOICES}"
    if rank == _UNKNOWN:
        name = without_indices(path)[-1]
        hint += f"; or write its unit where its topic is declared, as in '{name} [m/s]'"
    return format_path(path), rank, why, hint


_PLACE, _UNKNOWN, _TIME = range(3)  # the better reason comes first


def _reason(path: FieldPath, kind: FieldType, fields: GateFields) -> tuple[int, str]:
    """Return why zero does not stop a field, or nothing, and how good a reason that is."""
    if kind.base == QUATERNION:
        return _PLACE, "is an orientation: zero turns to it, and stops nothing"
    if kind.base == "bool":
        return _PLACE, "is a flag: which of its values stops is not known"
    unit = fields.unit(path)
    if unit is None:
        names = [step for step in path if isinstance(step, str)]
        if names[-1].startswith("position"):
            return _PLACE, "is a position: zero is a place to go to, not a stop"
        return _UNKNOWN, "has no unit, so whether zero stops it is not known"
    if unit.exponents in _stopped_by_zero():
        return _PLACE, ""
    rank = _TIME if unit.dimension == "time" else _PLACE
    return rank, f"is in {unit.text} ({unit.dimension}): zero is a value like others, not a stop"


def _example(path: FieldPath, fields: GateFields) -> str:
    """Return how a line might stop the field at ``path``, as the first of some choices."""
    whole = fields.scope.store.message(fields.type)
    first = whole.field(str(path[0])) if whole is not None else None
    if first is not None and first.is_array and first.array != "fixed":
        return f"'send {{ {path[0]} = [] }}', "
    if first is None or not isinstance(first.base, str):
        return ""
    return f"'send {{ {format_path(path)} = {'false' if first.base == 'bool' else '0'} }}', "


@cache
def _stopped_by_zero() -> frozenset[object]:
    units = UnitRegistry()
    parsed = [units.parse(each) for each in RATES_AND_EFFORTS]
    return frozenset(each.exponents for each in parsed if isinstance(each, Unit))
