"""Builds the program of a monitor from the rules as written, or reports what is wrong with them.

Names, field paths, types and units are resolved here, once; engine and generators read the result.
Every fault is reported, unless it follows from another.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from deros import codes
from deros.diagnostics import Diagnostic, has_errors
from deros.interfaces.store import InterfaceStore
from deros.models import rules
from deros.models.common import Name
from deros.rules.compiler.action_states import ActionStates, check_order
from deros.rules.compiler.actions import Actions
from deros.rules.compiler.comparisons import Comparisons
from deros.rules.compiler.conditions import Conditions
from deros.rules.compiler.gates.gate_resolution import GateResolver
from deros.rules.compiler.rule_names import RuleNames, WrittenRule
from deros.rules.compiler.scope.field_units import FieldUnits
from deros.rules.compiler.scope.mentions import FieldMention, Mention
from deros.rules.compiler.scope.resolved import AppliedFunction, Resolved, ResolvedComparison
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.scope.topics import SystemTopics
from deros.rules.compiler.scope.zones import Zones
from deros.rules.compiler.terms.terms import Terms
from deros.rules.program import ir


@dataclass(frozen=True, slots=True)
class BuildResult:
    """The result of building rules.

    Attributes:
        program: ``None`` when there is an error, here or, with a used system that could not be
            loaded, among the diagnostics of the loader.
        diagnostics: in the order found.
        comparisons: the comparisons that could be resolved, for further checks.
        functions: the functions of messages and arrays that could be resolved, likewise.
        topics: the topics of the used systems.
        units: of the fields that the rules read.
        mentions: what the names in terms are, in the order found; a term may be met twice.
        constants: the values of the constants that have one.
    """

    program: ir.Program | None
    diagnostics: tuple[Diagnostic, ...]
    comparisons: tuple[ResolvedComparison, ...]
    topics: SystemTopics
    units: FieldUnits
    functions: tuple[AppliedFunction, ...] = ()
    mentions: tuple[Mention | FieldMention, ...] = ()
    constants: Mapping[str, Resolved] = field(default_factory=dict)


def build(program: rules.Rules, store: InterfaceStore) -> BuildResult:
    """Resolve all names in the rules, and return them in the intermediate form."""
    builder = _Builder(program, store)
    built = builder.build()
    scope = builder.scope
    if _is_sound(scope):
        check_order(scope, built)
    return BuildResult(
        built if _is_sound(scope) else None,
        tuple(scope.diagnostics),
        tuple(builder.comparisons.found),
        scope.topics,
        scope.field_units,
        tuple(builder.terms.functions),
        tuple(scope.mentions),
        builder.terms.values,
    )


def _is_sound(scope: Scope) -> bool:
    """Return whether the program is whole: what has an error is left out of it."""
    return scope.systems_known and not scope.untold and not has_errors(scope.diagnostics)


class _Builder:
    """Builds one program. Faulty parts are left out, and make the whole result unusable."""

    def __init__(self, program: rules.Rules, store: InterfaceStore) -> None:
        self._program = program
        self.scope = Scope(program, store)
        rules_of = {
            each.name.text: [rule.name.text for rule in each.rules] for each in program.entities
        }
        actions = frozenset(each.name.text for each in program.actions)
        zones = Zones(self.scope, program).declared
        self.terms = terms = Terms(self.scope, rules_of, actions, zones)
        for name in self.scope.constants:
            terms.constant(name)
        self.comparisons = Comparisons(self.scope, terms)
        self._actions = Actions(self.scope, terms, program.actions)
        self._gates = GateResolver(self.scope, terms, self._actions)
        self._rule_index: dict[int, int] = {}
        self._built: dict[int, ir.Rule] = {}
        states = ActionStates(self.scope, self._actions.indices, lambda e: self._names.is_known(e))
        self._conditions = Conditions(self.scope, self.comparisons, self._built, states)
        self._behaviours = 0

    def build(self) -> ir.Program:
        """Build rules, then behaviours, in the order in which the monitor evaluates them."""
        self.scope.check_names(_declared(self._program))
        self.scope.check_readable(_read(self._program))
        self._names = RuleNames(self.scope, self._program.entities)
        built_rules = tuple(self._rules())
        self._name_behaviours()
        behaviours = tuple(
            built
            for each in self._program.behaviours
            if (built := self._behaviour(each, None)) is not None
        )
        gates = self._gates.build(self._program.gates)
        self.scope.diagnostics += self.scope.field_units.conflicts()
        return ir.Program(
            self._program.name,
            tuple(self.scope.leaves),
            self.scope.program_inputs(),
            built_rules,
            behaviours,
            self._actions.program_actions(),
            gates,
            tuple(self.scope.tunables),
        )

    # Rules --------------------------------------------------------------------------------------

    def _rules(self) -> Iterator[ir.Rule]:
        for index, number in enumerate(self._names.in_order()):
            self._rule_index[number] = index
            written = self._names.written[number]
            condition = self._condition(written)
            if condition is not None:
                rule = written.rule
                built = ir.Rule(index, written.entity, rule.name.text, condition, rule.span)
                self._built[index] = built
                yield built

    def _condition(self, written: WrittenRule) -> ir.Condition | None:
        rule, entity = written.rule, written.entity
        condition = self._conditions.of_rule(
            rule.condition,
            lambda term: self._names.is_reference(term, entity),
            lambda term: self._verdict(term, entity),
        )
        if condition is None or not rule.failsafe:
            return condition
        inputs = self._conditions.inputs_of(condition)
        if not inputs:
            return condition  # it is never unknown
        timed = True
        for index in inputs:
            owner = self.scope.used_inputs[index]
            without = f"'{owner.name}' has no timeout, so no silence of it makes the rule unknown"
            timed &= self.terms.of_functions.has_timeout(owner, without, rule.name.span)
        return ir.Failsafe(condition, inputs) if timed else None

    def _verdict(self, term: rules.NamePath, entity: str = "") -> ir.RuleRef | None:
        """Resolve the name of a rule; without ``entity`` only ``entity.rule``."""
        number = self._names.find(term, entity)
        return None if number is None else ir.RuleRef(self._rule_index.get(number, -1))

    # Behaviours ---------------------------------------------------------------------------------

    def _name_behaviours(self) -> None:
        """Check that behaviour names, given or numbered, are unique."""
        everyone = [each for top in self._program.behaviours for each in _with_nested(top)]
        numbered = {f"behaviour_{i}": i for i, each in enumerate(everyone, 1) if not each.name}
        given = [each.name for each in everyone if each.name]
        self.scope.check_duplicates(given, "behaviour '{}'")
        for name in given:
            if name.text in numbered:
                message = (
                    f"'{name}' is the name of the behaviour that is number {numbered[name.text]}"
                    " in the file and has no name of its own"
                )
                self.scope.fault(codes.DUPLICATE_RULE_NAME, message, name.span)

    def _behaviour(self, written: rules.Behaviour, parent: int | None) -> ir.Behaviour | None:
        index = self._behaviours
        self._behaviours += 1
        condition = self._conditions.of_behaviour(written.condition, self._verdict)
        body: list[ir.Trigger | ir.Behaviour] = []
        for item in written.body:
            built = (
                self._behaviour(item, index)
                if isinstance(item, rules.Behaviour)
                else self._actions.trigger(item, index)
            )
            if built is not None:
                body.append(built)
        if condition is None:
            return None
        name = written.name.text if written.name else f"behaviour_{index + 1}"
        return ir.Behaviour(
            index, name, condition, tuple(body), parent, written.span, written.optional
        )


def _declared(program: rules.Rules) -> Iterator[Name]:
    """Yield every name that the rules declare, but those of units, which are not emitted."""
    yield from (each.name for each in program.constants)
    yield from (each.name for each in program.inputs)
    yield from (each.name for each in program.zones)
    yield from (each.name for each in program.entities)
    for entity in program.entities:
        for rule in entity.rules:
            yield rule.name
    for action in program.actions:
        yield from (action.name, *action.parameters)
    for top in program.behaviours:
        yield from (each.name for each in _with_nested(top) if each.name is not None)


def _read(program: rules.Rules) -> Iterator[Name]:
    """Yield every name with which a term of a condition may begin, but those of rules.

    They are read with the name of their entity too.
    """
    yield from (each.name for each in program.constants)
    yield from (each.name for each in program.inputs)
    yield from (each.name for each in program.zones)
    yield from (each.name for each in program.entities)


def _with_nested(behaviour: rules.Behaviour) -> Iterator[rules.Behaviour]:
    yield behaviour
    for item in behaviour.body:
        if isinstance(item, rules.Behaviour):
            yield from _with_nested(item)
