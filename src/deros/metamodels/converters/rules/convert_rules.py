"""From the textX objects of a DeRoS program to :class:`~deros.models.rules.Rules`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, Literal, cast

from deros import codes
from deros.diagnostics import SourceFile, Span
from deros.interfaces.fields import FieldPath
from deros.metamodels.converters.convert import Sections, unknown
from deros.metamodels.converters.rules.convert_terms import TermConverter
from deros.metamodels.converters.rules.convert_zones import convert_mounting, convert_zone
from deros.metamodels.languages import ROSSYSTEM
from deros.metamodels.reading import MAX_DEPTH, too_deep
from deros.metamodels.scoping import FileIndex
from deros.models.bindings import Binding, ServiceCall
from deros.models.rules import (
    Action,
    ActionCall,
    And,
    Begins,
    Behaviour,
    Comparison,
    ComparisonOperator,
    Condition,
    Constant,
    Entity,
    For,
    Gate,
    GateLimit,
    GateLine,
    GateSource,
    GateStop,
    Input,
    Membership,
    Not,
    Once,
    Or,
    Rule,
    Rules,
    Since,
    StopField,
    StopKind,
    Times,
    Truth,
    TunableIn,
    UnitDefinition,
    Use,
)

if TYPE_CHECKING:
    from deros.metamodels.load import Loading
    from deros.metamodels.scoping import Reference
    from deros.models.system import System

_OPTIONS = {
    "NoReturn": "no_return",
    "AnyPublishers": "publishers",
    "OnSecondPublisher": "on_second_publisher",
    "Mounted": "mounted",
    "Timeout": "timeout",
}
_ATTRIBUTES = {
    "Binding": "publishes",
    "ServiceCall": "calls",
    "ResetBy": "reset_by",
    "Latched": "latched",
    "Description": "description",
}


def load_rules(loading: Loading) -> Rules:
    """Load safety rules; each ``use`` statement has an index of what its file defines."""
    indexes: dict[int, FileIndex] = {}

    def follow_uses(model: Any) -> None:
        for statement in model.statements:
            if type(statement).__name__ == "Use":
                index = indexes[statement._tx_position] = FileIndex()
                loading.follow(statement, index, (ROSSYSTEM,))

    model = loading.parse(follow_uses)
    converter = RulesConverter(loading.source, indexes)
    result = converter.rules(model)
    loading.diagnostics += converter.diagnostics
    return result


class RulesConverter(TermConverter):
    """Converts one DeRoS program; each ``use`` statement has its own index."""

    def __init__(self, source: SourceFile, indexes: Mapping[int, FileIndex]) -> None:
        """Store the indexes by the position of their ``use`` statement."""
        super().__init__(source)
        self._indexes = indexes

    def rules(self, model: Any) -> Rules:
        """Return the rules of the file."""
        groups: dict[str, list[Any]] = {}
        convert = {
            "Use": self._use,
            "UnitDefinition": self._unit,
            "Action": self._action,
            "Constant": self._constant,
            "Input": self._input,
            "Zone": lambda found: convert_zone(self, found),
            "Entity": self._entity,
            "Behaviour": self._behaviour,
            "Gate": self._gate,
        }
        statements = [self._named_behaviour(each) for each in model.statements]
        self.declare(statements)
        for statement in statements:
            kind = type(statement).__name__
            groups.setdefault(kind, []).append(convert[kind](statement))
        return Rules(
            name=PurePath(self.source.path).stem,
            source=self.source,
            uses=tuple(groups.get("Use", ())),
            units=tuple(groups.get("UnitDefinition", ())),
            actions=tuple(groups.get("Action", ())),
            constants=tuple(groups.get("Constant", ())),
            inputs=tuple(groups.get("Input", ())),
            zones=tuple(groups.get("Zone", ())),
            entities=tuple(groups.get("Entity", ())),
            behaviours=tuple(groups.get("Behaviour", ())),
            gates=tuple(groups.get("Gate", ())),
        )

    # Declarations -----------------------------------------------------------------------------

    def _use(self, found: Any) -> Use:
        index = self._indexes[found._tx_position]
        reference: Reference[System] = found.system
        system = next(iter(index.systems.get(reference.name, ())), None)
        span = self.token_span(reference.name)
        if system is None and index.complete:
            self.report(
                codes.UNKNOWN_USED_SYSTEM,
                *unknown(reference.name, "system", index.systems, span),
            )
        return Use(
            str(found.path[1:-1]),
            self.name(reference.name),
            system,
            self.span(found),
            self.token_span(found.path),
        )

    def _unit(self, found: Any) -> UnitDefinition:
        return UnitDefinition(self.name(found.name), self._number(found.factor), self.span(found))

    def _constant(self, found: Any) -> Constant:
        value, tunable = self._term(found.value), None
        if found.tunable is not None:
            tunable = self._tunable(found.tunable)
        return Constant(self.name(found.name), value, self.span(found), tunable)

    def _tunable(self, found: Any) -> TunableIn:
        interval, text = found.interval, found.description
        return TunableIn(
            self._term(interval.lower),
            self._term(interval.upper),
            interval.opening == "[" and interval.closing == "]",
            self.span(found),
            self.span(interval),
            self.unit(found.unit),
            None if found.unit is None else self.token_span(found.unit),
            "" if text is None else self.text(text),
        )

    def _input(self, found: Any) -> Input:
        term = self._topic_path(found.term)
        if found.term.calls:
            message = "an input names a field; a function is applied where the input is used"
            self.report(codes.SYNTAX_ERROR, message, self.span(found.term.calls[0]))
        settings: dict[str, Any] = {}
        options = Sections(self)
        for option in found.options:
            what = type(option).__name__
            if not options.once(_OPTIONS[what], self.span(option)):
                continue
            if what == "Timeout":
                settings["timeout"] = self._number(option.duration)
            elif what == "NoReturn":
                settings["no_return"] = self._number(option.value)
            elif what == "OnSecondPublisher":
                settings["needs_one_publisher"] = True
            elif what == "Mounted":
                settings["mounting"] = convert_mounting(self, option, self._number)
            else:
                settings["any_publishers"] = True
        return Input(
            self.name(found.name),
            term,
            self.span(found),
            description=self.text(found.description),
            unit=self.unit(found.unit),
            unit_span=None if found.unit is None else self.token_span(found.unit),
            **settings,
        )

    def _action(self, found: Any) -> Action:
        settings: dict[str, Any] = {}
        attributes = Sections(self)
        for attribute in found.attributes:
            what = _ATTRIBUTES[type(attribute).__name__]
            if not attributes.once(what, self.span(attribute)):
                continue
            if what == "publishes":
                settings["binding"] = Binding(
                    self._term(attribute.value),
                    self.name(attribute.topic),
                    self.interface(attribute.type, "msg"),
                    self.token_span(attribute.type),
                    self.span(attribute),
                )
            elif what == "calls":
                settings["service"] = ServiceCall(
                    None if attribute.value is None else self._term(attribute.value),
                    self.name(attribute.service),
                    self.interface(attribute.type, "srv"),
                    self.token_span(attribute.type),
                    self.span(attribute),
                )
            elif what == "reset_by":
                settings["reset_by"] = self.name(attribute.action)
            elif what == "latched":
                settings["latched"] = True
            else:
                settings["description"] = self.text(attribute.text)
        parameters = tuple(self.name(each.name) for each in found.parameters)
        return Action(self.name(found.name), parameters, self.span(found), **settings)

    def _entity(self, found: Any) -> Entity:
        rules = tuple(
            Rule(
                self.name(rule.name),
                self._condition(rule.condition),
                self.span(rule),
                self.text(rule.description),
                bool(rule.failsafe),
            )
            for rule in found.rules
        )
        return Entity(self.name(found.name), rules, self.span(found), self.text(found.description))

    def _behaviour(self, found: Any) -> Behaviour:
        body = tuple(
            self._behaviour(item)
            if type(item).__name__ == "Behaviour"
            else ActionCall(self.name(item.action), self._terms(item.arguments), self.span(item))
            for item in found.body
        )
        name = None if found.name is None else self.name(found.name)
        return Behaviour(
            self._condition(found.condition), body, self.span(found), name, bool(found.optional)
        )

    def _named_behaviour(self, statement: Any) -> Any:
        """Return the statement; report ``optional`` before a behaviour that has no name."""
        if type(statement).__name__ != "NamelessOptional":
            return statement
        message = "an optional behaviour needs a name, by which it is switched off"
        hint = "write 'optional behaviour NAME: if …'"
        start: int = statement._tx_position
        span = Span(self.source, start, start + len("optional"))
        self.report(codes.SYNTAX_ERROR, message, span, hint)
        return statement.behaviour

    # Gates ------------------------------------------------------------------------------------

    def _gate(self, found: Any) -> Gate:
        resumes = [self.span(each) for each in found.resumes]
        if not found.lines:
            message = "a gate needs a line that states when it holds commands back"
            hint = "write for instance 'lost heartbeat for 0.3 sec: zero until reset;'"
            self.report(codes.SYNTAX_ERROR, message, resumes[0], hint)
        return Gate(
            tuple(map(self._gate_source, found.sources)),
            self.name(found.target),
            self.interface(found.type, "msg"),
            self._number(found.rate),
            tuple(map(self._gate_line, found.lines)),
            self.span(found),
            self.token_span(found.type),
            self.text(found.description),
            resumes[0] if resumes else None,
        )

    def _gate_source(self, found: Any) -> GateSource:
        duration = None if found.duration is None else self._number(found.duration)
        return GateSource(self.name(found.topic), duration, found.start is not None)

    def _gate_line(self, found: Any) -> GateLine:
        loss = found.loss
        return GateLine(
            None if found.action is None else self.name(found.action),
            None if loss is None else cast(Literal["heartbeat", "input"], str(loss.what)),
            None if loss is None or loss.duration is None else self._number(loss.duration),
            tuple(map(self._gate_limit, found.limits)),
            self.span(found),
            found.until is not None,
            None if found.stop is None else self._gate_stop(found.stop),
            None if found.wait is None else self._number(found.wait.duration),
        )

    def _gate_stop(self, found: Any) -> GateStop:
        return GateStop(
            cast(StopKind, str(found.keyword)),
            self.span(found),
            tuple(map(self._stop_field, getattr(found, "ramps", ()))),
            tuple(map(self._stop_field, getattr(found, "fields", ()))),
        )

    def _stop_field(self, found: Any) -> StopField:
        path, span = self._gate_path(found)
        value = None if found.value is None else self._term(found.value)
        return StopField(path, value, self.span(found), span)

    def _gate_path(self, found: Any) -> tuple[FieldPath, Span]:
        """Return the path of a field of the command, and its place."""
        field = self.name(found.field)
        steps, span = self._path(field, found)
        return (field.text, *steps), span

    def _gate_limit(self, found: Any) -> GateLimit:
        path, span = self._gate_path(found)
        interval = found.interval
        return GateLimit(
            path,
            self._term(interval.lower),
            self._term(interval.upper),
            interval.opening == "[",
            interval.closing == "]",
            self.span(found),
            span,
            self.span(interval),
            self.unit(found.unit),
            None if found.unit is None else self.token_span(found.unit),
        )

    # Conditions -------------------------------------------------------------------------------

    def _condition(self, found: Any) -> Condition:
        operand = self._disjunction(found.operand)
        if found.within is not None:
            self._refuse_not(found.operand, found, "within")
            return self._within(operand, found, self.span(found))
        if found.cause is not None:
            return Since(operand, self._disjunction(found.cause), self.span(found))
        if found.duration is None:
            return operand
        return For(operand, self._number(found.duration), self.span(found))

    def _disjunction(self, found: Any) -> Condition:
        operands = tuple(map(self._conjunction, found.operands))
        return operands[0] if len(operands) == 1 else Or(operands, self.span(found))

    def _conjunction(self, found: Any) -> Condition:
        operands = tuple(map(self._negation, found.operands))
        return operands[0] if len(operands) == 1 else And(operands, self.span(found))

    def _negation(self, found: Any) -> Condition:
        condition = self._predicate(found.operand)
        if found.begins is not None:
            condition = self._begins(condition, found)
        if len(found.nots) > MAX_DEPTH:
            self.diagnostics.append(too_deep(self.span(found)))
            return condition
        for keyword in reversed(found.nots):
            span = Span(self.source, keyword.start, found._tx_position_end)
            condition = Not(condition, span)
        return condition

    def _begins(self, operand: Condition, found: Any) -> Condition:
        start, end = found.operand._tx_position, found._tx_position_end
        span = Span(self.source, start, end)
        if found.nots:
            self._ambiguous(found, found.operand, "begins")
        if found.begins.within is None:
            return Begins(operand, span)
        counted = found.begins.count is not None  # what turns true is counted, so that it begins
        return self._within(operand if counted else Begins(operand, span), found.begins, span)

    def _within(self, operand: Condition, found: Any, span: Span) -> Once | Times:
        within = self._number(found.within)
        if found.count is None:
            return Once(operand, within, span)
        return Times(operand, self._number(found.count), within, span)

    def _refuse_not(self, operand: Any, whole: Any, word: str) -> None:
        """Report a ``not`` without parentheses before a word that closes a condition."""
        for conjunction in operand.operands:
            for negation in conjunction.operands:
                if negation.nots:
                    self._ambiguous(whole, negation.operand, word)
                    return

    def _ambiguous(self, whole: Any, negated: Any, word: str) -> None:
        """Report a condition whose ``not`` people read in two ways."""
        span = self.span(whole)
        written = " ".join(self.span(negated).text.split())
        if type(negated).__name__ == "Parenthesis":
            written = written[1:-1].strip()
        rest = " ".join(self.source.text[self.span(negated).end : span.end].split())
        self.report(
            codes.AMBIGUOUS_NOT,
            f"people read 'not' before '{word}' in two ways",
            span,
            f"write 'not ({written} {rest})' or '(not {written}) {rest}'",
        )

    def _predicate(self, found: Any) -> Condition:
        if type(found).__name__ == "Parenthesis":
            return self._condition(found.condition)
        left = self._term(found.left)
        span = self.span(found)
        if found.interval is None and found.operator is None:
            return Truth(left, left.span)
        if found.interval is not None:
            interval = found.interval
            return Membership(
                left,
                found.negated,
                self._term(interval.lower),
                self._term(interval.upper),
                interval.opening == "[",
                interval.closing == "]",
                span,
                self.span(interval),
            )
        operator = "=" if found.operator == "==" else str(found.operator)
        return Comparison(left, cast(ComparisonOperator, operator), self._term(found.right), span)
