"""Which topics a DeRoS program reads and feeds: its safety node is an end of those topics."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from deros.metamodels.flatten import resolve_name
from deros.metamodels.rules import (
    And,
    Call,
    Comparison,
    Condition,
    For,
    Membership,
    Negative,
    Not,
    Or,
    Rules,
    Term,
    TopicPath,
    Truth,
)


@dataclass(frozen=True, slots=True)
class RulesEnds:
    """Graph names of the topics that safety nodes subscribe (``read``) and publish (``fed``)."""

    read: frozenset[str] = frozenset()
    fed: frozenset[str] = frozenset()


def ends_of(programs: Iterable[Rules]) -> RulesEnds:
    """Return the ends of the safety nodes that the programs become."""
    read: set[str] = set()
    fed: set[str] = set()
    for rules in programs:
        read.update(resolve_name(path.topic.text, "/") for path in _topic_paths(rules))
        bindings = (action.binding for action in rules.actions)
        fed.update(resolve_name(each.topic.text, "/") for each in bindings if each is not None)
    return RulesEnds(frozenset(read), frozenset(fed))


def _topic_paths(rules: Rules) -> Iterator[TopicPath]:
    yield from (each.term for each in rules.inputs)
    for entity in rules.entities:
        for rule in entity.rules:
            yield from _in_condition(rule.condition)


def _in_condition(condition: Condition) -> Iterator[TopicPath]:
    match condition:
        case Comparison(left=left, right=right):
            yield from _in_term(left)
            yield from _in_term(right)
        case Membership(operand=operand, lower=lower, upper=upper):
            for term in (operand, lower, upper):
                yield from _in_term(term)
        case Truth(operand=operand):
            yield from _in_term(operand)
        case Not(operand=inner) | For(operand=inner):
            yield from _in_condition(inner)
        case And(operands=operands) | Or(operands=operands):
            for inner in operands:
                yield from _in_condition(inner)


def _in_term(term: Term) -> Iterator[TopicPath]:
    match term:
        case TopicPath():
            yield term
        case Negative(operand=operand):
            yield from _in_term(operand)
        case Call(receiver=receiver, arguments=arguments):
            for inner in (receiver, *arguments):
                if inner is not None:
                    yield from _in_term(inner)
        case _:
            return
