"""Checks for rule topics without a publisher, and action topics without a subscriber."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from pathlib import PurePath

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.interfaces.standard_topics import standard_topic
from deros.models.common import Name
from deros.models.node import PortKind
from deros.models.rules import Rules
from deros.names.graph_names import resolve_name
from deros.names.names import did_you_mean
from deros.names.topic_likeness import likely_topics, words_of
from deros.rules.compiler.scope.topics import KnownTopic, SystemTopics, declared_shared
from deros.systems.flat import FlatPort
from deros.validators.findings.hints import SHOWN
from deros.validators.rules_walk import topics_read


def check_topics(rules: Rules, topics: SystemTopics) -> Iterator[Diagnostic]:
    """Yield the findings about the other ends of the rules' topics.

    External topics have their other end outside the model; the safety node itself publishes the
    topics of bound actions. A system with unknown parts proves nothing.
    """
    if not topics.complete:
        return
    read: dict[str, Name] = {}
    for name in topics_read(rules):
        read.setdefault(resolve_name(name.text, "/"), name)
    bound = {
        resolve_name(action.binding.topic.text, "/"): action.binding.topic
        for action in reversed(rules.actions)
        if action.binding
    }
    shared = declared_shared(rules, topics)
    for topic, name in read.items():
        if topic not in bound:
            yield from _unfed(topic, name, topics)
        if topic not in shared | bound.keys():
            yield from _several(topic, name, topics)
    heeded = {line.action.text for gate in rules.gates for line in gate.lines if line.action}
    by_gates = {
        resolve_name(action.binding.topic.text, "/")
        for action in rules.actions
        if action.binding and action.name.text in heeded
    }
    for topic, name in bound.items():
        if topic not in read and topic not in by_gates:
            yield from _unread(topic, name, topics, read.keys())


def _unfed(topic: str, name: Name, topics: SystemTopics) -> Iterator[Diagnostic]:
    known = topics.get(topic)
    if known is None or _has_end(known, known.publishers):
        return
    kind = "" if known.types else " : PACKAGE.TYPE"
    fed = [each for each in topics if _has_end(each, each.publishers)]
    yield report(
        codes.RULE_TOPIC_NOT_PUBLISHED,
        f"no node in the system publishes '{topic}'",
        name.span,
        _not_started(topic, topics)
        or did_you_mean(_meant(topic, known, fed), name.text, topic)
        or f"if it is published outside the model, declare 'external topic {topic}{kind}'",
        (Related(known.place, "the topic"),),
    )


def _not_started(topic: str, topics: SystemTopics) -> str:
    """Return the hint that a node type publishes a topic, and no node of it is in the system.

    Its port has the last word of the topic, and the type's name has the words before it.
    """
    space, _, last = topic.removeprefix("/").rpartition("/")
    for flat in topics.systems:
        started = {node.type.name for node in flat.nodes if node.type is not None}
        for node_type in flat.system.node_types.values():
            port = node_type.port(last, PortKind.PUBLISHER) or node_type.port(
                topic, PortKind.PUBLISHER
            )
            is_named = words_of(space.rpartition("/")[2]) <= words_of(node_type.name)
            if port is not None and is_named and node_type.name not in started:
                file = PurePath(node_type.source.path).name
                return (
                    f"node type '{node_type.name}' ({file}) publishes '{port.name}', and no node"
                    f" of it is in the system '{flat.system.name}'"
                )
    return ""


def _several(topic: str, name: Name, topics: SystemTopics) -> Iterator[Diagnostic]:
    """Yield that the messages of several nodes are taken for those of one."""
    known = topics.get(topic)
    if known is None or len(known.publishers) < 2:
        return
    if standard_topic(topic, known.type) is not None:
        return
    yield report(
        codes.SEVERAL_SOURCES,
        f"{len(known.publishers)} ports publish '{topic}': while one of them goes on, nothing"
        " notices that another one is silent, and the rules see the values of all in turn",
        name.span,
        "give each its own topic, and an input; if all are meant, write 'publishers any' at the"
        " input",
        tuple(
            Related(each.wiring.span if each.wiring else each.port.name_span, "published here")
            for each in known.publishers[:SHOWN]
        ),
    )


def _has_end(topic: KnownTopic, ends: list[FlatPort]) -> bool:
    """Return whether the topic has, or may have, a node at this end."""
    return bool(ends or topic.external or topic.untyped)


def _unread(
    topic: str, name: Name, topics: SystemTopics, read: Collection[str]
) -> Iterator[Diagnostic]:
    """Yield that no node reads an action's topic; what the rules read is not meant by it."""
    known = topics.get(topic)
    if known is not None and _has_end(known, known.subscriptions):
        return
    others = (each for each in topics if each.name not in read)
    subscribed = [each for each in others if _has_end(each, each.subscriptions)]
    yield report(
        codes.ACTION_TOPIC_NOT_IN_SYSTEM,
        f"no node in the system subscribes to '{topic}'",
        name.span,
        did_you_mean(_meant(topic, known, subscribed), name.text, topic)
        or f"if it is read outside the model, declare 'external topic {topic}'",
        (Related(known.place, "the topic"),) if known else (),
    )


def _meant(topic: str, known: KnownTopic | None, others: Iterable[KnownTopic]) -> list[str]:
    """Return the other topics that one was probably meant to be: of its type, if that is known."""
    kind = known.type if known else None
    return likely_topics(topic, (each.name for each in others if kind in (None, each.type)))
