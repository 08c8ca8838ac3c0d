"""Traversal of rules as written: terms of conditions, and behaviours."""

from __future__ import annotations

from collections.abc import Iterator

from deros.models.common import Name
from deros.models.rules import (
    Arithmetic,
    Behaviour,
    Call,
    Comparison,
    Condition,
    Entries,
    Membership,
    NamePath,
    Negative,
    Rule,
    Rules,
    Term,
    TopicPath,
    Truth,
    leaves,
)
from deros.rules.compiler.action_states import ACTIVE
from deros.rules.compiler.rule_names import names_alone


def rules_of(rules: Rules) -> Iterator[tuple[str, Rule]]:
    """Yield every rule of every entity with its full name, ``entity.rule``."""
    for entity in rules.entities:
        for rule in entity.rules:
            yield f"{entity.name}.{rule.name}", rule


def behaviours_of(rules: Rules) -> Iterator[Behaviour]:
    """Yield all behaviours, outer before inner, top to bottom."""

    def descend(behaviour: Behaviour) -> Iterator[Behaviour]:
        yield behaviour
        for item in behaviour.body:
            if isinstance(item, Behaviour):
                yield from descend(item)

    for behaviour in rules.behaviours:
        yield from descend(behaviour)


class RulesByName:
    """The rules of all entities by their full names, and what the names of rules refer to."""

    def __init__(self, rules: Rules) -> None:
        """Take the first of the rules that have one name."""
        self._taken = {each.name.text for each in rules.inputs}
        self._taken |= {each.name.text for each in rules.constants}
        self._actions = {each.name.text for each in rules.actions}
        self._rules: dict[str, tuple[str, Rule]] = {}
        for entity in rules.entities:
            for rule in entity.rules:
                full_name = f"{entity.name}.{rule.name}"
                self._rules.setdefault(full_name, (entity.name.text, rule))

    def __getitem__(self, full_name: str) -> tuple[str, Rule]:
        """Return the entity and the rule of a full name."""
        return self._rules[full_name]

    def named_by(self, condition: Condition, entity: str = "") -> Iterator[tuple[NamePath, str]]:
        """Yield the names of rules in a condition, each with the full name that it stands for.

        Args:
            condition: of a behaviour or a rule.
            entity: that of the rule; empty for a behaviour.
        """
        for term in names_alone(condition):
            full_name = self.full_name(term, entity)
            if full_name is not None:
                yield term, full_name

    def named_by_rule(self, full_name: str) -> Iterator[tuple[NamePath, str]]:
        """Yield the same of the condition of a rule."""
        entity, rule = self[full_name]
        yield from self.named_by(rule.condition, entity)

    def full_name(self, term: NamePath, entity: str = "") -> str | None:
        """Return the full name of the rule that a name alone refers to, if it does."""
        if entity and term.name.text in self._taken:
            return None
        written = ".".join(map(str, (term.name, *term.path)))
        found = written if term.path else f"{entity}.{written}"
        return found if found in self._rules else None

    def action(self, term: NamePath) -> str | None:
        """Return the action whose state a name alone asks for, if it does and is not a rule."""
        name = term.name.text
        is_asked = term.path == (ACTIVE,) and name in self._actions and name not in self._taken
        return name if is_asked else None


def terms_of(condition: Condition) -> Iterator[Term]:
    """Yield the terms of a condition, without nested ones."""
    for leaf in leaves(condition):
        match leaf:
            case Comparison():
                yield leaf.left
                yield leaf.right
            case Membership():
                yield leaf.operand
                yield leaf.lower
                yield leaf.upper
            case Truth():
                yield leaf.operand


def topics_read(rules: Rules) -> Iterator[Name]:
    """Yield every topic that inputs and rules name, repetitions included."""
    for each in rules.inputs:
        yield each.term.topic
    for _, rule in rules_of(rules):
        for term in terms_of(rule.condition):
            for inner in all_terms(term):
                if isinstance(inner, TopicPath):
                    yield inner.topic
    for end in ends_of_limits(rules):
        for inner in all_terms(end):
            if isinstance(inner, TopicPath):
                yield inner.topic


def ends_of_limits(rules: Rules) -> Iterator[Term]:
    """Yield the ends of the limits of all gates."""
    for line in (line for gate in rules.gates for line in gate.lines):
        yield from (end for limit in line.limits for end in (limit.lower, limit.upper))


def all_terms(term: Term) -> Iterator[Term]:
    """Yield a term and every term inside it."""
    yield term
    match term:
        case Negative():
            yield from all_terms(term.operand)
        case Arithmetic():
            yield from all_terms(term.left)
            yield from all_terms(term.right)
        case Call():
            for inner in (term.receiver, *term.arguments):
                if inner is not None:
                    yield from all_terms(inner)
        case Entries():
            for outer in terms_of(term.condition):
                yield from all_terms(outer)
        case _:
            pass
