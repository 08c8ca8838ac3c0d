"""The ends of nodes: those that are missing or too many, their types, QoS, and connections."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import product

from deros.interfaces.standard_topics import standard_topic
from deros.interfaces.types import InterfaceType
from deros.live.ends import OF_NODES
from deros.live.snapshots import End as SeenEnd
from deros.live.snapshots import SeenNode
from deros.live.verify.differences import Difference, Kind
from deros.live.verify.expectation import ExpectedNode
from deros.models.common import QosProfile
from deros.models.node import PortKind
from deros.models.qos import Policies, Shortfall, policies, shortfalls, words
from deros.validators.wiring.graph import End


def subject_of(end: SeenEnd) -> str:
    """Return how an end is called beside its node, as ``publisher /scan``."""
    return f"{end.kind.word} {end.name}"


def end_differences(node: ExpectedNode, seen: SeenNode, *, is_whole: bool) -> Iterator[Difference]:
    """Yield what differs in the ends of a node.

    Args:
        node: what it has to be.
        seen: what it is.
        is_whole: whether it has all of its ends in its present state.
    """
    if node.ends is None:
        return
    there = {(each.kind, each.name): each for each in seen.ends}
    for (kind, name), meant in node.ends.items():
        found = there.get((kind, name))
        subject, span = f"{kind.word} {name}", meant[0].span
        types = sorted({str(each.type) for each in meant})
        if found is None:
            if is_whole:
                expected = " or ".join(types)
                yield Difference(
                    Kind.MISSING_END, node.full_name, subject, expected, "nothing", span=span
                )
        elif found.type not in types:
            yield Difference(
                Kind.WRONG_TYPE, node.full_name, subject, " or ".join(types), found.type, span=span
            )
        else:
            yield from _qos_differences(node, found, meant)
    for end in seen.ends:
        if not node.may_have(end.kind, end.name) and not _is_of_libraries(end):
            yield Difference(Kind.EXTRA_END, node.full_name, subject_of(end), seen=end.type)


def _is_of_libraries(end: SeenEnd) -> bool:
    """Return whether a library gives a node an end, which descriptions need not name.

    Such are topics of transforms, time and bonds, and clients for what all nodes serve: those of
    lifecycle managers and of programs that set parameters.
    """
    if end.kind is PortKind.CLIENT:
        known = ((f"/{name}", str(kind)) for name, kind in OF_NODES.items())
        return any(end.name.endswith(name) and end.type == kind for name, kind in known)
    if end.kind not in (PortKind.PUBLISHER, PortKind.SUBSCRIPTION):
        return False
    package, _, name = end.type.split("/")
    return standard_topic(end.name, InterfaceType(package, "msg", name)) is not None


def _qos_differences(
    node: ExpectedNode, seen: SeenEnd, meant: Sequence[End]
) -> Iterator[Difference]:
    """Yield that an end has another QoS than is described, if a connection may fail by it."""
    if seen.qos is None or any(each.is_assumed for each in meant):
        return
    for end in meant:
        wrong = [*_wrong(seen.kind, policies(seen.qos), policies(end.qos))]
        if not wrong:
            return
    expected, found = (", ".join(each) for each in zip(*wrong, strict=True))
    yield Difference(
        Kind.WRONG_QOS, node.full_name, subject_of(seen), expected, found, span=meant[0].qos_span
    )


def _wrong(kind: PortKind, seen: Policies, meant: Policies) -> Iterator[tuple[str, str]]:
    """Yield policies in words, as they are meant and as they are.

    A publisher may offer more than is described, and has the lifespan that is. A subscription that
    requests more is not connected with what offers just enough, and one that requests less misses
    what is described.
    """
    for each in _certain(seen, meant):
        yield words(each.policy, each.requested), words(each.policy, each.offered)
    if kind is PortKind.PUBLISHER and seen.lifespan != meant.lifespan:
        # No connection depends on it, but how old a sample may be that a late reader gets.
        yield words("lifespan", meant.lifespan), words("lifespan", seen.lifespan)
    if kind is PortKind.SUBSCRIPTION:
        for each in _certain(meant, seen):
            yield words(each.policy, each.offered), words(each.policy, each.requested)


def _certain(offered: Policies, requested: Policies) -> Iterator[Shortfall]:
    return (each for each in shortfalls(offered, requested) if each.certain)


def unconnected(nodes: Iterable[SeenNode], found: Iterable[Difference]) -> Iterator[Difference]:
    """Yield the subscriptions that get nothing from a publisher, because it offers too little.

    Args:
        nodes: all that are seen.
        found: what differs already: an end whose QoS is wrong is not named again.
    """
    wrong = {(each.node, each.subject) for each in found if each.kind is Kind.WRONG_QOS}
    topics: dict[str, dict[PortKind, list[tuple[str, SeenEnd]]]] = {}
    for node in nodes:
        for end in node.ends:
            if end.qos is not None and (node.full_name, subject_of(end)) not in wrong:
                kinds = topics.setdefault(end.name, {})
                kinds.setdefault(end.kind, []).append((node.full_name, end))
    for kinds in topics.values():
        pairs = product(kinds.get(PortKind.PUBLISHER, ()), kinds.get(PortKind.SUBSCRIPTION, ()))
        less: dict[tuple[str, SeenEnd], list[str]] = {}
        for (publisher, offer), (reader, request) in pairs:
            lacking = [*_lacking(offer.qos, request.qos)] if offer.type == request.type else []
            if lacking:
                less.setdefault((reader, request), []).append(f"{', '.join(lacking)} ({publisher})")
        for (reader, request), offers in less.items():
            seen = "; ".join(offers)
            yield Difference(Kind.NOT_CONNECTED, reader, subject_of(request), seen=seen)


def _lacking(offer: QosProfile | None, request: QosProfile | None) -> Iterator[str]:
    for each in _certain(policies(offer), policies(request)):
        yield f"{words(each.policy, each.offered)} instead of {words(each.policy, each.requested)}"
