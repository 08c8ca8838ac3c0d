"""Checks of ports that no ``connect`` mentions."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.interfaces.standard_topics import (
    has_topic_of_its_own,
    is_operated,
    is_shown_only,
    standard_topic,
)
from deros.interfaces.types import InterfaceType
from deros.models.node import PortKind
from deros.names.topic_likeness import LikelyTopics
from deros.systems.flat import FlatNode, FlatPort, FlatSystem, entries_of
from deros.validators.system.topic_partners import Partners
from deros.validators.wiring.graph import CHANNEL, End, Vertex
from deros.validators.wiring.topic_channels import Channel

_SEEKS_A_PARTNER = {
    PortKind.PUBLISHER: "publisher",
    PortKind.SUBSCRIPTION: "subscription",
    PortKind.CLIENT: "client",
    PortKind.ACTION_CLIENT: "action client",
}
"""Kinds of ports that are reported; a server is reached under its own name anyway."""

_COMPARED = 20
"""So many subscribed topics of a type and last word are looked at to find one for a publisher."""


def check_unwired(
    flat: FlatSystem,
    by_vertex: Mapping[Vertex, Channel],
    partners: Partners[Channel],
    read_by_rules: Callable[[str], bool],
) -> Iterator[Diagnostic]:
    """Yield a finding for each port that is not connected, once for each place where it is written.

    Unused publishers of an existing program are not reported.
    Standard topics have their other ends in libraries and tools.

    Args:
        flat: the system.
        by_vertex: its topics, services and actions.
        partners: finds the topics that one was probably meant to be.
        read_by_rules: returns whether safety rules read the topic of a name.
    """
    asked = _Asked(by_vertex.values(), partners)
    reported: set[tuple[int, PortKind, str, str | None]] = set()
    seen: set[int] = set()
    for node in flat.nodes:
        if _has_unknown_wirings(node):
            continue  # one of those may be meant for the port
        if id(node.instance) not in seen:
            seen.add(id(node.instance))
            yield from _without_topic(node)
        for port in node.ports:
            # Of a system that is used several times, each instance would say the same.
            name = port.entry or port.port.name
            key = (id(node.instance), port.port.kind, name, port.named_by)
            is_wired = port.wiring is not None or _is_listed(node, port, by_vertex)
            if is_wired or key in reported or _is_standard(port):
                continue
            word = _SEEKS_A_PARTNER.get(port.port.kind)
            if word is None:
                continue
            if _is_output_of_program(node, port):
                channel = by_vertex["topic", port.topic]
                if not read_by_rules(port.topic) and not asked.asks_for(channel):
                    continue
            reported.add(key)
            yield report(
                codes.UNWIRED_PORT,
                f"{word} '{port.port.name}' of '{node.instance.name}' is not connected",
                node.instance.name_span,
                hint=_hint(_in_wirings(node, port), port, by_vertex),
                related=(Related(port.port.span, f"the {word} is declared here"),),
            )


def _without_topic(node: FlatNode) -> Iterator[Diagnostic]:
    """Yield the entries of maps that name no topic, unless the system itself says so."""
    node_type, settings = node.type, dict(node.parameters)
    if node_type is None:
        return
    for port in filter(node_type.is_listed, node_type.ports):
        parameter = node_type.parameter(port.via or "")
        if parameter is None or not parameter.keys or parameter.default != "":
            continue
        for entry in dict.fromkeys(entries_of(node_type, parameter, settings) or ()):
            name = parameter.name_for(entry)
            if name not in settings:
                yield report(
                    codes.UNWIRED_PORT,
                    f"subscription '{port.name}' of '{node.instance.name}' is not connected for"
                    f" entry '{entry}'",
                    node.instance.name_span,
                    hint=f"name its topic with 'param {name} = \"…\"'; an empty text says that it"
                    " has none",
                    related=(Related(port.span, "the subscription is declared here"),),
                )


def _is_listed(node: FlatNode, port: FlatPort, by_vertex: Mapping[Vertex, Channel]) -> bool:
    """Return whether the system names the topic of a port of several, or declares it."""
    if port.entry is None:
        return False
    return End(node, port).wired or by_vertex["topic", port.topic].declared is not None


def _is_standard(port: FlatPort) -> bool:
    kind = port.port.type
    if port.port.kind is PortKind.PUBLISHER and is_shown_only(kind):
        return True
    if port.port.kind is PortKind.SUBSCRIPTION and is_operated(kind):
        return True
    is_topic = CHANNEL[port.port.kind] == "topic"
    return is_topic and standard_topic(port.topic, kind) is not None


def _is_output_of_program(node: FlatNode, port: FlatPort) -> bool:
    is_program = node.type is not None and node.type.executable is not None
    return is_program and port.port.kind is PortKind.PUBLISHER


class _Asked:
    """The topics that nodes subscribe to, to decide whether one was meant for a publisher."""

    def __init__(self, found: Iterable[Channel], partners: Partners[Channel]) -> None:
        """Index the subscribed topics by their type, and by their type and last word."""
        self._partners = partners
        self._unfed: dict[InterfaceType, list[Channel]] = defaultdict(list)
        self._called: dict[tuple[InterfaceType, str], list[Channel]] = defaultdict(list)
        declared: dict[InterfaceType, list[str]] = defaultdict(list)
        for each in found:
            if each.vertex[0] != "topic":
                continue
            if each.declared is not None and not each.sources and each.known_type is not None:
                declared[each.known_type].append(each.name)
            if not each.sinks:
                continue
            if not each.sources and not each.open:
                self._unfed[each.type].append(each)
            self._called[each.type, _last_word(each.name)].append(each)
        self._declared = {kind: LikelyTopics(names) for kind, names in declared.items()}

    def asks_for(self, fed: Channel) -> bool:
        """Return whether some node may expect the messages that are published on a topic.

        That is so where the topic is declared or read, where a topic of its type that another node
        reads is called alike, or one that is declared and not published, or where one lacks a
        publisher; and where the type is for a standard topic, which this one is not.
        """
        own = {end.node.full_name for end in fed.sources}
        if fed.declared is not None or any(end.node.full_name not in own for end in fed.sinks):
            return True
        if has_topic_of_its_own(fed.type):
            return True
        declared = self._declared.get(fed.type)
        if declared is not None and declared.best(fed.name, n=1):
            return True
        candidates = [
            *self._unfed[fed.type][:_COMPARED],
            *self._called[fed.type, _last_word(fed.name)][:_COMPARED],
        ]
        if any(self._partners.can_join(fed, each) for each in candidates):
            return True
        return bool(self._partners.read_for(fed, lambda _: True))


def _last_word(name: str) -> str:
    return name.rpartition("/")[2]


def _in_wirings(node: FlatNode, port: FlatPort) -> str:
    """Return how a ``connect`` names a port: with its kind where others have its name."""
    alike = {other.port.kind for other in node.ports if other.port.name == port.port.name}
    return f"{port.port.kind.word} {port.port.name}" if len(alike) > 1 else port.port.name


def _has_unknown_wirings(node: FlatNode) -> bool:
    known = sum(port.wiring is not None for port in node.ports) + len(node.untyped)
    return len(node.instance.wirings) > known


def _hint(name: str, port: FlatPort, by_vertex: Mapping[Vertex, Channel]) -> str:
    topic = port.topic
    if port.entry is not None:
        lists, others, value = "names", "name another topic", '"…"'
        if port.named_by == port.port.via:
            lists, others, value = "lists", "list other topics", "[…]"
        return (
            f"'{port.named_by}' {lists} '{topic}' by default: {others} with 'param"
            f" {port.named_by} = {value}', or declare 'external topic {topic}' if that is published"
            " outside the model"
        )
    channel = by_vertex.get(("topic", topic))
    if channel is not None and channel.declared is not None:
        return f"'{topic}' is declared with this name: add 'connect {name} to {topic}'"
    if CHANNEL[port.port.kind] != "topic":
        return f"it uses its own name, '{topic}'; 'connect {name} to …' changes that"
    way = "read" if port.port.kind is PortKind.PUBLISHER else "published"
    return (
        f"it uses its own name, '{topic}'; write 'connect {name} to …', and declare an 'external"
        f" topic' if that is {way} outside the model"
    )
