"""Faults planted into sound systems, one at a time: what is planted where, and whether it is found.

Five kinds, each at every place where it applies. A *place* is an end of a topic, service or action:
a port of a node of the system.

renamed
    A ``connect`` goes to a name with a slip or another word, to no topic or to one that is declared
    for it; or the port has another name in the node's description, unless it has its name from a
    parameter. Ends whose other ends are all outside the model are left out: no model says that
    those have another name.
wrong type
    The port has another type in the node's description, where another end, or the declaration, has
    the right one; or the declaration has another type.
wrong QoS
    One policy of the port is changed so that by the request-offered rules it matches one end on the
    other side no more: reliability, durability, deadline, liveliness, lease; for services and
    actions, reliability.
missing server
    Of a service or action that a node is connected to as a client, the port, or the node, or of a
    managed node the word ``lifecycle`` is taken away.
swapped ends
    Two connections of a node exchange their targets: a subscription and a publisher of one type, or
    two ports of one kind and type; or a port is declared on the other side. It is planted where the
    model shows it: a topic loses one of its sides, or one of the two ports has a word that only its
    own target has. Elsewhere each topic has both sides afterwards, of one type and a matching QoS,
    and nothing in the model contradicts it.

A fault is found if there is a finding that was not there before, and it names the end: its topic,
old or new, its port or its node; or it points to the place of the edit.
"""

from __future__ import annotations

import dataclasses
import itertools
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from deros.diagnostics import Diagnostic, Span
from deros.interfaces.standard_topics import is_operated, is_shown_only, standard_topic
from deros.interfaces.types import InterfaceType
from deros.models.node import PortKind
from deros.models.qos import Policies, policies, shortfalls
from deros.models.system import Wiring
from deros.names.graph_names import resolve_name
from deros.systems.flat import FlatSystem, FlatTopic
from deros.validators.wiring.graph import (
    End,
    Vertex,
    channels,
    publishers,
    subscribers,
    wiring_graph,
)
from tests.support import real_systems

KINDS = ("renamed", "wrong type", "wrong QoS", "missing server", "swapped ends")

_WORD = re.compile(r"[\w/~]+")
_DIRECTIONS = {
    PortKind.PUBLISHER: PortKind.SUBSCRIPTION,
    PortKind.SUBSCRIPTION: PortKind.PUBLISHER,
}
_OTHER_TYPES = {
    "geometry_msgs.Twist": "geometry_msgs.TwistStamped",
    "geometry_msgs.TwistStamped": "geometry_msgs.Twist",
    "geometry_msgs.PoseStamped": "geometry_msgs.PoseWithCovarianceStamped",
    "geometry_msgs.PoseWithCovarianceStamped": "geometry_msgs.PoseStamped",
    "sensor_msgs.LaserScan": "sensor_msgs.PointCloud2",
    "sensor_msgs.PointCloud2": "sensor_msgs.LaserScan",
    "sensor_msgs.Image": "sensor_msgs.CompressedImage",
    "sensor_msgs.CompressedImage": "sensor_msgs.Image",
    "std_msgs.Bool": "std_msgs.Int32",
    "std_srvs.Trigger": "std_srvs.Empty",
    "std_srvs.Empty": "std_srvs.Trigger",
}
"""What is easily taken for a type; others become the default of their kind."""

_DEFAULT_TYPES = {
    "msg": "std_msgs.String",
    "srv": "std_srvs.Trigger",
    "action": "example_interfaces.Fibonacci",
}


@dataclass(frozen=True)
class Edit:
    """A text in the place of a span."""

    span: Span
    text: str


@dataclass(frozen=True)
class Fault:
    """One fault in one place.

    Attributes:
        system: the name of the system.
        kind: one of :data:`KINDS`.
        place: what was changed, and how.
        names: of the end: topic, service or action, port, node.
        edits: what plants it.
    """

    system: str
    kind: str
    place: str
    names: frozenset[str]
    edits: tuple[Edit, ...] = field(repr=False)

    def texts(self) -> dict[str, str]:
        """Return the changed files, by path."""
        files: dict[str, list[Edit]] = {}
        for each in self.edits:
            files.setdefault(each.span.file, []).append(each)
        return {path: _edited(edits) for path, edits in files.items()}


