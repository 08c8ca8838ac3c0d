"""The topics that rules read and publish: their nodes are ends of those topics."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import chain
from typing import ClassVar

from deros.diagnostics import Span
from deros.models.common import Name, QosProfile
from deros.models.node import PortKind
from deros.models.rules import Rules
from deros.names.graph_names import resolve_name
from deros.rules.compiler.scope.topics import SystemTopics
from deros.systems import safety_qos
from deros.validators.rules_walk import topics_read


@dataclass(frozen=True, slots=True)
class RulesEnd:
    """An end that the safety node or a gate of a program has, whether or not a system names it."""

    name: str
    kind: PortKind
    topic: str
    qos: QosProfile
    span: Span = field(compare=False, repr=False)
    is_assumed: ClassVar[bool] = False

    @property
    def qos_span(self) -> Span:
        """The place in the rules that names the topic."""
        return self.span


@dataclass(frozen=True, slots=True)
class RulesEnds:
    """Graph names of the topics at which safety nodes and gates are ends.

    Attributes:
        read: the topics that they subscribe to.
        fed: the topics that they publish.
        gated: source and target of each gate, for each of its sources.
        ends: all of these ends, with their QoS.
    """

    read: frozenset[str] = frozenset()
    fed: frozenset[str] = frozenset()
    gated: frozenset[tuple[str, str]] = frozenset()
    ends: tuple[RulesEnd, ...] = ()


def ends_of(programs: Iterable[Rules]) -> RulesEnds:
    """Return the ends of the safety nodes and the gates that the programs become."""
    programs = tuple(programs)
    ends = tuple(chain.from_iterable(map(_ends, programs)))
    gated = frozenset(
        (resolve_name(source.topic.text, "/"), resolve_name(gate.target.text, "/"))
        for rules in programs
        for gate in rules.gates
        for source in gate.sources
    )
    return RulesEnds(
        frozenset(end.topic for end in ends if end.kind is PortKind.SUBSCRIPTION),
        frozenset(end.topic for end in ends if end.kind is PortKind.PUBLISHER),
        gated,
        ends,
    )


def _ends(rules: Rules) -> Iterator[RulesEnd]:
    systems = (use.system for use in rules.uses)
    topics = SystemTopics(system for system in systems if system is not None)
    node = f"the safety node of '{rules.name}'"
    seen: set[tuple[str, PortKind]] = set()

    def end(owner: str, kind: PortKind, name: Name, qos: QosProfile) -> RulesEnd:
        return RulesEnd(owner, kind, resolve_name(name.text, "/"), qos, name.span)

    for name in topics_read(rules):
        topic = resolve_name(name.text, "/")
        if (topic, PortKind.SUBSCRIPTION) not in seen:
            seen.add((topic, PortKind.SUBSCRIPTION))
            yield end(node, PortKind.SUBSCRIPTION, name, safety_qos.input_qos(topics.offers(topic)))
    for action in rules.actions:
        if action.binding is not None:
            name = action.binding.topic
            topic = resolve_name(name.text, "/")
            if (topic, PortKind.PUBLISHER) not in seen:
                seen.add((topic, PortKind.PUBLISHER))
                yield end(node, PortKind.PUBLISHER, name, safety_qos.STATE)
    for gate in rules.gates:
        owner = f"the gate to '{gate.target}'"
        for source in gate.sources:
            offers = topics.offers(resolve_name(source.topic.text, "/"))
            qos = safety_qos.gate_source_qos(offers)
            yield end(owner, PortKind.SUBSCRIPTION, source.topic, qos)
        yield end(owner, PortKind.PUBLISHER, gate.target, safety_qos.GATE_TARGET)
