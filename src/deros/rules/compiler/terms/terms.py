"""Resolves terms of the rules: numbers, names, field paths and functions of the table."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from fractions import Fraction

from deros import codes
from deros.diagnostics import Fix, Span
from deros.interfaces.fields import FieldPath, ResolvedField
from deros.interfaces.types import FieldType, InterfaceType, MessageDefinition
from deros.metamodels.reading import MAX_DEPTH, too_deep
from deros.models import rules
from deros.names.names import did_you_mean, near
from deros.rules.compiler.scope.mentions import Mention, MentionKind
from deros.rules.compiler.scope.resolved import (
    AppliedFunction,
    DeclaredInput,
    EntriesHold,
    MessageConstant,
    Part,
    Plain,
    Quantity,
    Resolved,
    Value,
    is_written_whole,
)
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.scope.tuned import negated, refuse_tuned
from deros.rules.compiler.scope.zones import DeclaredZone
from deros.rules.compiler.terms.arithmetic import ArithmeticTerm
from deros.rules.compiler.terms.entries import Entries
from deros.rules.compiler.terms.function_terms import FunctionTerms
from deros.rules.compiler.terms.operations import is_arithmetic
from deros.rules.compiler.terms.term_names import rules_called
from deros.rules.compiler.terms.zone_terms import ZoneTerms
from deros.rules.program import ir
from deros.rules.program.bounds import type_bounds
from deros.systems.safety_nodes import parameter_names
from deros.systems.tunables import TunableFault, tunable_constant

_NOTHING = frozenset({"none", "null", "nil", "nan", "undefined"})


class Terms:
    """Resolves terms within a scope. ``None`` means that a fault has been reported."""

    def __init__(
        self,
        scope: Scope,
        rules_of: Mapping[str, Sequence[str]],
        actions: Container[str] = frozenset(),
        zones: Mapping[str, DeclaredZone | None] | None = None,
    ) -> None:
        """Resolve in a scope; the rules of each entity and the actions are for hints."""
        self.zones = ZoneTerms(scope, zones or {})
        self._scope = scope
        self._rules_of = rules_of
        self._actions = actions
        self._constants: dict[str, Resolved | None] = {}
        self._open_constants: set[str] = set()
        self.of_functions = FunctionTerms(scope, self.resolve, self.zones)
        self.entries = Entries(scope)

    @property
    def functions(self) -> list[AppliedFunction]:
        """The functions of messages and arrays, as they were met."""
        return self.of_functions.found

    @property
    def values(self) -> dict[str, Resolved]:
        """The values of the constants that have one, by name."""
        return {name: each for name, each in self._constants.items() if each is not None}

    def resolve(
        self, term: rules.Term, message: MessageDefinition | None = None
    ) -> Resolved | None:
        """Return the resolved term; constants of ``message`` may be used by name."""
        match term:
            case rules.Number():
                return self._number(term)
            case rules.Boolean() | rules.String():
                return Plain(term.value)
            case rules.Arithmetic():
                return self._arithmetic(term)
            case rules.Call() if is_arithmetic(term):
                return self._arithmetic(term)
            case rules.Negative() if self._is_read(term.operand):
                return self._arithmetic(term)
            case rules.Negative():
                return self._negative(term, message)
            case rules.TopicPath():
                found = self._scope.anonymous(term)
                if found is None:
                    return None
                return self._located(found, found.path, term.topic.span, term.span)
            case rules.NamePath():
                return self._name(term, message)
            case rules.Call(receiver=receiver) if receiver is not None and self.entries.is_open:
                self.entries.refuse(f"'{term.function}()' is not a function of entries", term.span)
                return None
            case rules.Call():
                return self.of_functions.call(term)
            case rules.Entries():
                return self._entries(term)

    def _entries(self, term: rules.Entries) -> Value | EntriesHold | None:
        if self.entries.is_open:
            self.entries.refuse(f"'{term.word}()' stands in a condition on entries", term.span)
            return None
        found = self.entries.resolve(term)
        if found is None:
            return None
        value, applied = found
        self.of_functions.found.append(applied)
        return value

    def is_open(self, term: rules.Term) -> bool:
        """Return whether ``term`` is a name that only a message's own constants can define."""
        while isinstance(term, rules.Negative):
            term = term.operand
        return (
            isinstance(term, rules.NamePath)
            and not term.path
            and term.name.text not in self._scope.constants
            and term.name.text not in self._scope.inputs
        )

    def _arithmetic(self, term: rules.Term) -> Value | Quantity | None:
        resolver = ArithmeticTerm(self._scope, self.resolve)
        found = resolver.value(term)
        if isinstance(found, Value) and isinstance(found.expression, ir.Compute):
            applied = AppliedFunction(
                found.expression, found.type, term.span, resolver.unknown_while
            )
            self.of_functions.found.append(applied)
        return found

    def _is_read(self, term: rules.Term) -> bool:
        """Return whether a term is read from a topic, or is a function of such a term."""
        match term:
            case rules.TopicPath() | rules.Call(receiver=rules.TopicPath() | rules.NamePath()):
                return True
            case rules.Call(receiver=rules.Call() as receiver):
                return self._is_read(receiver)
            case rules.NamePath():
                return term.name.text in self._scope.inputs
        return is_arithmetic(term)

    # Constants ----------------------------------------------------------------------------------

    def _number(self, number: rules.Number) -> Quantity | None:
        unit = None
        if number.unit is not None:
            unit = self._scope.unit(number.unit, number.unit_span or number.span)
            if unit is None:
                return None
        return Quantity(Fraction(number.value), unit, unit, is_written_whole(number.value))

    def _negative(
        self, term: rules.Negative, message: MessageDefinition | None
    ) -> Quantity | Value | None:
        operand = self.resolve(term.operand, message)
        if isinstance(operand, Value) and operand.is_tuned:
            return negated(operand) if not _has_offset(operand) else self._arithmetic(term)
        if isinstance(operand, Quantity):
            return Quantity(-operand.value, operand.unit, operand.shown_in, operand.whole)
        if operand is not None:
            wrong = f"'-' stands before numbers only, not '{term.operand.span.text}'"
            self._scope.fault(codes.WRONG_OPERAND, wrong, term.span)
        return None

    def _name(self, term: rules.NamePath, message: MessageDefinition | None) -> Resolved | None:
        name = term.name.text
        if name in self._scope.inputs:
            self._mention("input", term)
            found = self._scope.inputs[name]
            if found is None:
                return None
            return self._located(found, (*found.path, *term.path), term.name.span, term.span)
        if name in self._scope.constants:
            self._mention("constant", term)
            if not term.path:
                return self.constant(name)
            self._scope.fault(codes.UNKNOWN_FIELD, f"constant '{name}' has no fields", term.span)
            return None
        own = message.constants if message else ()
        if not term.path:
            for constant in own:
                if constant.name == name:
                    self._mention("message constant", term)
                    return MessageConstant(constant)
        names = [*self._scope.constants, *self._scope.inputs, *(each.name for each in own)]
        hint = did_you_mean(near(name, names) or rules_called(name, self._rules_of))
        if name in self._rules_of:
            hint = "a rule is not compared: it stands alone in a condition, or after 'not'"
        elif name in self._actions:
            hint = f"an action is not compared: '{name}.active' stands alone, or after 'not'"
        fix = None
        if name.lower() in ("true", "false"):
            hint, fix = f"write '{name.lower()}'", Fix(term.name.span, name.lower())
        elif name in self.zones.names:
            hint = f"a zone is not compared: 'POINT.inside({name})' stands alone, or after 'not'"
        elif name.lower() in _NOTHING:
            hint = "whether an input has fallen silent is 'INPUT.missing()'"
        self._scope.fault(
            codes.UNKNOWN_NAME, f"unknown name '{name}'", term.name.span, hint, fix=fix
        )
        return None

    def _mention(self, kind: MentionKind, term: rules.NamePath) -> None:
        self._scope.mentions.append(Mention(kind, term.name.text, term.name.span))

    def constant(self, name: str) -> Resolved | None:
        """Return the value of a declared constant."""
        if name not in self._constants:
            declared = self._scope.constants[name]
            if name in self._open_constants:
                message = f"constant '{name}' is defined by itself"
                self._scope.fault(codes.UNKNOWN_NAME, message, declared.value.span)
                return None
            self._open_constants.add(name)
            if self._scope.nesting > MAX_DEPTH:
                self._scope.diagnostics.append(too_deep(declared.value.span))
                self._constants[name] = None
                return None
            if declared.tunable is not None:
                self._constants[name] = self._tunable(declared, declared.tunable)
                return self._constants[name]
            self._scope.nesting += 1
            found = self.resolve(declared.value)
            self._scope.nesting -= 1
            if refuse_tuned(
                self._scope, found, declared.value.span, f"the value of constant '{name}'"
            ):
                found = None
            if found is not None and not isinstance(found, (Quantity, Plain)):
                message = f"constant '{name}' is no number, boolean or text"
                hint = f"'input {name} = ...' names a value read from a topic"
                self._scope.fault(codes.WRONG_OPERAND, message, declared.value.span, hint)
                found = None
            self._constants[name] = found
        return self._constants[name]

    def _tunable(self, declared: rules.Constant, tunable: rules.TunableIn) -> Value | None:
        """Return the value of a tunable constant, and make it one of the program."""
        places = [(tunable.unit, tunable.unit_span or tunable.span)]
        for term in (declared.value, tunable.lower, tunable.upper):
            while isinstance(term, rules.Negative):
                term = term.operand
            if isinstance(term, rules.Number):
                places.append((term.unit, term.unit_span or term.span))
        if None in [self._scope.unit(text, place) for text, place in places if text is not None]:
            return None
        found = tunable_constant(declared, self._scope.units)
        if isinstance(found, TunableFault):
            self._scope.fault(codes.BAD_TUNABLE, found.message, found.span, found.hint)
            return None
        if found.name in parameter_names():
            message = f"the safety node has a parameter '{found.name}' of its own"
            hint = f"call the constant '{found.name}_' or the like"
            self._scope.fault(codes.TUNABLE_NAME_TAKEN, message, declared.name.span, hint)
            return None
        self._scope.tunables.append(found)
        return Value(
            ir.Tuned(len(self._scope.tunables) - 1),
            FieldType("float64"),
            self._scope.units.parse(found.unit or "1"),
            None,
            (Fraction(found.lower), Fraction(found.upper)),
        )

    # Fields -------------------------------------------------------------------------------------

    def _located(
        self, owner: DeclaredInput, path: FieldPath, before: Span, span: Span
    ) -> Value | Part | None:
        """Return the field at ``path`` of an input's message."""
        tail = len(path) - len(owner.path)
        found = self._scope.field(owner.type, path, before, span, tail, owner.topic)
        if found is None:
            return None
        if self.entries.is_open:
            return self.entries.entry(owner, path, found, span)
        if found.type.is_array or isinstance(found.type.base, InterfaceType):
            return Part(owner, path, found.type, found.parent)
        return self._value(owner, path, found)

    def _value(self, owner: DeclaredInput, path: FieldPath, found: ResolvedField) -> Value:
        units = self._scope.field_units
        unit = units.unit_of(owner.topic, owner.type, path)
        return Value(
            self._scope.read(owner, path, found.type),
            found.type,
            unit,
            owner,
            units.share_bounds(owner.topic, owner.type, path) or type_bounds(found.type),
            found.parent,
            units.turn_of(owner.topic, owner.type, path),
            ((owner.topic, path),) if unit is None else (),
        )


def _has_offset(value: Value) -> bool:
    """Return whether a value is on a scale with a zero of its own, as degrees Celsius."""
    return value.unit is not None and value.unit.offset != 0
