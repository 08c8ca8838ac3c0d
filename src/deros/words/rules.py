"""The words of safety rules: those that the grammar tells, and those that the compiler resolved."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeVar

from deros.diagnostics import Span
from deros.interfaces.fields import FieldError, FieldPath, format_path, resolve
from deros.interfaces.store import InterfaceStore
from deros.models import rules
from deros.models.common import Name
from deros.names.graph_names import resolve_name
from deros.rules.compiler.build import BuildResult
from deros.rules.compiler.scope.mentions import FieldMention, Mention, part_span
from deros.rules.functions.functions import WRITTEN
from deros.words.nodes import type_word
from deros.words.systems import file_word, system_word, topic_word
from deros.words.words import Word, WordKind

_Named = rules.Constant | rules.Zone | rules.Action | rules.Entity
_Declared = TypeVar(
    "_Declared", rules.Input, rules.Constant, rules.Action, rules.UnitDefinition, rules.Zone
)


def words_of_rules(
    program: rules.Rules, built: BuildResult, store: InterfaceStore
) -> Iterator[Word]:
    """Yield the words of safety rules.

    Args:
        program: the rules as written.
        built: what the compiler made of them, also where they have errors.
        store: the definitions of messages.
    """
    return _Rules(program, built, store).words()


class _Rules:
    """Collects the words of one file of rules."""

    def __init__(self, program: rules.Rules, built: BuildResult, store: InterfaceStore) -> None:
        self._program = program
        self._built = built
        self._store = store
        self._inputs = _first(program.inputs)
        self._constants = _first(program.constants)
        self._zones = _first(program.zones)
        self._actions = _first(program.actions)
        self._units = _first(program.units)
        self._rules = {
            f"{entity.name}.{rule.name}": (entity, rule)
            for entity in reversed(program.entities)
            for rule in reversed(entity.rules)
        }

    def words(self) -> Iterator[Word]:
        yield from self._declarations()
        for behaviour in self._program.behaviours:
            yield from self._behaviour(behaviour)
        for gate in self._program.gates:
            yield from self._gate(gate)
        for mention in self._built.mentions:
            if isinstance(mention, Mention):
                yield from self._mentioned(mention)
            else:
                yield from self._fields(mention)

    # Declarations -----------------------------------------------------------------------------

    def _declarations(self) -> Iterator[Word]:
        program = self._program
        for use in program.uses:
            if use.system is not None:
                yield system_word(use.system_name.span, use.system)
                yield file_word(use.path_span, (use.system.source.path,))
        for unit in program.units:
            yield from self._unit(unit.name.text, unit.name.span)
            yield from self._numbers(unit.factor)
        for constant in program.constants:
            yield self._constant(constant.name.span, constant)
            yield from self._term(constant.value)
            if constant.tunable is not None:
                yield from self._term(constant.tunable.lower)
                yield from self._term(constant.tunable.upper)
                yield from self._unit(constant.tunable.unit, constant.tunable.unit_span)
        for each in program.inputs:
            yield self._input(each.name.span, each)
            yield self._topic(each.term.topic)
            yield from self._unit(each.unit, each.unit_span)
            yield from self._numbers(each.timeout)
        for zone in program.zones:
            yield self._zone(zone.name.span, zone)
            yield from self._unit(zone.unit, zone.unit_span)
        for entity in program.entities:
            yield _word(entity.name.span, WordKind.ENTITY, entity, entity.description)
            for rule in entity.rules:
                yield self._rule(rule.name.span, f"{entity.name}.{rule.name}")
                yield from self._condition(rule.condition)
        for action in program.actions:
            yield from self._declared_action(action)

    def _declared_action(self, action: rules.Action) -> Iterator[Word]:
        yield self._action(action.name.span, action)
        if action.binding is not None:
            yield self._topic(action.binding.topic)
            yield type_word(action.binding.type_span, action.binding.type)
            yield from self._term(action.binding.value)
        if action.service is not None:
            yield type_word(action.service.type_span, action.service.type)
        if action.reset_by is not None:
            yield from self._named_action(action.reset_by)

    def _behaviour(self, behaviour: rules.Behaviour) -> Iterator[Word]:
        if behaviour.name is not None:
            yield Word(
                behaviour.name.span,
                WordKind.BEHAVIOUR,
                behaviour.name.text,
                behaviour.name.span,
                meaning=behaviour,
            )
        yield from self._condition(behaviour.condition)
        for item in behaviour.body:
            if isinstance(item, rules.Behaviour):
                yield from self._behaviour(item)
            else:
                yield from self._named_action(item.action)
                for argument in item.arguments:
                    yield from self._term(argument)

    def _gate(self, gate: rules.Gate) -> Iterator[Word]:
        for source in gate.sources:
            yield self._topic(source.topic)
            yield from self._numbers(source.duration)
        yield self._topic(gate.target)
        yield type_word(gate.type_span, gate.type)
        yield from self._numbers(gate.rate)
        for line in gate.lines:
            if line.action is not None:
                yield from self._named_action(line.action)
            yield from self._numbers(line.duration)
            yield from self._numbers(line.wait)
            for limit in line.limits:
                yield from self._term(limit.lower)
                yield from self._term(limit.upper)
                yield from self._unit(limit.unit, limit.unit_span)
            stop = line.stop
            for part in (*stop.ramps, *stop.sent) if stop is not None else ():
                if part.value is not None:
                    yield from self._term(part.value)

    # Terms --------------------------------------------------------------------------------------

    def _condition(self, condition: rules.Condition) -> Iterator[Word]:
        match condition:
            case rules.Comparison():
                yield from self._term(condition.left)
                yield from self._term(condition.right)
            case rules.Membership():
                for term in (condition.operand, condition.lower, condition.upper):
                    yield from self._term(term)
            case rules.Truth():
                yield from self._term(condition.operand)
            case rules.For() | rules.Once() | rules.Times():
                yield from self._numbers(condition.duration)
        for operand in rules.operands(condition):
            yield from self._condition(operand)

    def _term(self, term: rules.Term) -> Iterator[Word]:
        match term:
            case rules.Number():
                yield from self._numbers(term)
            case rules.TopicPath():
                yield self._topic(term.topic)
            case rules.Call():
                row = WRITTEN.get(term.function.text)
                if row is not None:
                    yield Word(
                        term.function.span,
                        WordKind.FUNCTION,
                        row.name,
                        unit=row.unit,
                        description=row.gives,
                        meaning=row,
                    )
                if term.receiver is not None:
                    yield from self._term(term.receiver)
                for part in term.arguments:
                    yield from self._term(part)
            case rules.Negative():
                yield from self._term(term.operand)
            case rules.Arithmetic():
                yield from self._term(term.left)
                yield from self._term(term.right)
            case rules.Entries():
                yield from self._condition(term.condition)

    def _numbers(self, number: rules.Number | None) -> Iterator[Word]:
        if number is not None:
            yield from self._unit(number.unit, number.unit_span)

    def _unit(self, unit: str | None, span: Span | None) -> Iterator[Word]:
        if unit is None or span is None:
            return
        own = self._units.get(unit)
        place = None if own is None else own.name.span
        yield Word(span, WordKind.UNIT, unit, place, meaning=own)

    def _topic(self, name: Name) -> Word:
        full = resolve_name(name.text, "/")
        return topic_word(name.span, full, self._built.topics.get(full))

    # What the compiler resolved -------------------------------------------------------------------

    def _mentioned(self, mention: Mention) -> Iterator[Word]:
        match mention.kind:
            case "input":
                yield self._input(mention.span, self._inputs[mention.name])
            case "constant":
                yield self._constant(mention.span, self._constants[mention.name])
            case "zone":
                yield self._zone(mention.span, self._zones[mention.name])
            case "action":
                yield self._action(mention.span, self._actions[mention.name])
            case "rule":
                yield from self._rule_reference(mention)
            case "message constant":
                yield Word(mention.span, WordKind.MESSAGE_CONSTANT, mention.name)

    def _rule_reference(self, mention: Mention) -> Iterator[Word]:
        """Yield the words of ``entity.rule``, or of the rule's name alone."""
        entity, rule = self._rules[mention.name]
        text, start = mention.span.text, mention.span.start
        source, end = mention.span.source, mention.span.end
        last = Span(source, end - len(rule.name.text), end)
        yield self._rule(last, mention.name)
        if text != rule.name.text and text.startswith(entity.name.text):
            first = Span(source, start, start + len(entity.name.text))
            yield _word(first, WordKind.ENTITY, entity, entity.description)

    def _fields(self, mention: FieldMention) -> Iterator[Word]:
        """Yield each field of a path that is there."""
        inherited = len(mention.path) - mention.written
        for position in range(mention.written):
            path = mention.path[: inherited + position + 1]
            found = resolve(self._store, mention.type, path)
            if isinstance(found, FieldError):
                return
            span = part_span(mention.before, mention.span, position)
            if span == mention.span and mention.before.end != mention.span.start:
                return  # comments stand between the parts
            yield Word(
                span,
                WordKind.FIELD,
                f"{mention.type.short}.{format_path(path)}",
                type=str(found.type),
                unit=self._unit_of(mention, path),
                meaning=(mention.type, tuple(path)),
            )

    def _unit_of(self, mention: FieldMention, path: FieldPath) -> str:
        """Return the unit of a field, as the systems or the rules declare it, or as usual."""
        unit = self._built.units.unit_of(mention.topic, mention.type, path)
        return "" if unit is None else str(unit)

    # Words of declared things ---------------------------------------------------------------------

    def _input(self, span: Span, each: rules.Input) -> Word:
        kind, unit = "", each.unit or ""
        topic = resolve_name(each.term.topic.text, "/")
        known = self._built.topics.get(topic)
        if known is not None and known.type is not None:
            found = resolve(self._store, known.type, each.term.path)
            kind = "" if isinstance(found, FieldError) else str(found.type)
            usual = self._built.units.unit_of(topic, known.type, each.term.path)
            unit = unit or ("" if usual is None else str(usual))
        return Word(
            span, WordKind.INPUT, each.name.text, each.name.span, kind, unit, each.description, each
        )

    def _constant(self, span: Span, each: rules.Constant) -> Word:
        description = each.tunable.description if each.tunable is not None else ""
        return _word(span, WordKind.CONSTANT, each, description)

    def _zone(self, span: Span, each: rules.Zone) -> Word:
        return _word(span, WordKind.ZONE, each, each.description)

    def _action(self, span: Span, each: rules.Action) -> Word:
        return _word(span, WordKind.ACTION, each, each.description)

    def _named_action(self, name: Name) -> Iterator[Word]:
        if name.text in self._actions:
            yield self._action(name.span, self._actions[name.text])

    def _rule(self, span: Span, name: str) -> Word:
        rule = self._rules[name][1]
        return Word(
            span,
            WordKind.RULE,
            name,
            rule.name.span,
            "bool",
            description=rule.description,
            meaning=rule,
        )


def _word(span: Span, kind: WordKind, each: _Named, description: str) -> Word:
    """Return the word for what is declared by a name of its own, without a type."""
    name = each.name
    return Word(span, kind, name.text, name.span, description=description, meaning=each)


def _first(declared: tuple[_Declared, ...]) -> dict[str, _Declared]:
    """Return what is declared, by name; of several, the first counts."""
    return {each.name.text: each for each in reversed(declared)}
