"""Traversal of rules as written: terms of conditions, and behaviours."""

from __future__ import annotations

from collections.abc import Iterator

from deros.metamodels.common import Name
from deros.metamodels.rules import (
    And,
    Behaviour,
    Call,
    Comparison,
    Condition,
    For,
    Membership,
    Negative,
    Not,
    Or,
    Rule,
    Rules,
    Term,
    TopicPath,
)


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


def terms_of(condition: Condition) -> Iterator[Term]:
    """Yield the terms of a condition, without nested ones."""
    match condition:
        case Comparison():
            yield condition.left
            yield condition.right
        case Membership():
            yield condition.operand
            yield condition.lower
            yield condition.upper
        case And() | Or():
            for operand in condition.operands:
                yield from terms_of(operand)
        case Not() | For():
            yield from terms_of(condition.operand)
        case _:
            yield condition.operand


def topics_read(rules: Rules) -> Iterator[Name]:
    """Yield every topic that inputs and rules name, repetitions included."""
    for each in rules.inputs:
        yield each.term.topic
    for _, rule in rules_of(rules):
        for term in terms_of(rule.condition):
            for inner in all_terms(term):
                if isinstance(inner, TopicPath):
                    yield inner.topic


def all_terms(term: Term) -> Iterator[Term]:
    """Yield a term and every term inside it."""
    yield term
    match term:
        case Negative():
            yield from all_terms(term.operand)
        case Call():
            for inner in (term.receiver, *term.arguments):
                if inner is not None:
                    yield from all_terms(inner)
        case _:
            pass
