"""The names of a DeRoS program: units, constants, inputs and the topics of the used systems.

A scope also numbers the inputs and leaves that the program reads.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterable, Iterator
from fractions import Fraction

from deros import codes
from deros.diagnostics import Code, Diagnostic, Fix, Related, Span, report
from deros.interfaces.durations import whole_nanoseconds, with_unit_of_time
from deros.interfaces.fields import FieldError, FieldPath, Key, ResolvedField, format_steps, resolve
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceKind, InterfaceType, MessageDefinition
from deros.interfaces.units import Unit, UnitRegistry
from deros.models import rules
from deros.models.common import Name
from deros.names.graph_names import resolve_name
from deros.names.names import check_identifier, check_topic_name, did_you_mean, near
from deros.names.topic_likeness import likely_topics
from deros.rules.compiler.scope.field_units import FieldUnits
from deros.rules.compiler.scope.mentions import FieldMention, Mention, part_span
from deros.rules.compiler.scope.own_units import redefined
from deros.rules.compiler.scope.resolved import DeclaredInput, Quantity
from deros.rules.compiler.scope.scanners import declare_scanner
from deros.rules.compiler.scope.topics import SystemTopics
from deros.rules.program import ir
from deros.rules.program.bounds import rounded

_HEADER = InterfaceType("std_msgs", "msg", "Header")
_WORD = re.compile(r"\w+")
MOST_TIMES = 20
"""So many turns of a condition can be counted: a monitor of fixed size remembers each."""

_KEYWORDS = frozenset({"and", "or", "not", "in", "for", "then", "if", "true", "false"})
"""The words that no term begins with; the grammar's ``TermName`` has them too."""


