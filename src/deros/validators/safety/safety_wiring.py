"""Checks of hand-wired safety nodes and gates against their rules.

Rules that use a system say what their safety node and gates are connected to in it. A node of the
system is theirs if its type has the name that the generator gives it, or if it has a heartbeat as
only safety nodes have and no other rules claim it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.node import NodeType, Port, PortKind
from deros.models.rules import Rules
from deros.models.system import System
from deros.names.graph_names import resolve_name
from deros.systems.flat import FlatNode, FlatPort, FlatSystem
from deros.systems.flatten import flatten, nodes_of_rules
from deros.systems.safety_instances import statements_of, topic_names
from deros.systems.safety_nodes import (
    CPP_SUFFIX,
    HEARTBEAT,
    HEARTBEAT_TYPE,
    is_gate_node,
    is_safety_node,
)
from deros.validators.wiring.graph import End, is_one_gate

_MOST_SHOWN = 4


# Assignment of nodes to rules ---------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class HandWired:
    """A hand-wired node of a system, and the node that its rules define."""

    node: FlatNode
    expected: NodeType
    rules: Rules

    @property
    def is_gate(self) -> bool:
        """Whether it is a gate; else it is the safety node."""
        return not is_safety_node(self.expected)


def hand_wired(flat: FlatSystem, programs: Iterable[Rules]) -> list[HandWired]:
    """Return the hand-wired safety nodes and gates of ``programs`` in ``flat``.

    Nodes of imported systems are among them where the rules use those systems.
    """
    found: list[HandWired] = []
    for system in _systems(programs):
        theirs = [rules for rules in programs if _uses(rules, system)]
        nodes = [
            node
            for node in flat.nodes
            if node.statement is None and node.instance.span.source is system.source
        ]
        found += _of_system(nodes, theirs)
    return found


def _systems(programs: Iterable[Rules]) -> Iterable[System]:
    used = (use.system for rules in programs for use in rules.uses)
    return {id(system): system for system in used if system is not None}.values()


def _uses(rules: Rules, system: System) -> bool:
    return any(use.system is system for use in rules.uses)


def _of_system(nodes: Sequence[FlatNode], programs: Sequence[Rules]) -> Iterator[HandWired]:
    safety = [node for node in nodes if node.type is not None and is_safety_node(node.type)]
    for rules in programs:
        types = nodes_of_rules(rules)
        named = [node for node in safety if _is_named(node, types[0])]
        if not named:
            named = _left(safety, programs, rules)
        package = _package(named)
        if package is not None:
            types = nodes_of_rules(rules, package=package)
        yield from (HandWired(node, types[0], rules) for node in named)
        for gate in types[1:]:
            yield from (HandWired(node, gate, rules) for node in nodes if _is_named(node, gate))


def _is_named(node: FlatNode, expected: NodeType) -> bool:
    return node.type is not None and node.type.name.removesuffix(CPP_SUFFIX) == expected.name


def _left(safety: Sequence[FlatNode], programs: Sequence[Rules], rules: Rules) -> list[FlatNode]:
    """Return the safety nodes that belong to ``rules`` by elimination."""
    names = {nodes_of_rules(each)[0].name: each for each in programs}
    others = [n for n in safety if n.type and n.type.name.removesuffix(CPP_SUFFIX) not in names]
    here = {n.type.name.removesuffix(CPP_SUFFIX) for n in safety if n.type}
    waiting = [each for name, each in names.items() if name not in here]
    one_type = len({id(node.type) for node in others}) == 1
    return others if one_type and len(waiting) == 1 and waiting[0] is rules else []


def _package(nodes: Sequence[FlatNode]) -> str | None:
    return next((node.type.package for node in nodes if node.type is not None), None)


# Checks -------------------------------------------------------------------------------------------


def check_hand_wired(flat: FlatSystem, programs: Sequence[Rules]) -> Iterator[Diagnostic]:
    """Yield each difference between nodes wired by hand and their rules.

    A system that ``flat`` only imports is checked on its own; only differences that are due to its
    place in ``flat`` are reported here.
    """
    found = hand_wired(flat, programs)
    own = [each for each in found if each.node.instance.span.source is flat.system.source]
    yield from _twice(own, flat)
    yield from _strangers(found, flat)
    yield from _descriptions(filter(_is_whole, own))
    found = [each for each in found if _is_whole(each)]
    known: set[tuple[int, Port]] = set()
    for system in _systems(programs):
        if system.source is not flat.system.source:
            alone = hand_wired(flatten(system), programs)
            known |= {_key(each, end) for each, end, *_ in _elsewhere(alone)}
    for each, end, topic, says in _elsewhere(found):
        if _key(each, end) not in known:
            yield _misconnected(each, end, topic, says)


def _is_whole(each: HandWired) -> bool:
    """Return whether everything that is compared could be parsed."""
    sources = [each.rules.source, each.node.instance.span.source]
    if each.node.type is not None:
        sources.append(each.node.type.source)
    return not any(source.lost for source in sources)


def _key(each: HandWired, end: FlatPort) -> tuple[int, Port]:
    return id(each.node.instance), end.port


def _twice(own: Sequence[HandWired], flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield a second node of the same rules: another instance, or a ``safety`` statement."""
    first: dict[tuple[int, str], Span] = {}
    stated = {
        id(node.statement.rules): node.statement.path_span
        for node in flat.nodes
        if node.statement is not None and node.statement.rules is not None
    }
    for each in own:
        span = each.node.instance.name_span
        key = (id(each.rules), each.expected.name)
        other = stated.get(id(each.rules)) or first.setdefault(key, span)
        if other is not span:
            what = "gate" if each.is_gate else "safety node"
            yield report(
                codes.RULES_RUN_TWICE,
                f"'{each.node.full_name}' is a second {what} of the rules '{each.rules.name}'",
                span,
                "keep one of the two; a second robot needs its own rules",
                (Related(other, "the other one"),),
            )


