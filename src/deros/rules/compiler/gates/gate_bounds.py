"""Resolves ends of standing limits that are fields of inputs, or tunable constants."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

from deros import codes
from deros.interfaces.fields import FieldPath, format_steps
from deros.interfaces.units import Unit
from deros.models import rules
from deros.rules.compiler.gates.gate_fields import by_key, type_text, with_article
from deros.rules.compiler.scope.resolved import DeclaredInput, FieldKey, Value
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.scope.tuned import refuse_tuned
from deros.rules.compiler.terms.conversions import compatible
from deros.rules.program import ir
from deros.systems.safety_nodes import LOSSES_IN_SIMULATED_TIME

OpenEnd = ir.InputBound | ir.TunedBound

_MEANT = "a constant, a tunable constant, or a field of an input, each with or without '-'"


@dataclass(frozen=True, slots=True)
class ReadEnd:
    """An end that is read from an input: ``field`` is the key of what is read."""

    bound: ir.InputBound
    unit: Unit | None
    field: FieldKey


class BoundResolver:
    """Builds the ends of limits that others give; errors are reported to the scope."""

    def __init__(self, scope: Scope) -> None:
        """Look up names in ``scope``."""
        self._scope = scope

    def is_read(self, term: rules.Term) -> bool:
        """Return whether a term is a field of an input, or its negation."""
        operand = _operand(term)
        if isinstance(operand, rules.NamePath):
            return operand.name.text in self._scope.inputs
        return isinstance(operand, rules.TopicPath)

    def read(self, term: rules.Term, taken: tuple[str, ...]) -> ReadEnd | None:
        """Return an end that is a field of an input; its factor is that of its sign.

        ``taken`` are the topics that the gate has other ports for.
        """
        operand = _operand(term)
        found: DeclaredInput | None
        if isinstance(operand, rules.TopicPath):
            found = self._scope.anonymous(operand)
            path: FieldPath = found.path if found is not None else ()
            before, written = operand.topic.span, len(operand.path)
        else:
            assert isinstance(operand, rules.NamePath)
            found = self._scope.inputs[operand.name.text]
            path = (*(found.path if found is not None else ()), *operand.path)
            before, written = operand.name.span, len(operand.path)
        if found is None:
            return None
        field = self._scope.field(found.type, path, before, operand.span, written)
        if field is None:
            return None
        if not field.type.is_number:
            kind = with_article(type_text(field.type))
            message = f"the end of a limit is a number, '{operand.span.text}' is {kind}"
            is_whole = field.type.is_array or not isinstance(field.type.base, str)
            hint = "name the field or the element that holds it" if is_whole else ""
            self._scope.fault(codes.FIELD_NOT_NUMERIC, message, operand.span, hint)
            return None
        if found.needs_one_publisher:
            message = f"'{operand.span.text}' is unknown while there are several publishers"
            hint = "declare an input for the limit without 'on_second_publisher unknown'"
            self._scope.fault(codes.GATE_BOUND, f"{message}, which a gate cannot know", term.span)
            return None
        if by_key(path):
            message = f"'{operand.span.text}' is found by a key, which a gate does not look up"
            hint = "name its index, or let the number come on a topic of its own"
            self._scope.fault(codes.GATE_BOUND, message, term.span, hint)
            return None
        if found.topic in taken:
            message = f"the gate already uses '{found.topic}' for something else than this limit"
            hint = "let the number come on a topic of its own"
            self._scope.fault(codes.GATE_BOUND, message, term.span, hint)
            return None
        name = found.topic + format_steps(path)
        if isinstance(operand, rules.NamePath):
            name = operand.span.text
        bound = ir.InputBound(
            term.span.text,
            name,
            found.topic,
            found.type,
            tuple(path),
            field.type,
            found.timeout_ns,
            _sign(term),
            term.span,
        )
        unit = self._scope.field_units.unit_of(found.topic, found.type, path)
        return ReadEnd(bound, unit, (found.topic, tuple(path)))

    def tuned(self, term: rules.Term, found: Value) -> ir.TunedBound | None:
        """Return an end that is a tunable constant; report one that is computed of it."""
        expression = found.expression
        if not isinstance(expression, ir.Tuned):
            self.refuse(term)
            return None
        constant = self._scope.tunables[expression.constant]
        if constant.name == LOSSES_IN_SIMULATED_TIME:
            message = f"the gate has a parameter '{constant.name}' of its own"
            hint = f"call the constant '{constant.name}_' or the like"
            self._scope.fault(codes.TUNABLE_NAME_TAKEN, message, term.span, hint)
            return None
        return ir.TunedBound(term.span.text, constant, -1.0 if expression.negated else 1.0)

    def refuse(self, term: rules.Term) -> None:
        """Report an end that a gate cannot find out."""
        message = f"the end of a limit is {_MEANT}: '{term.span.text}' is computed"
        hint = "let a node compute it, and publish it on a topic that is an input"
        self._scope.fault(codes.GATE_BOUND, message, term.span, hint)

    def is_refused(self, term: rules.Term, found: object, line: rules.GateLine) -> bool:
        """Return whether an end of a limit is open on a line that does not stand; report it."""
        if line.is_standing:
            return False
        if isinstance(found, Value):
            return refuse_tuned(self._scope, found, term.span, "the end of a limit")
        message = f"'{term.span.text}' may only be the end of a limit that always holds"
        hint = "write a number here, and 'always: limit …' in a line of its own"
        self._scope.fault(codes.GATE_BOUND, message, term.span, hint)
        return True

    def factor(self, given: Unit | None, wanted: Unit | None, term: rules.Term) -> float | None:
        """Return what converts a number to a unit; report a unit that does not convert."""
        if given is None or wanted is None or given.text == wanted.text:
            return 1.0
        if not compatible(self._scope, given, wanted, term):
            return None
        factor, offset = self._scope.units.factor(given, wanted)
        if offset:
            message = f"'{term.span.text}' is in {given.text}, whose zero is not that of {wanted}"
            self._scope.fault(codes.GATE_BOUND, message, term.span, f"use one in {wanted}")
            return None
        return factor

    def scaled(self, bound: OpenEnd, factor: float) -> OpenEnd:
        """Return an end whose number is multiplied with a factor, beside its sign."""
        return dataclasses.replace(bound, factor=bound.factor * factor)


def _operand(term: rules.Term) -> rules.Term:
    while isinstance(term, rules.Negative):
        term = term.operand
    return term


def _sign(term: rules.Term) -> float:
    sign = 1.0
    while isinstance(term, rules.Negative):
        term, sign = term.operand, -sign
    return sign