class Scope:
    """The symbol table of one program; every fault that it finds is in ``diagnostics``."""

    def __init__(self, program: rules.Rules, store: InterfaceStore) -> None:
        """Read the declarations that terms refer to."""
        self.store = store
        self.diagnostics: list[Diagnostic] = []
        self.mentions: list[Mention | FieldMention] = []
        self.leaves: list[ir.Leaf] = []
        self.used_inputs: list[DeclaredInput] = []
        self.tunables: list[ir.TunableConstant] = []
        self._leaf_of: dict[tuple[int, FieldPath], int] = {}
        self._anonymous: dict[tuple[str, FieldPath], DeclaredInput | None] = {}
        # A system that could not be loaded has been reported by the loader; what it would have told
        # is then not missing here.
        self.systems_known = all(
            use.system is not None for use in program.uses
        ) and not program.source.mentions_lost("use")
        self.nesting = 0  # of the present term, in other terms and in constants
        self.untold = False  # whether a name means nothing, and it is the loader that has said why
        self._uses = program.uses
        systems = [use.system for use in program.uses if use.system]
        self.topics = SystemTopics(systems, self.systems_known)
        self.units = self._read_units(program)
        self.field_units = FieldUnits(store, self.topics, self.units)
        constants = [each.name for each in program.constants]
        inputs = [each.name for each in program.inputs]
        self.check_duplicates([*constants, *inputs], "constant or input '{}'")
        self.constants: dict[str, rules.Constant] = {}
        for constant in program.constants:
            self.constants.setdefault(constant.name.text, constant)
        self.inputs: dict[str, DeclaredInput | None] = {}
        for each in program.inputs:
            self.inputs.setdefault(each.name.text, self._declare(each))

    # Faults -------------------------------------------------------------------------------------

    def fault(
        self,
        code: Code,
        message: str,
        span: Span,
        hint: str = "",
        related: tuple[Related, ...] = (),
        fix: Fix | None = None,
        subjects: tuple[str, ...] = (),
    ) -> None:
        """Add a finding."""
        self.diagnostics.append(report(code, message, span, hint, related, fix, subjects))

    def check_duplicates(self, names: Iterable[Name], what: str, hint: str = "") -> None:
        """Report every name that is declared twice; ``what`` has ``{}`` for the name."""
        first: dict[str, Name] = {}
        for name in names:
            earlier = first.setdefault(name.text, name)
            if earlier is not name:
                self.fault(
                    codes.DUPLICATE_RULE_NAME,
                    f"{what.format(name)} is declared twice",
                    name.span,
                    hint,
                    related=(Related(earlier.span, "first declared here"),),
                )

    def check_names(self, names: Iterable[Name]) -> None:
        """Report every name that is not an identifier in all languages of generated code."""
        for name in names:
            fault = check_identifier(name.text)
            if fault is not None:
                message = f"the name '{name}' {fault}"
                self.fault(codes.INVALID_RULES_NAME, message, name.span)

    def check_readable(self, names: Iterable[Name]) -> None:
        """Report every name that no condition can read, because it is a keyword there."""
        for name in names:
            if name.text in _KEYWORDS:
                message = f"'{name}' is a keyword of conditions: none can read what is called so"
                hint = f"call it '{name}_' or the like"
                self.fault(codes.INVALID_RULES_NAME, message, name.span, hint)

    # Units and durations ------------------------------------------------------------------------

    def _read_units(self, program: rules.Rules) -> UnitRegistry:
        definitions = program.units
        self.check_duplicates((each.name for each in definitions), "unit '{}'")
        registry = UnitRegistry(program.own_units)
        self.diagnostics += redefined(definitions, registry)
        defined = {each.name.text for each in definitions}
        for each in definitions:
            if registry.parse(each.name.text) is not None:
                continue
            unit = each.factor.unit
            if each.factor.value <= 0:
                message = f"unit '{each.name}' must be a positive multiple"
            elif unit and registry.parse(unit) is None and defined.isdisjoint(_WORD.findall(unit)):
                self._unknown_unit(registry, unit, each.factor.unit_span or each.factor.span)
                continue
            else:
                message = f"unit '{each.name}' is defined by itself or by an unknown unit"
            self.fault(codes.UNKNOWN_UNIT, message, each.factor.span)
        return registry

    def unit(self, text: str, span: Span) -> Unit | None:
        """Return the unit that ``text`` means; report an unknown one."""
        found = self.units.parse(text)
        if found is None:
            self._unknown_unit(self.units, text, span)
        return found

    def _unknown_unit(self, registry: UnitRegistry, text: str, span: Span) -> None:
        meant = registry.suggest(text)
        hint = did_you_mean(meant) or (
            f"'unit {text} = ...' in the rules defines it" if text.isidentifier() else ""
        )
        self.fault(codes.UNKNOWN_UNIT, f"unknown unit '{text}'", span, hint)

    def duration_ns(self, number: rules.Number) -> int | None:
        """Return a duration in nanoseconds; report a term that is not a duration."""
        if number.unit is None:
            message = f"the duration '{number.value}' has no unit"
            hint = with_unit_of_time(number.span.text)
            self.fault(codes.BAD_DURATION, message, number.span, hint)
            return None
        unit = self.unit(number.unit, number.unit_span or number.span)
        if unit is None:
            return None
        if unit.exponents != (("s", Fraction(1)),):
            message = f"a duration is needed, '{number.unit}' is a unit of {unit.dimension}"
            self.fault(codes.INCOMPATIBLE_UNITS, message, number.unit_span or number.span)
            return None
        return self.nanoseconds(Fraction(number.value) * unit.factor, number.span)

    def count(self, number: rules.Number) -> int | None:
        """Return how many times something has to turn true; report a count that is not in range."""
        if number.unit is not None or not 2 <= number.value <= MOST_TIMES or number.value % 1:
            written = f"{number.value} {number.unit or ''}".strip()
            message = f"'{written}' is not a whole number of times, from 2 to {MOST_TIMES}"
            hint = "write 'begins within T' for once" if number.value == 1 else ""
            self.fault(codes.BAD_COUNT, message, number.span, hint)
            return None
        return int(number.value)

    def nanoseconds(self, seconds: Fraction, span: Span) -> int | None:
        """Return seconds as whole nanoseconds; report a value that does not fit 64 bits."""
        try:
            return whole_nanoseconds(seconds)
        except ValueError as error:
            self.fault(codes.BAD_DURATION, f"the duration '{span.text}' {error}", span)
            return None

    # Topics and inputs --------------------------------------------------------------------------

    def _declare(self, each: rules.Input) -> DeclaredInput | None:
        timeout_ns = self.duration_ns(each.timeout) if each.timeout else None
        if timeout_ns == 0 and each.timeout:
            self.fault(
                codes.BAD_DURATION,
                "a timeout of 0 makes the input missing always",
                each.timeout.span,
            )
        declared = self._input(each.name.text, each.term, timeout_ns, each.span)
        if declared is not None:
            self._declare_unit(each, declared)
            self.diagnostics += declare_scanner(self, each, declared)
            declared.needs_one_publisher = each.needs_one_publisher
        return None if each.timeout and not timeout_ns else declared

    def _declare_unit(self, each: rules.Input, declared: DeclaredInput) -> None:
        if each.unit is None or each.unit_span is None:
            return
        unit = self.unit(each.unit, each.unit_span)
        if unit is None:
            return
        found = resolve(self.store, declared.type, declared.path)
        kind = None if isinstance(found, FieldError) or not declared.path else found.type
        if kind is None or not kind.element.is_number:
            message = f"a unit is that of a number, '{each.term.span.text}' is not one"
            hint = "name the field: 'topic TOPIC.FIELD [UNIT]'"
            self.fault(codes.FIELD_NOT_NUMERIC, message, each.unit_span, hint)
            return
        self.diagnostics += self.field_units.declare(
            declared.topic, declared.type, declared.path, unit, each.unit_span
        )

    def anonymous(self, term: rules.TopicPath) -> DeclaredInput | None:
        """Return the input that a topic term in a rule stands for: one for all equal terms."""
        key = (term.topic.text, term.path)
        if key not in self._anonymous:
            name = term.topic.text + format_steps(term.path)
            self._anonymous[key] = self._input(name, term, None, term.span)
        return self._anonymous[key]

    def _input(
        self, name: str, term: rules.TopicPath, timeout_ns: int | None, span: Span
    ) -> DeclaredInput | None:
        topic = self.topic_name(term.topic)
        if topic is None:
            return None
        kind = self.topic_type(term.topic, topic)
        if kind is None:
            return None
        found = self.field(kind, term.path, term.topic.span, term.span, len(term.path), topic)
        if found is None:
            return None
        return DeclaredInput(name, topic, kind, term.path, timeout_ns, span)

    def topic_name(self, name: Name, what: str = "topic") -> str | None:
        """Return the full name of a topic or service in the rules; report one ROS 2 rejects."""
        refused = check_topic_name(name.text)
        hint = ""
        if refused is None and name.text.startswith("~"):
            refused = f"is private: rules name the {what}s of other nodes"
            hint = "write its full name, which begins with '/'"
        if refused is None:
            return resolve_name(name.text, "/")
        self.fault(codes.INVALID_RULES_NAME, f"the {what} '{name}' {refused}", name.span, hint)
        return None

    def topic_type(self, name: Name, topic: str) -> InterfaceType | None:
        """Return the type of a topic of the used systems; report a missing topic."""
        known = self.topics.get(topic)
        if known is None:
            if not self.topics.are_all:  # it may be in what could not be loaded, and is reported
                self.untold = True
            else:
                names = self.topics.names
                within = [each for each in names if topic.startswith(f"{each}/")]
                hint = did_you_mean(likely_topics(topic, names) or within, name.text, topic)
                if (
                    within
                ):  # the rest is a field, which goes behind a '.': no edit of the name alone
                    hint = str(hint)
                message = f"no used system has a topic '{topic}'"
                if not self._uses:
                    hint = "'use \"FILE.system\" import NAME' names the system that has it"
                meant = tuple(within)
                self.fault(codes.RULE_TOPIC_NOT_IN_SYSTEM, message, name.span, hint, subjects=meant)
            return None
        kind = known.type
        if kind is None:
            if not self.topics.complete:  # what could not be loaded, and is reported, may tell it
                self.untold = True
                return None
            self.fault(
                codes.RULE_TYPE_UNKNOWN,
                f"the system does not tell the type of '{topic}'",
                name.span,
                f"pin it in the system: 'topic {topic} : PACKAGE.TYPE'",
                (Related(known.place, "the topic"),),
            )
        elif len(known.types) > 1:
            self.fault(
                codes.TYPE_MISMATCH,
                f"the used systems give '{topic}' different types: "
                + ", ".join(each.short for each in known.types),
                name.span,
                "rename the topic in one of the systems, or make their types agree",
                tuple(Related(place, each.short) for each, place in known.types.items()),
            )
            return None
        elif (problem := self.store.problem(kind)) is not None:
            place, said = (Related(known.place, "the topic"),), (kind.short,)
            text = problem.about(kind)
            self.fault(codes.UNUSABLE_DEFINITION, text, name.span, related=place, subjects=said)
            return None
        elif self.store.message(kind) is None:
            self.fault(
                codes.RULE_TYPE_UNKNOWN,
                f"'{topic}' is of type {kind.short}, whose definition is not found",
                name.span,
                "name the folder that has it with --interfaces PATH",
                (Related(known.place, "the topic"),),
                subjects=(kind.short,),
            )
            return None
        elif (part := self.store.unknown_part(kind)) is not None:
            self.fault(
                codes.UNUSABLE_DEFINITION,
                f"the definition of {kind.short} cannot be used: it contains {part.short}, which is"
                " not known",
                name.span,
                "name the folder that has it with --interfaces PATH",
                (Related(known.place, "the topic"),),
                subjects=(kind.short,),
            )
            return None
        return kind

    def message_type(self, kind: InterfaceType, span: Span) -> MessageDefinition | None:
        """Return the definition of a message type that the rules name; report an unknown one."""
        definition = self.store.message(kind)
        if definition is None:
            self._report_type(kind, span, "message", "msg")
        return definition

    def service_type(
        self, kind: InterfaceType, span: Span
    ) -> tuple[MessageDefinition, MessageDefinition] | None:
        """Return request and response of a service type; report an unknown one."""
        definitions = self.store.service(kind)
        if definitions is None:
            self._report_type(kind, span, "service", "srv")
        return definitions

    def _report_type(
        self, kind: InterfaceType, span: Span, what: str, folder: InterfaceKind
    ) -> None:
        """Report a type without a usable definition of its kind."""
        problem = self.store.problem(kind)
        if problem is not None:
            self.fault(codes.UNUSABLE_DEFINITION, problem.about(kind), span)
            return
        if self.store.has_package(kind.package):
            message = f"package '{kind.package}' has no {what} type '{kind.name}'"
            known = self.store.names(kind.package, folder)
            hint = did_you_mean(near(kind.name, known), kind.name)
            self.fault(codes.UNKNOWN_TYPE, message, span, hint)
            return
        hint = did_you_mean(near(kind.package, self.store.packages()), kind.package)
        message = f"unknown interface package '{kind.package}'"
        hint = hint or "name the folder that has it with --interfaces PATH"
        self.fault(codes.UNKNOWN_PACKAGE, message, span, hint)

    def field(
        self,
        kind: InterfaceType,
        path: FieldPath,
        before: Span,
        span: Span,
        written: int,
        topic: str = "",
    ) -> ResolvedField | None:
        """Resolve a field path of ``kind``; report the first part that does not exist.

        The last ``written`` parts are in the term ``span``, after its part ``before``. ``topic`` is
        the one whose messages have the field, if it is known.
        """
        if written:
            self.mentions.append(FieldMention(topic, kind, path, before, span, written))
        found = resolve(self.store, kind, path)
        if not isinstance(found, FieldError):
            return found
        part = path[found.position]
        hint = did_you_mean(found.candidates[:3], part.name if isinstance(part, Key) else "")
        if len(found.candidates) > 3:
            hint = f"its fields: {', '.join(found.candidates)}"
        place = part_span(before, span, found.position - len(path) + written)
        self.fault(codes.UNKNOWN_FIELD, found.message, place, hint)
        return None

    # What the program reads ---------------------------------------------------------------------

    def use(self, each: DeclaredInput) -> int:
        """Return the input's index in the program, giving it one at its first use."""
        if each.index is None:
            each.index = len(self.used_inputs)
            self.used_inputs.append(each)
            if each.needs_one_publisher:
                self.read(each, ir.PUBLISHER, FieldType("bool"))
        return each.index

    def read(
        self, each: DeclaredInput, path: FieldPath, kind: FieldType, nan_is_unknown: bool = True
    ) -> ir.Read:
        """Return the reading of one leaf, adding it to the program at its first use."""
        owner = self.use(each)
        key = (owner, tuple(path))
        index = self._leaf_of.setdefault(key, len(self.leaves))
        if index == len(self.leaves):
            self.leaves.append(ir.Leaf(index, owner, tuple(path), kind, nan_is_unknown))
        elif nan_is_unknown and not self.leaves[index].nan_is_unknown:
            self.leaves[index] = dataclasses.replace(self.leaves[index], nan_is_unknown=True)
        return ir.Read(index)

    def constants_of(
        self, units: Iterable[tuple[str, str]], values: Iterable[Quantity]
    ) -> Iterator[ir.Const]:
        """Yield the constants in a function's parentheses, each in the unit that its row states."""
        for value, (_, unit) in zip(values, units, strict=True):
            yield ir.Const(rounded(value.in_unit(self.units.parse(unit))))

    def stamp(self, each: DeclaredInput) -> tuple[ir.Read, ...]:
        """Return seconds and nanoseconds of a message's header; nothing if its type has none."""
        found = resolve(self.store, each.type, ("header",))
        if isinstance(found, FieldError) or found.type.base != _HEADER or found.type.is_array:
            return ()
        return tuple(
            self.read(each, ("header", "stamp", name), FieldType(kind))
            for name, kind in (("sec", "int32"), ("nanosec", "uint32"))
        )

    def program_inputs(self) -> tuple[ir.Input, ...]:
        """Return the inputs of the program, in the order of their first use."""
        return tuple(
            ir.Input(
                index,
                each.name,
                each.topic,
                each.type,
                tuple(each.path),
                tuple(leaf.index for leaf in self.leaves if leaf.input == index),
                each.timeout_ns,
                each.span,
            )
            for index, each in enumerate(self.used_inputs)
        )
