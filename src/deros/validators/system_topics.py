"""Topics, services and actions as a whole: types that meet, ends that are missing."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from deros import codes
from deros.diagnostics import Code, Diagnostic, Related, Span, report
from deros.interfaces.names import did_you_mean
from deros.interfaces.standard_topics import is_shown_only, standard_topic, wrong_type
from deros.metamodels.flatten import FlatNode, FlatPort, FlatSystem, FlatTopic, resolve_name
from deros.metamodels.node import PortKind
from deros.metamodels.system import Topic
from deros.validators.graph import CHANNEL, End, Vertex, channels, publishers, subscribers
from deros.validators.rules_ends import RulesEnds
from deros.validators.topic_partners import Partners, Robots

if TYPE_CHECKING:
    import networkx as nx

    from deros.interfaces.types import InterfaceType

_COMPARED = 20
"""So many topics of a type that nobody subscribes to are looked at to find one for another."""

_SEEKS_A_PARTNER = {
    PortKind.PUBLISHER: "publisher",
    PortKind.SUBSCRIPTION: "subscription",
    PortKind.CLIENT: "client",
    PortKind.ACTION_CLIENT: "action client",
}
"""Ports for which no wiring is worth a word; a server is reached under its own name as it is."""


@dataclass(frozen=True, slots=True)
class _Channel:
    """A topic, service or action with its ends; ``open`` when the model cannot know them all.

    ``pin`` is the outermost declaration that gives the topic a type.
    """

    vertex: Vertex
    declared: FlatTopic | None
    pin: Topic | None
    sources: list[End]
    sinks: list[End]
    open: bool

    @property
    def name(self) -> str:
        return self.vertex[1]

    @property
    def type(self) -> InterfaceType:
        """The type of the first end; only for channels that have one."""
        return (self.sources or self.sinks)[0].type

    @property
    def undeclared(self) -> bool:
        """Whether a wiring names a topic that nobody declares, which is a finding of its own."""
        return self.declared is None and any(end.wired for end in (*self.sources, *self.sinks))

    @property
    def span(self) -> Span:
        """Where it is declared, else its first connection."""
        if self.declared is not None:
            return self.declared.declaration.name_span
        return (self.sources or self.sinks)[0].span


def check_topics(
    flat: FlatSystem, graph: nx.MultiDiGraph[Vertex], rules: RulesEnds
) -> Iterator[Diagnostic]:
    """Yield the findings about whole topics, services and actions, and about unwired ports.

    What ``rules`` read or feed lacks no end there, whether or not the system names the safety node.
    """
    guessed = _targets_of_unknown_ports(flat)
    pins = _pinned_types(flat)
    found = [_channel(graph, vertex, guessed, pins) for vertex in channels(graph)]
    types = {each.name: each.type for each in found if each.sources or each.sinks}
    topics: list[_Channel] = []
    for channel in found:
        unusual = list(_unusual_types(channel, types)) if channel.vertex[0] == "topic" else []
        yield from unusual or _types(channel)
        if channel.vertex[0] == "topic" and not unusual:
            topics.append(channel)
    partners = Partners((each for each in topics if each.sources or each.sinks), Robots(flat.nodes))
    pairs = _misspelt(topics, partners, rules)
    topics = [channel for channel in topics if not _ends_in_rules(channel, rules)]
    misspelt = {read.name for read, _ in pairs}
    for read, matches in pairs:
        yield _misspelling(read, matches)
        if not matches[0].sinks:
            misspelt.add(matches[0].name)
    yield from _missing_ends(topics, misspelt, partners)
    for channel in found:
        if channel.vertex[0] != "topic":
            yield from _missing_server(channel)
    yield from _unwired(flat, {channel.vertex: channel for channel in found})


def _channel(
    graph: nx.MultiDiGraph[Vertex], vertex: Vertex, guessed: set[str], pins: Mapping[str, Topic]
) -> _Channel:
    attributes = graph.nodes[vertex]
    declared: FlatTopic | None = attributes.get("topic")
    if vertex[0] != "topic":
        # A service has no declaration of its own; an external topic of its name speaks for it.
        declared = graph.nodes.get(("topic", vertex[1]), {}).get("topic")
    sources, sinks = publishers(graph, vertex), subscribers(graph, vertex)
    pin = pins.get(vertex[1]) if vertex[0] == "topic" else None
    is_open = (
        (declared is not None and declared.declaration.external)
        or bool(attributes.get("untyped"))
        or vertex[1] in guessed
        or (vertex[0] == "topic" and _is_standard(vertex[1], pin, [*sources, *sinks]))
    )
    return _Channel(vertex, declared, pin, sources, sinks, is_open)


def _pinned_types(flat: FlatSystem) -> dict[str, Topic]:
    """Return the declaration that gives each topic its type: the first, which is the outermost."""
    pins: dict[str, Topic] = {}
    for topic in flat.topics:
        if topic.declaration.type is not None:
            pins.setdefault(topic.name, topic.declaration)
    return pins


def _is_standard(name: str, pin: Topic | None, ends: list[End]) -> bool:
    """Tell whether a topic has ends in libraries, tools or hands, which no model describes."""
    kind = pin.type if pin is not None else None
    if kind is None and ends:
        kind = ends[0].type
    return standard_topic(name, kind) is not None


def _targets_of_unknown_ports(flat: FlatSystem) -> set[str]:
    """Return the topics wired to ports that are not known, which other findings report.

    Whether such a port publishes or subscribes cannot be told: nothing is said to be missing there.
    """
    targets: set[str] = set()
    for node in flat.nodes:
        known = {id(port.wiring) for port in node.ports}
        for wiring in node.instance.wirings:
            if id(wiring) not in known:
                targets.add(resolve_name(wiring.target, node.namespace, node.instance.name))
    return targets


def _ends_in_rules(topic: _Channel, rules: RulesEnds) -> bool:
    """Tell whether the safety node is the end that a topic would lack."""
    return (topic.name in rules.read and (bool(topic.sources) or not topic.sinks)) or (
        topic.name in rules.fed and not topic.sources
    )


# Types ------------------------------------------------------------------------------------------


def _types(channel: _Channel) -> Iterator[Diagnostic]:
    ends = channel.sources + channel.sinks
    pinned = channel.pin.type if channel.pin is not None else None
    if pinned is not None and channel.pin is not None:
        place = channel.pin.type_span
        for end in ends:
            if end.type != pinned:
                yield report(
                    codes.PINNED_TYPE_VIOLATED,
                    f"'{channel.name}' is pinned to {pinned.short}, "
                    f"but {end.name} has {end.type.short}",
                    end.span,
                    related=(
                        *((Related(place, "pinned here"),) if place is not None else ()),
                        Related(end.port.port.type_span, f"{end.port.port.name} is declared here"),
                    ),
                )
        return
    if not ends:
        return
    reference = ends[0]
    for end in ends:
        if end.type != reference.type:
            yield report(
                codes.TYPE_MISMATCH,
                f"'{channel.name}' joins two types: {end.name} has {end.type.short}, "
                f"{reference.name} has {reference.type.short}",
                end.span,
                hint="connect one of them to another topic, or make their types agree",
                related=(
                    Related(end.port.port.type_span, f"{end.type.short} is declared here"),
                    Related(reference.span, "the other end is connected here"),
                    Related(
                        reference.port.port.type_span, f"{reference.type.short} is declared here"
                    ),
                ),
            )


def _unusual_types(channel: _Channel, types: Mapping[str, InterfaceType]) -> Iterator[Diagnostic]:
    """Find a standard topic of another type; a pin goes first where no library relies on it."""
    pinned = channel.pin
    places = [(end.type, end.span, f"{end.name} has") for end in (*channel.sources, *channel.sinks)]
    if pinned is not None and pinned.type is not None and pinned.type_span is not None:
        places.insert(0, (pinned.type, pinned.type_span, "the pin is"))
    for kind, span, who in places:
        entry = wrong_type(channel.name, kind, types.get)
        if entry is None or (pinned is not None and pinned.type == kind and not entry.fixed):
            continue
        usual = " or ".join(sorted(entry.types)).replace("/", ".")
        yield report(
            codes.STANDARD_TOPIC_TYPE,
            f"'{channel.name}' is {usual} in every ROS 2 system, but {who} {kind.short}",
            span,
            f"use {usual}, or another name: {entry.why}",
        )


# Missing ends -----------------------------------------------------------------------------------


def _missing_ends(
    topics: Iterable[_Channel], misspelt: set[str], partners: Partners[_Channel]
) -> Iterator[Diagnostic]:
    lonely = [t for t in topics if t.declared is not None and not t.open and t.name not in misspelt]
    fed: dict[InterfaceType, list[_Channel]] = defaultdict(list)
    for topic in lonely:
        if topic.sources and not topic.sinks and len(fed[topic.type]) < _COMPARED:
            fed[topic.type].append(topic)
    for topic in lonely:
        if not topic.sources and not topic.sinks:
            yield report(
                codes.UNUSED_TOPIC,
                f"nobody publishes or subscribes to '{topic.name}'",
                topic.span,
                hint="remove the declaration, or connect ports to it",
            )
        elif not topic.sources:
            other = next((t for t in fed[topic.type] if partners.can_join(t, topic)), None)
            yield _one_sided(
                codes.NO_PUBLISHER,
                f"nobody publishes '{topic.name}', "
                f"which {_names(topic.sinks)} subscribe{_s(topic.sinks)} to",
                topic,
                topic.sinks,
                f"'{other.name}' has the same type and nobody subscribes to it; " if other else "",
            )
        elif not topic.sinks and not is_shown_only(topic.type):
            yield _one_sided(
                codes.NO_SUBSCRIBER,
                f"nobody subscribes to '{topic.name}', which {_names(topic.sources)} "
                f"publish{'es' if len(topic.sources) == 1 else ''}",
                topic,
                topic.sources,
                _subscribed_instead(topic, partners),
            )


def _subscribed_instead(topic: _Channel, partners: Partners[_Channel]) -> str:
    """Return the beginning of a hint that names the topics that a published one may have to be."""
    matches = partners.read_for(topic, lambda read: not read.undeclared)
    hint = did_you_mean(each.name for each in matches)
    return f"{hint} There are subscriptions of its type; " if hint else ""


def _one_sided(code: Code, message: str, topic: _Channel, ends: list[End], hint: str) -> Diagnostic:
    direction = "fed from" if code is codes.NO_PUBLISHER else "read"
    return report(
        code,
        message,
        topic.span,
        hint=f"{hint}if it is {direction} outside the model, declare it 'external topic'",
        related=tuple(Related(end.span, f"connected here: {end.name}") for end in ends[:3]),
    )


def _names(ends: list[End]) -> str:
    """Name up to two ends and count the rest."""
    shown = [end.node.full_name for end in ends[:2]]
    if len(ends) > 2:
        return f"{', '.join(shown)} and {len(ends) - 2} more"
    return " and ".join(shown)


def _s(ends: list[End]) -> str:
    return "s" if len(ends) == 1 else ""


def _missing_server(channel: _Channel) -> Iterator[Diagnostic]:
    if channel.sinks or channel.open:
        return
    for end in channel.sources:
        if end.wired:
            yield report(
                codes.SERVICE_WITHOUT_SERVER,
                f"no node serves the {channel.vertex[0]} '{channel.name}' that {end.name} calls",
                end.span,
                hint="connect a server to that name; if it is outside the model, "
                f"declare 'external topic {channel.name}'",
                related=(Related(end.port.port.span, "the client is declared here"),),
            )


# Misspellings -----------------------------------------------------------------------------------


def _misspelt(
    topics: Iterable[_Channel], partners: Partners[_Channel], rules: RulesEnds
) -> list[tuple[_Channel, list[_Channel]]]:
    """Pair topics that are only subscribed with the published ones that they probably are.

    Where names of one type nearly match, it is likelier that one of them is wrong than that a
    connection is missing. That a safety rule reads one of them makes it no better; what the safety
    node or a gate publishes, or a gate joins, lacks nothing.
    """
    found = []
    for read in topics:
        if read.open or read.undeclared or read.sources or not read.sinks:
            continue
        if read.name in rules.fed:
            continue

        def allow(fed: _Channel, read: _Channel = read) -> bool:
            return not fed.undeclared and (fed.name, read.name) not in rules.gated

        matches = partners.fed_for(read, allow)
        if matches:
            found.append((read, matches))
    return found


def _misspelling(read: _Channel, matches: list[_Channel]) -> Diagnostic:
    fed = matches[0]
    *others, last = [f"'{each.name}'" for each in matches]
    names = f"{', '.join(others)} or {last}" if others else last
    kind = fed.type.short
    if fed.sinks:
        message = f"nobody publishes '{read.name}', but '{fed.name}' with its type, {kind}"
        hint = f"connect {_names(read.sinks)} to {names}"
    else:
        message = f"'{read.name}' is only subscribed and '{fed.name}' only published, both {kind}"
        hint = f"connect {_names(read.sinks)} to {names}, or the other way round"
    return report(
        codes.LIKELY_MISSPELLING,
        f"{message}: probably one topic",
        read.span,
        hint=hint,
        related=(
            Related(fed.span, f"'{fed.name}'"),
            Related(fed.sources[0].span, f"published by {fed.sources[0].name}"),
            Related(read.sinks[0].span, f"subscribed by {read.sinks[0].name}"),
        ),
    )


# Unwired ports ----------------------------------------------------------------------------------


def _unwired(flat: FlatSystem, by_vertex: dict[Vertex, _Channel]) -> Iterator[Diagnostic]:
    for node in flat.nodes:
        if _has_unknown_wirings(node):
            continue  # one of those may be meant for the port
        for port in node.ports:
            if port.wiring is not None or port.port.kind not in _SEEKS_A_PARTNER:
                continue
            is_topic = CHANNEL[port.port.kind] == "topic"
            if is_topic and standard_topic(port.topic, port.port.type) is not None:
                continue  # its other ends are in libraries and tools
            word = _SEEKS_A_PARTNER[port.port.kind]
            yield report(
                codes.UNWIRED_PORT,
                f"{word} '{port.port.name}' of '{node.instance.name}' is not connected",
                node.instance.name_span,
                hint=_unwired_hint(_in_wirings(node, port), port.topic, word, by_vertex),
                related=(Related(port.port.span, f"the {word} is declared here"),),
            )


def _in_wirings(node: FlatNode, port: FlatPort) -> str:
    """Return how a ``connect`` names a port: with its kind where others have its name."""
    alike = sum(other.port.name == port.port.name for other in node.ports)
    return f"{port.port.kind.word} {port.port.name}" if alike > 1 else port.port.name


def _has_unknown_wirings(node: FlatNode) -> bool:
    known = sum(port.wiring is not None for port in node.ports) + len(node.untyped)
    return len(node.instance.wirings) > known


def _unwired_hint(name: str, topic: str, word: str, by_vertex: dict[Vertex, _Channel]) -> str:
    channel = by_vertex.get(("topic", topic))
    if channel is not None and channel.declared is not None:
        return f"'{topic}' is declared and has its name: add 'connect {name} to {topic}'"
    what = "talks on" if word in ("publisher", "subscription") else "calls"
    return f"it {what} its own name, '{topic}', unless a 'connect {name} to …' says otherwise"
