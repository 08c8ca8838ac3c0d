"""Changes of the topics, services and actions of a system, by their resolved names."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from deros.diagnostics import Span
from deros.diff.changes import Aspect, Change, PartKind, Verdict, compare
from deros.diff.nodes import field_units, units_break, units_text
from deros.diff.qos import ALL_POLICIES, asks_for_more, either_way, offers_less
from deros.diff.symbolic import Version, Way, in_ways, when_of
from deros.diff.texts import joined, yes_or_no
from deros.models.node import PortKind
from deros.models.qos import Policies, Policy, pinned_policies, policies, words
from deros.models.system import Topic
from deros.systems.flat import FlatNode

_CHANNELS = {
    PortKind.PUBLISHER: ("topic", True),
    PortKind.SUBSCRIPTION: ("topic", False),
    PortKind.SERVICE: ("service", True),
    PortKind.CLIENT: ("service", False),
    PortKind.ACTION: ("action", True),
    PortKind.ACTION_CLIENT: ("action", False),
}
"""The kind of channel that a port is an end of, and whether it is one that others rely on."""

_ENDS = {
    "topic": ("publishers", "subscribers"),
    "service": ("servers", "clients"),
    "action": ("servers", "clients"),
}


@dataclass(frozen=True, slots=True)
class End:
    """A port of a node on a channel, both by name."""

    node: str
    port: str
    type: str
    qos: Policies


@dataclass(slots=True)
class Channel:
    """A topic, service or action of a version.

    Attributes:
        kind: which of these.
        name: in the graph.
        span: where it is declared, or else the node of its first end.
        offers: the ends that others rely on: publishers, servers.
        uses: the other ends.
        offering: those as texts, with their conditions.
        using: the same of the others.
        declared: what its declaration says.
    """

    kind: str
    name: str
    span: Span
    offers: dict[tuple[str, str], End] = field(default_factory=dict)
    uses: dict[tuple[str, str], End] = field(default_factory=dict)
    offering: tuple[str, ...] = ()
    using: tuple[str, ...] = ()
    declared: tuple[Topic, ...] = ()

    @property
    def types(self) -> tuple[str, ...]:
        """The types of its ends, and the one that is pinned."""
        pinned = (each.type.short for each in self.declared if each.type is not None)
        ends = (each.type for each in (*self.offers.values(), *self.uses.values()))
        return tuple(sorted({*pinned, *ends}))


def channels_of(version: Version) -> list[Channel]:
    """Return the channels of a version: those declared, then those of ports, in the order met."""
    found: dict[tuple[str, str], Channel] = {}
    ways: dict[tuple[str, str, bool], list[Way]] = {}
    nodes: dict[str, list[frozenset[str]]] = {}
    for topic in version.topics:
        name, declaration = version.name(topic.topic.name), topic.topic.declaration
        declared = Channel("topic", name, declaration.name_span)
        declared = found.setdefault(("topic", name), declared)
        declared.declared = (*declared.declared, declaration)
    for each in version.programs:
        if not isinstance(each.node, FlatNode):
            continue
        node, when = version.name(each.node.full_name), when_of(each.when)
        nodes.setdefault(node, []).append(when)
        for port in each.node.ports:
            kind, is_offer = _CHANNELS[port.port.kind]
            name = version.name(port.topic)
            channel = Channel(kind, name, each.node.instance.name_span)
            channel = found.setdefault((kind, name), channel)
            end = End(node, port.port.name, port.port.type.short, policies(port.port.qos))
            (channel.offers if is_offer else channel.uses)[node, port.port.name] = end
            ways.setdefault((kind, name, is_offer), []).append(Way(node, when))
    for (kind, name, is_offer), ends in ways.items():
        channel = found[kind, name]
        by_node: dict[str, list[Way]] = {}
        for way in ends:
            by_node.setdefault(way.value, []).append(way)
        texts = tuple(
            text for node in sorted(by_node) for text in in_ways(by_node[node], nodes[node])
        )
        if is_offer:
            channel.offering = texts
        else:
            channel.using = texts
    return list(found.values())


# Verdicts ---------------------------------------------------------------------------------------


def _last_offer_is_gone(old: tuple[str, ...], new: tuple[str, ...]) -> str:
    return "none is left: those who rely on it" if old and not new else ""


def _last_use_is_gone(channel: Channel) -> Verdict:
    """Only a channel that the system merely uses has its other ends elsewhere."""

    def breaks(old: tuple[str, ...], new: tuple[str, ...]) -> str:
        if channel.kind != "topic" or channel.offers or not old or new:
            return ""
        return "none is left: those outside of the system who publish it"

    return breaks


def _removed(channel: Channel) -> str:
    if channel.offers:
        return "those who rely on it find nothing to connect to"
    if channel.kind == "topic" and channel.uses:
        return "those outside of the system who publish it"
    return ""


_Ends = Callable[["Channel"], dict[tuple[str, str], "End"]]

_SIDES: tuple[tuple[str, _Ends, Callable[[Policy], Verdict]], ...] = (
    ("offered", lambda c: c.offers, offers_less),
    ("requested", lambda c: c.uses, asks_for_more),
)


def _qos_aspects(old: Channel, new: Channel) -> Iterator[Aspect[Channel]]:
    for word, ends, topic_verdict in _SIDES:
        verdict = topic_verdict if old.kind == "topic" else either_way
        shared = sorted(ends(old).keys() & ends(new).keys())
        if ends(old) and ends(new):
            for policy in ALL_POLICIES:
                yield _qos_aspect(word, policy, ends, shared, verdict(policy))


def _qos_aspect(
    word: str,
    policy: Policy,
    ends: _Ends,
    shared: Sequence[tuple[str, str]],
    verdict: Verdict,
) -> Aspect[Channel]:
    """Compare a policy of the ends that both versions have; without any, of all ends."""

    def read(channel: Channel) -> tuple[Any, ...]:
        found = ends(channel)
        if shared:
            return tuple(getattr(found[key].qos, policy) for key in shared)
        return tuple(sorted({getattr(each.qos, policy) for each in found.values()}, key=repr))

    def breaks(old: tuple[Any, ...], new: tuple[Any, ...]) -> str:
        pairs: Iterable[tuple[Any, Any]] = zip(old, new, strict=True)
        if not shared:
            pairs = ((before, after) for before in old for after in new)
        return next(filter(None, (verdict(*pair) for pair in pairs if pair[0] != pair[1])), "")

    def say(values: tuple[Any, ...]) -> str:
        return joined(dict.fromkeys(words(policy, value) for value in values))

    return Aspect(f"{word} {policy}", read, breaks, say)


# Declarations -----------------------------------------------------------------------------------


def _pinned(channel: Channel) -> tuple[str, ...]:
    return tuple(
        joined(words(policy, value) for policy, value in sorted(pinned_policies(each.qos).items()))
        for each in channel.declared
        if each.qos is not None
    )


def _units(channel: Channel) -> tuple[tuple[str, Any, bool], ...]:
    return field_units(unit for topic in channel.declared for unit in topic.units)


def _aspects_of(old: Channel, new: Channel) -> Iterator[Aspect[Channel]]:
    offers, uses = _ENDS[old.kind]
    yield Aspect(offers, lambda c: c.offering, _last_offer_is_gone, joined)
    yield Aspect(uses, lambda c: c.using, _last_use_is_gone(old), joined)
    yield from _qos_aspects(old, new)


def _rates(channel: Channel) -> tuple[str, ...]:
    known = (each.rate_hz for each in channel.declared)
    return tuple(f"{each:g} Hz" for each in known if each is not None)


def _kind(word: str) -> PartKind[Channel]:
    return PartKind(
        word,
        lambda c: c.name,
        lambda c: c.span,
        (
            Aspect(
                "type",
                lambda c: c.types,
                lambda old, new: (
                    "" if set(old) <= set(new) else "those who use another type are not connected"
                ),
                joined,
            ),
            Aspect("declared QoS", _pinned, say="; ".join),
            Aspect("units", _units, units_break, units_text),
            Aspect("external", lambda c: any(t.external for t in c.declared), say=yes_or_no),
            Aspect(
                "several publishers",
                lambda c: any(t.any_publishers for t in c.declared),
                say=yes_or_no,
            ),
            Aspect("rate", _rates, say=joined),
            Aspect("description", lambda c: tuple(t.description for t in c.declared), say=joined),
        ),
        lambda c: joined(c.types),
        removed=_removed,
        aspects_of=lambda old, new: tuple(_aspects_of(old, new)),
    )


def compare_channels(old: Version, new: Version) -> Iterator[Change]:
    """Yield the changes of topics, services and actions."""
    before, after = channels_of(old), channels_of(new)
    for word in _ENDS:
        yield from compare(
            _kind(word),
            [each for each in before if each.kind == word],
            [each for each in after if each.kind == word],
        )
