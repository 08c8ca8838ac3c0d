"""Checks of topics, services and actions: mismatched types and missing ends."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from deros import codes
from deros.diagnostics import Code, Diagnostic, Related, report
from deros.interfaces.standard_topics import is_operated, is_shown_only, wrong_type
from deros.names.names import did_you_mean
from deros.systems.flat import FlatSystem
from deros.validators.system.system_services import check_services
from deros.validators.system.topic_partners import Partners, Robots
from deros.validators.system.unwired_ports import check_unwired
from deros.validators.wiring.graph import End, Vertex, channels
from deros.validators.wiring.rules_ends import RulesEnds
from deros.validators.wiring.topic_channels import (
    Channel,
    channel_of,
    pinned_types,
    targets_of_unknown_ports,
)

if TYPE_CHECKING:
    import networkx as nx

    from deros.interfaces.types import InterfaceType

_COMPARED = 20
"""The number of unread topics of one type that are considered for an unpublished one."""


def check_topics(
    flat: FlatSystem, graph: nx.MultiDiGraph[Vertex], rules: RulesEnds
) -> Iterator[Diagnostic]:
    """Yield the findings about whole topics, services and actions, and about unwired ports.

    What ``rules`` read or feed lacks no end there, whether or not the system names the safety node.
    """
    guessed = targets_of_unknown_ports(flat)
    pins = pinned_types(flat)
    found = [channel_of(graph, vertex, guessed, pins) for vertex in channels(graph)]
    types = {each.name: each.type for each in found if each.sources or each.sinks}
    topics: list[Channel] = []
    for channel in found:
        unusual = list(_unusual_types(channel, types)) if channel.vertex[0] == "topic" else []
        yield from unusual or _types(channel)
        if channel.vertex[0] == "topic" and not unusual:
            topics.append(channel)
    robots = Robots(flat.nodes)
    partners = Partners((each for each in topics if each.sources or each.sinks), robots)
    pairs = _misspelt(topics, partners, rules)
    topics = [channel for channel in topics if not _ends_in_rules(channel, rules)]
    misspelt = {read.name for read, _ in pairs}
    for read, matches in pairs:
        own = _own_topics(read, matches, robots)
        yield _misspelling(read, matches, own)
        misspelt.update(
            each.name for each in (matches[0], *(topic for topic, _ in own)) if not each.sinks
        )
    yield from _missing_ends(topics, misspelt, partners)
    yield from check_services(flat, found)
    by_vertex = {channel.vertex: channel for channel in found}
    yield from check_unwired(flat, by_vertex, partners, rules.read.__contains__)


def _ends_in_rules(topic: Channel, rules: RulesEnds) -> bool:
    """Return whether the safety node is the missing end of a topic."""
    return (topic.name in rules.read and (bool(topic.sources) or not topic.sinks)) or (
        topic.name in rules.fed and not topic.sources
    )


# Types ------------------------------------------------------------------------------------------


def _types(channel: Channel) -> Iterator[Diagnostic]:
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


def _unusual_types(channel: Channel, types: Mapping[str, InterfaceType]) -> Iterator[Diagnostic]:
    """Yield ends of a standard topic with another type, unless a pin may override it."""
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
    topics: Iterable[Channel], misspelt: set[str], partners: Partners[Channel]
) -> Iterator[Diagnostic]:
    lonely = [t for t in topics if t.declared is not None and not t.open and t.name not in misspelt]
    fed: dict[InterfaceType, list[Channel]] = defaultdict(list)
    for topic in lonely:
        if topic.sources and not topic.sinks and len(fed[topic.type]) < _COMPARED:
            fed[topic.type].append(topic)
    for topic in lonely:
        if not topic.sources and not topic.sinks:
            yield report(
                codes.UNUSED_TOPIC,
                f"no node publishes or subscribes to '{topic.name}'",
                topic.span,
                hint="remove the declaration, or connect ports to it",
            )
        elif not topic.sources and not is_operated(topic.type):
            other = next((t for t in fed[topic.type] if partners.can_join(t, topic)), None)
            yield _one_sided(
                codes.NO_PUBLISHER,
                f"no node publishes '{topic.name}', "
                f"which {_names(topic.sinks)} subscribe{_s(topic.sinks)} to",
                topic,
                topic.sinks,
                f"'{other.name}' has the same type and no node subscribes to it; " if other else "",
            )
        elif topic.sources and _is_unread(topic) and not is_shown_only(topic.type):
            who = "no other node subscribes" if topic.sinks else "no node subscribes"
            yield _one_sided(
                codes.NO_SUBSCRIBER,
                f"{who} to '{topic.name}', which {_names(topic.sources)} "
                f"publish{'es' if len(topic.sources) == 1 else ''}",
                topic,
                topic.sources,
                _subscribed_instead(topic, partners),
            )


def _is_unread(topic: Channel) -> bool:
    """Return whether a published topic reaches no node but the one that publishes it."""
    names = {end.node.full_name for end in (*topic.sources, *topic.sinks)}
    return not topic.sinks or len(names) == 1


def _subscribed_instead(topic: Channel, partners: Partners[Channel]) -> str:
    """Return the beginning of a hint that names the topics that a published one may have to be."""
    matches = partners.read_for(topic, lambda read: not read.undeclared)
    hint = did_you_mean(each.name for each in matches)
    return f"{hint} There are subscriptions of its type; " if hint else ""


def _one_sided(code: Code, message: str, topic: Channel, ends: list[End], hint: str) -> Diagnostic:
    direction = "published" if code is codes.NO_PUBLISHER else "read"
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


# Misspellings -----------------------------------------------------------------------------------


def _misspelt(
    topics: Iterable[Channel], partners: Partners[Channel], rules: RulesEnds
) -> list[tuple[Channel, list[Channel]]]:
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

        def allow(fed: Channel, read: Channel = read) -> bool:
            return not fed.undeclared and (fed.name, read.name) not in rules.gated

        matches = partners.fed_for(read, allow)
        if matches:
            found.append((read, matches))
    return found


def _own_topics(
    read: Channel, matches: Iterable[Channel], robots: Robots
) -> list[tuple[Channel, list[End]]]:
    """Return the matches that lie in the repeated part of subscribing nodes, with these nodes.

    Where a topic is read in several parts, as ``/left`` and ``/right`` are, each has its own.
    """
    readers: dict[str | None, list[End]] = defaultdict(list)
    for end in read.sinks:
        readers[robots.of(end.node.full_name)].append(end)
    parts = [(match, robots.of(match.name)) for match in matches]
    return [(match, readers[part]) for match, part in parts if part in readers and part]


def _misspelling(
    read: Channel, matches: list[Channel], own: list[tuple[Channel, list[End]]]
) -> Diagnostic:
    fed = matches[0]
    *others, last = [f"'{each.name}'" for each in matches]
    names = f"{', '.join(others)} or {last}" if others else last
    connections = " and ".join(f"{_names(ends)} to '{topic.name}'" for topic, ends in own)
    connect = f"connect {connections or f'{_names(read.sinks)} to {names}'}"
    kind = fed.type.short
    if fed.sinks or fed.open:
        message = (
            f"no node publishes '{read.name}', but '{fed.name}' is published with the same type,"
            f" {kind}"
        )
        hint = connect
    else:
        message = (
            f"'{read.name}' is only subscribed to and '{fed.name}' only published, both {kind}"
        )
        hint = connect if len(own) > 1 else f"{connect}, or the other way round"
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