@dataclass(frozen=True)
class _Place:
    """An end, with the other ends of its topic, service or action, and its declaration."""

    end: End
    vertex: Vertex
    same: tuple[End, ...]
    opposite: tuple[End, ...]
    declared: FlatTopic | None

    @property
    def others(self) -> tuple[End, ...]:
        """The other ends whose type and QoS are written elsewhere."""
        port = self.end.port.port
        return tuple(each for each in (*self.same, *self.opposite) if each.port.port is not port)

    @property
    def is_standard(self) -> bool:
        """Whether libraries and tools are ends of the topic."""
        kind = self.end.type
        return self.vertex[0] == "topic" and standard_topic(self.vertex[1], kind) is not None


def faults(system: str) -> Iterator[Fault]:
    """Yield every fault that is planted into a system, each once for the place where it is written.

    Args:
        system: the name of the system.
    """
    flat = real_systems.flat_system(system)
    places = list(_places(flat))
    seen: set[tuple[Edit, ...]] = set()
    for plant in (_renamed, _wrong_types, _wrong_qos, _missing_servers, _swapped):
        for place, kind, how, edits, names in plant(flat, places):
            if edits in seen or not all(_is_written(each.span) for each in edits):
                continue
            seen.add(edits)
            end = place.end
            known = {
                end.node.full_name,
                end.node.instance.name,
                end.port.port.name,
                place.vertex[1],
            }
            yield Fault(system, kind, f"{end.name}: {how}", frozenset(known | set(names)), edits)


def is_found(fault: Fault, before: Counter[tuple[str, str]]) -> Diagnostic | None:
    """Return a new finding that names a fault or points to it, an error if there is one.

    Args:
        fault: what is planted.
        before: code and message of the findings of the sound system.
    """
    left = Counter(before)
    found: list[Diagnostic] = []
    edited = {(each.span.file, each.span.line) for each in fault.edits}
    for finding in real_systems.findings(fault.system, fault.texts()):
        key = (finding.code.name, finding.message)
        if left[key]:
            left[key] -= 1
            continue
        words = set(_WORD.findall(f"{finding.message} {finding.hint}"))
        spans = [finding.span, *(each.span for each in finding.related)]
        if words & fault.names or edited & {(span.file, span.line) for span in spans}:
            found.append(finding)
    return min(found, key=lambda each: not each.is_error, default=None)


def known_findings(system: str) -> Counter[tuple[str, str]]:
    """Return code and message of the findings of a sound system."""
    return Counter((each.code.name, each.message) for each in real_systems.findings(system))


# Places -------------------------------------------------------------------------------------------

_Planted = tuple[_Place, str, str, tuple[Edit, ...], tuple[str, ...]]


def _places(flat: FlatSystem) -> Iterator[_Place]:
    graph = wiring_graph(flat)
    for vertex in channels(graph):
        sides = publishers(graph, vertex), subscribers(graph, vertex)
        declared = flat.topic(vertex[1]) if vertex[0] == "topic" else None
        for own, opposite in (sides, sides[::-1]):
            for end in own:
                same = tuple(each for each in own if each is not end)
                yield _Place(end, vertex, same, tuple(opposite), declared)


def _is_written(span: Span) -> bool:
    """Tell whether a text stands in a file, and was not made from safety rules."""
    return Path(span.file).suffix in (".rnd", ".system")


def _edited(edits: Sequence[Edit]) -> str:
    text = edits[0].span.source.text
    for each in sorted(edits, key=lambda edit: (edit.span.start, edit.span.end), reverse=True):
        text = text[: each.span.start] + each.text + text[each.span.end :]
    return text


def _before(span: Span) -> Span:
    return Span(span.source, span.start, span.start)


def _after(span: Span) -> Span:
    return Span(span.source, span.end, span.end)


# Names --------------------------------------------------------------------------------------------


