"""Checks of QoS: every pair of ends of a topic, service or action, and every pin.

Ends with one profile are compared once, so that a topic of a thousand ends costs no more than its
few different profiles; what does not match is reported at the ends of the smaller side.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence, Set
from dataclasses import replace
from typing import TYPE_CHECKING

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.models.common import QosProfile
from deros.models.node import PortKind
from deros.models.qos import (
    ACTION_STATUS,
    Policy,
    Shortfall,
    is_met_by_default,
    pinned_policies,
    shortfalls,
)
from deros.systems.flat import FlatSystem, FlatTopic
from deros.validators.system.qos_messages import AnyEnd, Side, cure, difference, places
from deros.validators.system.qos_pins import check_pin
from deros.validators.wiring.graph import End, Vertex, channels, publishers, subscribers
from deros.validators.wiring.rules_ends import RulesEnd, RulesEnds
from deros.validators.wiring.system_safety import is_of_safety

if TYPE_CHECKING:
    import networkx as nx

_NOUNS = {
    "topic": ("publisher", "subscription"),
    "service": ("client", "server"),
    "action": ("action client", "action server"),
}


def check_qos(
    flat: FlatSystem, graph: nx.MultiDiGraph[Vertex], rules: RulesEnds
) -> Iterator[Diagnostic]:
    """Yield the pairs of ends that are not connected, and the ends that do not meet a pin.

    The safety nodes and gates of ``rules`` are ends, too, where the system does not name them.
    """
    pins = _pins(flat)
    implied: dict[str, list[RulesEnd]] = defaultdict(list)
    for end in rules.ends:
        implied[end.topic].append(end)
    for vertex in channels(graph):
        kind, name = vertex
        sources: list[AnyEnd] = list(publishers(graph, vertex))
        sinks: list[AnyEnd] = list(subscribers(graph, vertex))
        pinned: Iterable[Policy] = ()
        if kind == "topic":
            sources += _missing(implied.get(name, ()), PortKind.PUBLISHER, sources)
            sinks += _missing(implied.get(name, ()), PortKind.SUBSCRIPTION, sinks)
            pin = pins.get(name)
            if pin is not None:
                yield from check_pin(pin, sources, sinks)
                pinned = pinned_policies(pin.declaration.qos or QosProfile())
        if sources and sinks:
            yield from _pairs(kind, name, sources, sinks, frozenset(pinned))


def _pins(flat: FlatSystem) -> dict[str, FlatTopic]:
    """Return the declaration that pins each topic: the first, which is the outermost, that does."""
    pins: dict[str, FlatTopic] = {}
    for topic in flat.topics:
        if topic.declaration.qos is not None:
            pins.setdefault(topic.name, topic)
    return pins


def _missing(implied: Iterable[RulesEnd], kind: PortKind, ends: Sequence[AnyEnd]) -> list[RulesEnd]:
    """Return the ends of the rules' nodes, unless the system itself has such a node there."""
    if any(isinstance(end, End) and is_of_safety(end.node) for end in ends):
        return []
    return [end for end in implied if end.kind is kind]


def _pairs(
    kind: str,
    name: str,
    sources: Sequence[AnyEnd],
    sinks: Sequence[AnyEnd],
    pinned: Set[Policy],
) -> Iterator[Diagnostic]:
    """Compare each profile of one side with each of the other.

    Two ends that meet a pin match in what is pinned; one that does not is reported for itself.
    """
    source_noun, sink_noun = _NOUNS[kind]
    sides = [_sides(source_noun, sources), _sides(sink_noun, sinks)]
    for source in sides[0]:
        for sink in sides[1]:
            for offering, requesting, every in _compared(kind, source, sink):
                found = tuple(
                    each
                    for each in every
                    if each.policy not in pinned and not is_met_by_default(each)
                )
                if found:
                    yield from _reported(name, offering, requesting, found)
                    break  # what goes the other way would be said of the same two ends


def _sides(noun: str, ends: Iterable[AnyEnd]) -> list[Side]:
    by_profile: dict[tuple[QosProfile | None, bool], list[AnyEnd]] = {}
    for end in ends:
        by_profile.setdefault((end.qos, end.is_assumed), []).append(end)
    return [Side(noun, qos, assumed, group) for (qos, assumed), group in by_profile.items()]


def _compared(
    kind: str, source: Side, sink: Side
) -> Iterator[tuple[Side, Side, tuple[Shortfall, ...]]]:
    """Yield what is offered and requested between two sides, in each direction that there is.

    A client publishes requests and subscribes responses; an action's server also publishes a
    status, which is transient_local unless its description says otherwise.
    """
    ways = [(source, sink)]
    if kind != "topic":
        ways.append((sink, source))
    if kind == "action":
        status = (replace(each, default=ACTION_STATUS) for each in (sink, source))
        ways.append((next(status), next(status)))
    for offering, requesting in ways:
        yield offering, requesting, shortfalls(offering.policies, requesting.policies)


def _reported(
    name: str, offering: Side, requesting: Side, found: tuple[Shortfall, ...]
) -> Iterator[Diagnostic]:
    """Report the two sides at each end of the smaller one."""
    assumed = [side for side in (offering, requesting) if side.assumed]
    is_sure = not assumed and any(each.certain for each in found)
    code = codes.INCOMPATIBLE_QOS if is_sure else codes.UNCERTAIN_QOS
    verb = "does not connect" if is_sure else "may not connect"
    why = "; ".join(difference(each, offering, requesting) for each in found)
    hint = cure(found, offering, requesting)
    if assumed:
        hint = f"if {assumed[0].names} has another QoS than the default, state it; else {hint}"
    small, other = sorted((offering, requesting), key=lambda side: len(side.ends))
    for end in small.ends:
        one = replace(small, ends=(end,))
        first, second = (one, other) if small is offering else (other, one)
        own = places(one, f"the QoS of this {small.noun}")
        yield report(
            code,
            f"'{name}' {verb} {first.names} with {second.names}: {why}",
            end.span,
            hint,
            (
                *(each for each in own if each.span != end.span),
                *places(other, f"the QoS of the {other.noun}"),
            ),
        )
