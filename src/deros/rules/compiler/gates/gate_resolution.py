"""Resolves the gates of rules: limited fields, units, actions and times."""

from __future__ import annotations

import math
from fractions import Fraction

from deros import codes
from deros.diagnostics import Related, Span
from deros.interfaces.durations import NS_PER_S
from deros.interfaces.types import (
    InterfaceType,
)
from deros.models import rules
from deros.models.common import Name
from deros.names.graph_names import resolve_name
from deros.rules.compiler.actions import Actions
from deros.rules.compiler.gates.gate_fields import (
    GateFields,
    check_once,
    zeroed_fields,
)
from deros.rules.compiler.gates.gate_limits import LimitResolver
from deros.rules.compiler.gates.gate_stops import StopResolver
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.terms.terms import Terms
from deros.rules.program import ir
from deros.rules.program.commands import QUATERNION

SLOWEST_HZ, FASTEST_HZ = 1, 1000
"""The range of the rate at which a gate publishes zeros."""


class GateResolver:
    """Builds the gates of one program; errors are reported to the scope."""

    def __init__(self, scope: Scope, terms: Terms, actions: Actions) -> None:
        """Look up names in ``scope``, constants with ``terms``, and actions in ``actions``."""
        self._scope = scope
        self._limits = LimitResolver(scope, terms)
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
        fields = GateFields(self._scope, gate.type, (target, *topics), self._states(gate))
        if self._check_type(gate, (*topics, target)):
            self._stops.check_zero(gate, fields)
        self._check_standing(gate)
        lines = [self._line(line, fields) for line in gate.lines]
        self._stops.check_sent(gate.lines, lines, fields)
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
        limits = tuple(self._limits.of(line, fields))
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

    def _states(self, gate: rules.Gate) -> frozenset[str]:
        """Return the topics that the gate reads the states of actions from."""
        named = {line.action.text for line in gate.lines if line.action is not None}
        return self._actions.state_topics(named)

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