def _misspelt(name: str) -> str:
    """Return a name with two letters of its last word swapped; a short one with one left out."""
    head, slash, last = name.rpartition("/")
    for at in range(len(last) // 2, len(last) - 1):
        if last[at] != last[at + 1] and last[at : at + 2].isalpha():
            return f"{head}{slash}{last[:at]}{last[at + 1]}{last[at]}{last[at + 2 :]}"
    return f"{name}x"


def _renamed(flat: FlatSystem, places: Sequence[_Place]) -> Iterator[_Planted]:
    taken = {place.vertex[1] for place in places} | {topic.name for topic in flat.topics}
    for place in places:
        port, wiring = place.end.port.port, place.end.port.wiring
        if wiring is not None:
            for changed in (_misspelt(wiring.target), f"{wiring.target}_v2"):
                if _full(place, changed) not in taken:
                    yield from _connected_elsewhere(flat, place, wiring, changed)
        elif not place.opposite or place.is_standard:
            continue
        if _is_named_by_parameter(place):
            continue
        changed = _misspelt(port.name)
        names = (changed, _full(place, changed))
        yield place, "renamed", "in the node", (Edit(port.name_span, changed),), names


def _is_named_by_parameter(place: _Place) -> bool:
    """Tell whether a connection reaches a port through its parameter, whatever it is called."""
    port, node_type = place.end.port.port, place.end.node.type
    if port.via is None or place.end.port.wiring is None or node_type is None:
        return False
    name = place.end.port.wiring.port
    return name == port.via or any(
        each.via == port.via and each is not port for each in node_type.ports_named(name)
    )


def _full(place: _Place, name: str) -> str:
    return resolve_name(name, place.end.node.namespace, place.end.node.instance.name)


def _connected_elsewhere(
    flat: FlatSystem, place: _Place, wiring: Wiring, changed: str
) -> Iterator[_Planted]:
    edit = Edit(wiring.target_span, changed)
    names = (changed, _full(place, changed))
    yield place, "renamed", f"connected to '{changed}'", (edit,), names
    kind = place.end.type
    if place.vertex[0] != "topic" or is_shown_only(kind) or is_operated(kind):
        return
    for topic in flat.topics:
        declaration = topic.declaration
        if topic.name == place.vertex[1] and declaration.span.source is wiring.span.source:
            # The last words are the same, so that both become the same name.
            last = changed.rpartition("/")[2]
            text = f"topic {declaration.name.rpartition('/')[0]}/{last}"
            text = text if "/" in declaration.name else f"topic {last}"
            edits = (Edit(_before(declaration.span), f"{text}\n  "), edit)
            yield place, "renamed", f"connected to '{changed}', which is declared", edits, names
            return


# Types --------------------------------------------------------------------------------------------


def _other_type(kind: InterfaceType) -> str:
    default = _DEFAULT_TYPES[kind.kind]
    if kind.short == default:
        default = "std_msgs.Int32"
    return _OTHER_TYPES.get(kind.short, default)


def _wrong_types(_: FlatSystem, places: Sequence[_Place]) -> Iterator[_Planted]:
    for place in places:
        port, declared = place.end.port.port, place.declared
        is_pinned = declared is not None and declared.declaration.type is not None
        if is_pinned or place.others:
            other = _other_type(port.type)
            edit = Edit(port.type_span, other)
            yield place, "wrong type", f"{other} in the node", (edit,), ()
        if is_pinned and declared is not None and declared.declaration.type_span is not None:
            other = _other_type(port.type)
            edit = Edit(declared.declaration.type_span, other)
            yield place, "wrong type", f"{other} in the declaration", (edit,), ()


# QoS ----------------------------------------------------------------------------------------------

_SECOND = 10**9
_CHANGES: dict[bool, tuple[tuple[dict[str, str | int], str], ...]] = {
    True: (
        ({"reliability": "best_effort"}, "best_effort"),
        ({"durability": "volatile"}, "volatile"),
    ),
    False: (
        ({"reliability": "reliable"}, "reliable"),
        ({"durability": "transient_local"}, "transient_local"),
        ({"deadline": _SECOND}, "deadline 1 sec"),
        ({"liveliness": "manual_by_topic"}, "liveliness manual_by_topic"),
        ({"liveliness": "automatic", "lease": _SECOND}, "liveliness automatic lease 1 sec"),
    ),
}
"""What makes a publisher (or client, or server) offer less, and a subscription ask for more."""

_REPLACED = ({"reliable", "best_effort"}, {"volatile", "transient_local"})


def _wrong_qos(_: FlatSystem, places: Sequence[_Place]) -> Iterator[_Planted]:
    for place in places:
        end = place.end
        port, own = end.port.port, policies(end.qos)
        offers = port.kind is not PortKind.SUBSCRIPTION
        changes = _CHANGES[offers]
        if place.vertex[0] != "topic":
            changes = changes[:1]
        for change, words in changes:
            changed = dataclasses.replace(own, **change)  # type: ignore[arg-type]
            partners = [policies(each.qos) for each in place.opposite if each.port.port is not port]
            if any(
                not _apart(offers, own, other) and _apart(offers, changed, other)
                for other in partners
            ):
                yield place, "wrong QoS", words, (_with_qos(end, words),), ()


def _apart(offers: bool, own: Policies, other: Policies) -> bool:
    found = shortfalls(own, other) if offers else shortfalls(other, own)
    return any(each.certain for each in found)


def _with_qos(end: End, words: str) -> Edit:
    """Return the edit that gives a port other words for one policy."""
    port = end.port.port
    if port.qos is None or port.qos.span is None:
        return Edit(_after(port.type_span), f" qos {words}")
    kept = port.qos.span.text.split()
    for pair in _REPLACED:
        if words in pair:
            kept = [word for word in kept if word not in pair]
    return Edit(port.qos.span, " ".join([*kept, words]))


# Servers ------------------------------------------------------------------------------------------


def _missing_servers(flat: FlatSystem, places: Sequence[_Place]) -> Iterator[_Planted]:
    nodes = {node.full_name: node for node in flat.nodes}
    for place in places:
        client = place.end
        if client.port.port.kind not in (PortKind.CLIENT, PortKind.ACTION_CLIENT):
            continue
        if not client.wired:
            continue
        owner = nodes.get(place.vertex[1].rpartition("/")[0])
        if not place.opposite and owner is not None and owner.type is not None:
            gone = Edit(owner.instance.span, "")
            yield place, "missing server", f"without {owner.full_name}", (gone,), ()
            word = re.search(r"^lifecycle$", owner.type.source.text, re.MULTILINE)
            assert word is not None
            gone = Edit(Span(owner.type.source, word.start(), word.end()), "")
            yield place, "missing server", f"{owner.full_name} is not managed", (gone,), ()
        if len(place.opposite) == 1:
            (server,) = place.opposite
            gone = Edit(server.port.port.span, "")
            yield place, "missing server", f"{server.name} serves it no more", (gone,), ()
            gone = Edit(server.node.instance.span, "")
            yield place, "missing server", f"without {server.node.full_name}", (gone,), ()


# Swapped ends -------------------------------------------------------------------------------------


def _swapped(_: FlatSystem, places: Sequence[_Place]) -> Iterator[_Planted]:
    for first, second in _of_one_node(places):
        one, other = first.end.port, second.end.port
        assert one.wiring is not None
        assert other.wiring is not None
        if one.wiring is other.wiring or first.vertex == second.vertex:
            continue
        loses = one.port.kind is not other.port.kind and any(map(_is_needed, (first, second)))
        if loses or _names_tell(first, second) or _names_tell(second, first):
            edits = (
                Edit(one.wiring.target_span, other.wiring.target),
                Edit(other.wiring.target_span, one.wiring.target),
            )
            how = f"connected to '{other.topic}', and {other.port.name} to '{one.topic}'"
            yield first, "swapped ends", how, edits, (second.vertex[1], other.port.name)
    for place in places:
        port = place.end.port.port
        if port.kind in _DIRECTIONS and place.end.wired and _is_needed(place):
            yield place, "swapped ends", "on the other side", _turned_round(place), ()


def _names_tell(place: _Place, other: _Place) -> bool:
    """Tell whether a port has a word, which the other has not, of its own target alone."""
    words = [
        set(re.split(r"[^a-z0-9]+", text.lower()))
        for text in (place.end.port.port.name, other.end.port.port.name, *_targets(place, other))
    ]
    return bool((words[0] - words[1]) & (words[2] - words[3]))


def _targets(*places: _Place) -> Iterator[str]:
    return (place.vertex[1] for place in places)


def _of_one_node(places: Sequence[_Place]) -> Iterator[tuple[_Place, _Place]]:
    """Yield the pairs of connected ports of a node that could be taken for each other."""
    by_node: dict[tuple[str, InterfaceType], list[_Place]] = {}
    for place in places:
        if place.end.wired:
            by_node.setdefault((place.end.node.full_name, place.end.type), []).append(place)
    for alike in by_node.values():
        for first, second in itertools.combinations(alike, 2):
            kinds = first.end.port.port.kind, second.end.port.port.kind
            if kinds[0] is kinds[1] or _DIRECTIONS.get(kinds[0]) is kinds[1]:
                yield first, second


def _is_needed(place: _Place) -> bool:
    """Tell whether a topic would lack one of its sides without an end that it has."""
    is_external = place.declared is not None and place.declared.declaration.external
    return not place.same and bool(place.opposite) and not is_external and not place.is_standard


def _turned_round(place: _Place) -> tuple[Edit, ...]:
    """Return the edits that declare a port among those of the other direction."""
    port, node_type = place.end.port.port, place.end.node.type
    assert node_type is not None
    there = next(node_type.ports_of(_DIRECTIONS[port.kind]), None)
    if there is None:
        line = f"\n\n{_DIRECTIONS[port.kind].value}\n  {port.span.text}\n"
        end = Span(port.span.source, len(port.span.source.text), len(port.span.source.text))
        return Edit(port.span, ""), Edit(end, line)
    return Edit(port.span, ""), Edit(_after(there.span), f"\n  {port.span.text}")
