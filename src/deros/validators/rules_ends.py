"""Which topics a DeRoS program reads and feeds: its nodes are ends of those topics."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from deros.metamodels.flatten import resolve_name
from deros.metamodels.rules import Rules
from deros.validators.rules_walk import topics_read


@dataclass(frozen=True, slots=True)
class RulesEnds:
    """Graph names of the topics at which safety nodes and gates are ends.

    Attributes:
        read: those that they subscribe.
        fed: those that they publish.
        gated: source and target of each gate.
    """

    read: frozenset[str] = frozenset()
    fed: frozenset[str] = frozenset()
    gated: frozenset[tuple[str, str]] = frozenset()


def ends_of(programs: Iterable[Rules]) -> RulesEnds:
    """Return the ends of the safety nodes and the gates that the programs become."""
    read: set[str] = set()
    fed: set[str] = set()
    gated: set[tuple[str, str]] = set()
    for rules in programs:
        read.update(resolve_name(name.text, "/") for name in topics_read(rules))
        bindings = (action.binding for action in rules.actions)
        fed.update(resolve_name(each.topic.text, "/") for each in bindings if each is not None)
        gated.update(
            (resolve_name(gate.source.text, "/"), resolve_name(gate.target.text, "/"))
            for gate in rules.gates
        )
    read.update(source for source, _ in gated)
    fed.update(target for _, target in gated)
    return RulesEnds(frozenset(read), frozenset(fed), frozenset(gated))