def _strangers(found: Sequence[HandWired], flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield hand-wired safety nodes whose rules are not loaded, so that they are unchecked."""
    known = {id(each.node) for each in found}
    for node in flat.nodes:
        if node.statement is not None or node.type is None or id(node) in known:
            continue
        if is_safety_node(node.type):
            yield report(
                codes.RULES_NOT_LOADED,
                f"the rules of the safety node '{node.full_name}' are not loaded, so its"
                " connections are not checked against them",
                node.instance.name_span,
                "check them with the system, 'deros check FILE.system FILE.deros', or write"
                " 'safety \"FILE.deros\"' in place of the node",
                (Related(node.type.name_span, "its description"),),
            )


# Descriptions -------------------------------------------------------------------------------------


def _descriptions(nodes: Iterable[HandWired]) -> Iterator[Diagnostic]:
    found = list(nodes)
    seen: set[int] = set()
    with_safety_node = {id(each.rules) for each in found if not each.is_gate}
    for each in found:
        actual = each.node.type
        if actual is None or id(actual) in seen:
            continue
        seen.add(id(actual))
        differences = list(_differences(each, actual, id(each.rules) in with_safety_node))
        if differences:
            shown = "; ".join(text for text, _ in differences[:_MOST_SHOWN])
            more = len(differences) - _MOST_SHOWN
            places = [span for _, span in differences if span is not None]
            target = "cpp" if actual.name.endswith(CPP_SUFFIX) else "python"
            yield report(
                codes.SAFETY_DESCRIPTION_DIFFERS,
                f"the description of '{actual.name}' does not match the rules '{each.rules.name}':"
                f" {shown}" + (f"; and {more} more" if more > 0 else ""),
                each.node.instance.type_span,
                f"generate it again from {each.rules.source.path} (--target {target}), and replace"
                f" {actual.source.path}",
                (
                    Related(actual.name_span, "described here"),
                    *(Related(span, "the rules") for span in places[:1]),
                ),
            )


def _differences(
    each: HandWired, actual: NodeType, with_safety_node: bool
) -> Iterator[tuple[str, Span | None]]:
    """Yield the differences of a description, each with its place in the rules if it has one."""
    expected = each.expected
    suffix = CPP_SUFFIX if actual.name.endswith(CPP_SUFFIX) else ""
    package = f"{expected.package.removesuffix(CPP_SUFFIX)}{suffix}"
    if with_safety_node and actual.package != package:
        yield f"it is in the package '{actual.package}', not '{package}'", None
    if actual.executable_name != actual.name:
        yield f"its program is '{actual.executable_name}', not '{actual.name}'", None
    described = {_port_key(port, each): port for port in actual.ports}
    for port in expected.ports:
        other = described.pop(_port_key(port, each), None)
        yield from ((text, port.span) for text in _port_differences(port, other))
    for port in described.values():
        yield f"it has {_shown(port)}, which is not in the rules", None
    parameters = {parameter.name: parameter for parameter in expected.parameters}
    for parameter in actual.parameters:
        wanted = parameters.get(parameter.name)
        if wanted is None:
            yield f"it has a parameter '{parameter.name}', which is not in the rules", None
        elif (wanted.type, wanted.default) != (parameter.type, parameter.default):
            yield f"parameter '{parameter.name}' has another type or default", None


def _port_key(port: Port, each: HandWired) -> tuple[PortKind, str]:
    """Return the identity of a port; the name of a heartbeat port depends on the safety node."""
    return port.kind, _role(port, each.is_gate)


def _role(port: Port, of_gate: bool) -> str:
    listens = of_gate and port.kind is PortKind.SUBSCRIPTION and port.type == HEARTBEAT_TYPE
    return HEARTBEAT if listens and port.name.endswith("/heartbeat") else port.name


def _port_differences(wanted: Port, actual: Port | None) -> Iterator[str]:
    if actual is None:
        yield f"it lacks {_shown(wanted)}"
        return
    if actual.type != wanted.type:
        yield f"{_shown(wanted)} is {actual.type.short}, not {wanted.type.short}"
    if actual.qos != wanted.qos:
        yield f"{_shown(wanted)} has another QoS"


def _shown(port: Port) -> str:
    word = {PortKind.PUBLISHER: "publisher", PortKind.SUBSCRIPTION: "subscription"}
    return f"the {word.get(port.kind, 'service')} '{port.name}'"


# Connections --------------------------------------------------------------------------------------


def _elsewhere(
    found: Sequence[HandWired],
) -> Iterator[tuple[HandWired, FlatPort, str, tuple[str, Span]]]:
    """Yield each port that is not on the topic of the rules, with that topic and its origin."""
    for each in found:
        names = topic_names(each.rules)
        for end in each.node.ports:
            wanted = _expected_port(each, end.port)
            if wanted is None:
                continue
            if wanted.name in names:
                topic = resolve_name(names[wanted.name], each.node.frame)
                says = _words(each, wanted, topic), wanted.span
            elif (beat := _heartbeat(each, wanted, found)) is not None:
                topic = beat.topic
                place = beat.wiring.target_span if beat.wiring else wanted.span
                says = f"the safety node publishes its heartbeat on '{topic}'", place
            else:
                continue
            if end.topic != topic:
                yield each, end, topic, says


def _expected_port(each: HandWired, port: Port) -> Port | None:
    key = _port_key(port, each)
    return next((p for p in each.expected.ports if _port_key(p, each) == key), None)


def _heartbeat(each: HandWired, port: Port, found: Sequence[HandWired]) -> FlatPort | None:
    """Return the heartbeat that a gate's port is for, if the system has that safety node."""
    if not each.is_gate or _role(port, of_gate=True) != HEARTBEAT:
        return None
    for other in found:
        if other.rules is each.rules and not other.is_gate and other.node.frame == each.node.frame:
            return next(end for end in other.node.ports if end.port.name == HEARTBEAT)
    return None


def _words(each: HandWired, port: Port, topic: str) -> str:
    publishes = port.kind is PortKind.PUBLISHER
    if not each.is_gate:
        reads = "call" if port.kind is PortKind.CLIENT else "read"
        return f"the rules {'publish' if publishes else reads} '{topic}'"
    if publishes:
        return f"the rules let the gate publish '{topic}'"
    is_source = port is next(each.expected.ports_of(PortKind.SUBSCRIPTION))
    return f"the gate of the rules {'reads commands from' if is_source else 'reads'} '{topic}'"


def _misconnected(each: HandWired, end: FlatPort, topic: str, says: tuple[str, Span]) -> Diagnostic:
    words, place = says
    wiring = end.wiring
    return report(
        codes.SAFETY_CONNECTED_DIFFERENTLY,
        f"{words}, but {End(each.node, end).name} is connected to '{end.topic}'",
        wiring.target_span if wiring is not None else each.node.instance.name_span,
        f"connect {end.port.name} to {topic}, or replace the nodes by a statement"
        f' safety "{each.rules.name}.deros"',
        (Related(place, "the topic is given here"),),
    )


def check_users(rules: Rules) -> Iterator[Diagnostic]:
    """Yield the systems beyond the first that start the safety node of the rules."""
    systems = list(_systems([rules]))
    first: Span | None = None
    for system in systems if len(systems) > 1 else ():
        places = [each.path_span for each in statements_of(system) if each.rules is rules]
        by_hand = hand_wired(flatten(system), [rules])
        places += [each.node.instance.name_span for each in by_hand if not each.is_gate]
        for place in places[:1]:
            if first is None:
                first = place
                continue
            yield report(
                codes.RULES_RUN_TWICE,
                f"the rules '{rules.name}' use several systems, two of which start their nodes",
                place,
                "start them from one of the systems",
                (Related(first, "the other one"),),
            )


# Gates that a second node goes past ---------------------------------------------------------------


def gates_of(flat: FlatSystem, programs: Iterable[Rules]) -> list[tuple[FlatNode, FlatPort]]:
    """Return the gates of a system, each with the publisher of its target."""
    ours = [each.node for each in hand_wired(flat, programs) if each.is_gate]
    ours += (node for node in flat.nodes if node.statement is not None)
    return [
        (node, end)
        for node in ours
        for end in node.ports
        if node.type is not None
        and end.port.kind is PortKind.PUBLISHER
        and is_gate_node(node.type.name, end.port.name)
    ]


def check_gate_targets(flat: FlatSystem, programs: Sequence[Rules]) -> Iterator[Diagnostic]:
    """Yield each publisher that bypasses a gate and is not found by the checks of the rules.

    They look at the systems that the rules use: another gate for the same topic is past the first
    one, and so is any node of a system that contains such a system.
    """
    is_used = any(_uses(rules, flat.system) for rules in programs)
    gates = gates_of(flat, programs)
    first: dict[str, tuple[FlatNode, FlatPort]] = {}
    for gate in gates:
        first.setdefault(gate[1].topic, gate)
    for node in flat.nodes:
        for end in node.ports:
            past = first.get(end.topic) if end.port.kind is PortKind.PUBLISHER else None
            if past is None or past[0] is node or is_one_gate(past[0], node):
                continue
            if is_used and not any(node is other for other, _ in gates):
                continue
            yield report(
                codes.GATE_BYPASSED,
                f"{End(node, end).name} bypasses the gate '{past[0].full_name}': it publishes"
                f" '{end.topic}' itself",
                End(node, end).span,
                "give it its own topic, by a relative name in the namespace of its system",
                (Related(End(*past).span, "the gate"),),
            )
