"""The nodes of a ``safety`` statement: node types from rules as written, and their instances.

A rule's topic is named as the rules write it: an absolute name is kept, a relative one goes
under the namespace where the system that the rules use begins.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import PurePath
from typing import Any

from deros.diagnostics import Span
from deros.interfaces.types import InterfaceType
from deros.models.node import BUILT_IN_PARAMETERS, NodeType, Port
from deros.models.rules import (
    Action,
    Behaviour,
    Gate,
    GateLine,
    NamePath,
    Rules,
    TopicPath,
)
from deros.models.system import (
    NodeInstance,
    ParameterSetting,
    SafetyInstance,
    Subsystem,
    System,
    Wiring,
)
from deros.names.graph_names import resolve_name
from deros.systems.outlines import (
    GateOutline,
    InputOutline,
    LineOutline,
    Outline,
    ServiceOutline,
    StateOutline,
)
from deros.systems.safety_nodes import (
    CPP_SUFFIX,
    HEARTBEAT,
    OffersOf,
    cpp_twin,
    gate_node_types,
    heartbeat_port,
    node_name,
    package_name,
    safety_node_type,
)
from deros.systems.tunables import in_unit_of, tunables_of

TypeOf = Callable[[str], InterfaceType | None]
"""Returns the type of a topic in the used systems, by its graph name."""


def statements_of(part: System | Subsystem) -> Iterator[SafetyInstance]:
    """Yield the ``safety`` statements of a system's own file, subsystems included."""
    yield from part.safety
    for member in part.members:
        if isinstance(member, Subsystem):
            yield from statements_of(member)


def stated_package(rules: Rules, target: str) -> str | None:
    """Return the package that a ``safety`` statement of a used system gives to the rules' nodes."""
    for use in rules.uses:
        for statement in statements_of(use.system) if use.system is not None else ():
            if statement.rules is rules and statement.target == target and statement.package:
                return statement.package
    return None


# From rules as written ----------------------------------------------------------------------------


def topic_names(rules: Rules) -> dict[str, str]:
    """Return topics and services of the rules as written, by their graph names at the root."""
    written = [name.text for name, _ in _topics_used(rules)]
    written += [name.text for gate in rules.gates for name, _ in _topics_of_limits(gate, rules)]
    written += [action.binding.topic.text for action in rules.actions if action.binding]
    written += [action.service.service.text for action in rules.actions if action.service]
    written += [each.topic.text for gate in rules.gates for each in gate.sources]
    written += [gate.target.text for gate in rules.gates]
    found: dict[str, str] = {}
    for text in written:
        found.setdefault(resolve_name(text, "/"), text)
    return found


def outline(rules: Rules, type_of: TypeOf) -> Outline:
    """Return the outline of the nodes of the rules, without inputs of unknown type."""
    inputs: dict[str, InputOutline] = {}
    for name, span in _topics_used(rules):
        topic = resolve_name(name.text, "/")
        kind = type_of(topic)
        if kind is not None:
            inputs.setdefault(topic, InputOutline(topic, kind, span))
    states: dict[str, StateOutline] = {}
    services: dict[str, ServiceOutline] = {}
    for action in rules.actions:
        state, service = _state(action), _service(action)
        if state is not None:
            states.setdefault(state.name, state)
        if service is not None:
            services.setdefault(service.name, service)
    return Outline(
        rules.name,
        Span(rules.source, 0, 0),
        states=tuple(states.values()),
        services=tuple(services.values()),
        latched=any(action.latched for action in rules.actions),
        inputs=tuple(inputs.values()),
        optional=tuple(_optional(rules)),
        gates=tuple(_gate(gate, states, rules, type_of) for gate in rules.gates),
        tunables=tunables_of(rules),
    )


def _topics_used(rules: Rules) -> Iterator[tuple[Any, Span]]:
    """Yield the topics that rules read with the input or term that names them, in order."""
    yield from _topics_in(rules.entities, rules)


def _topics_of_limits(gate: Gate, rules: Rules) -> Iterator[tuple[Any, Span]]:
    """Yield the topics that the ends of a gate's limits name, with these ends."""
    for line in gate.lines:
        yield from _topics_of_line(line, rules)


def _topics_of_line(line: GateLine, rules: Rules) -> Iterator[tuple[Any, Span]]:
    ends = [end for limit in line.limits for end in (limit.lower, limit.upper)]
    for end in ends if line.is_standing else ():
        for name, _ in _topics_in(end, rules):
            yield name, end.span


def _topics_in(top: Any, rules: Rules) -> Iterator[tuple[Any, Span]]:
    inputs = {each.name.text: each for each in reversed(rules.inputs)}
    for part in _parts(top):
        if isinstance(part, TopicPath):
            yield part.topic, part.span
        elif isinstance(part, NamePath) and part.name.text in inputs:
            found = inputs[part.name.text]
            yield found.term.topic, found.span


def _parts(top: Any) -> Iterator[Any]:
    """Yield all descendants of a syntax tree node, in the order written."""
    waiting = [top]
    while waiting:
        part = waiting.pop()
        if isinstance(part, tuple):
            waiting.extend(reversed(part))
        elif names := _fields(part.__class__):
            yield part
            waiting.extend([getattr(part, name) for name in names])


@functools.cache
def _fields(kind: Any) -> tuple[str, ...]:
    """Return the fields of a class of syntax tree nodes, last one first; none of any other."""
    if not dataclasses.is_dataclass(kind) or kind is Span:
        return ()
    return tuple(reversed([each.name for each in dataclasses.fields(kind)]))


def _state(action: Action) -> StateOutline | None:
    binding = action.binding
    if binding is None:
        return None
    topic = resolve_name(binding.topic.text, "/")
    return StateOutline(action.name.text, topic, binding.type, action.span)


def _service(action: Action) -> ServiceOutline | None:
    call = action.service
    if call is None:
        return None
    service = resolve_name(call.service.text, "/")
    return ServiceOutline(action.name.text, service, call.type, action.span)


def _gate(
    gate: Gate, states: Mapping[str, StateOutline], rules: Rules, type_of: TypeOf
) -> GateOutline:
    lines = tuple(
        LineOutline(
            states.get(line.action.text) if line.action is not None else None,
            line.lost == "heartbeat",
            line.span,
            tuple(_inputs_of(line, rules, type_of)),
        )
        for line in gate.lines
    )
    sources = tuple(resolve_name(each.topic.text, "/") for each in gate.sources)
    target = resolve_name(gate.target.text, "/")
    is_latching = any(line.until_reset for line in gate.lines)
    named = {
        part.name.text
        for line in gate.lines
        for part in _parts(line.limits if line.is_standing else ())
        if isinstance(part, NamePath)
    }
    tunables = {each.name: each for each in tunables_of(rules) if each.name in named}
    return GateOutline(
        sources,
        target,
        gate.type,
        lines,
        gate.span,
        gate.description,
        is_latching,
        tuple(tunables[name] for name in sorted(tunables)),
    )


def _inputs_of(line: GateLine, rules: Rules, type_of: TypeOf) -> Iterator[InputOutline]:
    """Yield the topics that the ends of a line's limits are read from, without unknown types."""
    for name, span in _topics_of_line(line, rules):
        topic = resolve_name(name.text, "/")
        kind = type_of(topic)
        if kind is not None:
            yield InputOutline(topic, kind, span)


def _optional(rules: Rules) -> Iterator[str]:
    for part in _parts(rules.behaviours):
        if isinstance(part, Behaviour) and part.optional and part.name is not None:
            yield part.name.text


# Node types ---------------------------------------------------------------------------------------


def safety_node_types(
    rules: Rules, type_of: TypeOf, offers: OffersOf, target: str = "python", package: str = ""
) -> tuple[NodeType, ...]:
    """Return the safety node of some rules, followed by its gates.

    Args:
        rules: as written.
        type_of: the types of topics in the systems that the rules use.
        offers: what the publishers in those systems offer.
        target: the language that they are generated in, ``python`` or ``cpp``.
        package: that they are generated in, with or without what the target appends.
    """
    package = package.removesuffix(CPP_SUFFIX) or package_name(rules.name)
    outlined = outline(rules, type_of)
    node = safety_node_type(outlined, offers, package, node_name(package))
    nodes = (node, *gate_node_types(outlined, offers, node))
    return tuple(map(cpp_twin, nodes)) if target == "cpp" else nodes


# Instances ----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Place:
    """The place of a ``safety`` statement at run time.

    Attributes:
        namespace: of the nodes.
        frame: the namespace where the system that contains the statement begins.
    """

    namespace: str
    frame: str


def instances(
    statement: SafetyInstance,
    rules: Rules,
    types: tuple[NodeType, ...],
    place: Place,
) -> tuple[NodeInstance, ...]:
    """Return the node instances of a statement, the safety node first.

    Every port is connected: those that the rules name as the rules say, a gate's heartbeat to that
    of the safety node, and the others as the statement says or to a topic of their own name.
    """
    node, *gates = types
    names = topic_names(rules)
    # Nodes of both languages run under the name that the node in Python has.
    name = statement.node_name or node.name.removesuffix(CPP_SUFFIX)
    beat = next((w.target for w in statement.wirings if w.port == HEARTBEAT), HEARTBEAT)
    heartbeat = resolve_name(beat, place.namespace, name)
    safety = _instance(statement, node, name, statement.node_name_span)
    found = [safety, *(_instance(statement, g, g.name.removesuffix(CPP_SUFFIX)) for g in gates)]
    listener = heartbeat_port(node)
    done: list[NodeInstance] = []
    for instance, kind in zip(found, types, strict=True):
        is_gate = instance is not safety
        wirings: list[Wiring] = []
        for port in kind.ports:
            if port.name in names:
                target = resolve_name(names[port.name], place.frame, instance.name)
                wirings.append(_wiring(port, target, port.span))
            elif is_gate and port.name == listener:
                wirings.append(_wiring(port, heartbeat, port.span))
            elif (chosen := _chosen(statement, port, is_gate)) is not None:
                wirings.append(chosen)
            else:
                target = resolve_name(port.name, place.namespace, instance.name)
                wirings.append(_wiring(port, target, statement.path_span))
        if not is_gate:
            wirings += _left_over(statement, types)
        settings = _settings(statement, kind, types, is_gate)
        parameters = tuple(_tuned(setting, rules) for setting in settings)
        done.append(dataclasses.replace(instance, wirings=tuple(wirings), parameters=parameters))
    return tuple(done)


def unresolved_instance(statement: SafetyInstance) -> NodeInstance:
    """Return a node of unknown type in place of the nodes of rules that could not be loaded."""
    name = node_name(package_name(PurePath(statement.path).stem))
    return NodeInstance(
        statement.node_name or name,
        statement.path,
        None,
        statement.span,
        statement.node_name_span or statement.path_span,
        statement.path_span,
    )


def _instance(
    statement: SafetyInstance, kind: NodeType, name: str, name_span: Span | None = None
) -> NodeInstance:
    return NodeInstance(
        name,
        kind.name,
        kind,
        statement.span,
        name_span or statement.path_span,
        statement.path_span,
        respawn=statement.respawn,
        log_level=statement.log_level,
        description=statement.description,
        environment=statement.environment,
        prefix=statement.prefix,
    )


def _wiring(port: Port, target: str, span: Span) -> Wiring:
    return Wiring(port.name, target, span, span, span, port.kind)


def _chosen(statement: SafetyInstance, port: Port, is_gate: bool) -> Wiring | None:
    """Return the target of a port in the statement; private ports belong to the safety node."""
    if is_gate and port.name.startswith("~"):
        return None
    plain = port.name.removeprefix("/")
    return next(
        (
            wiring
            for wiring in statement.wirings
            if wiring.port.removeprefix("/") == plain and wiring.kind in (None, port.kind)
        ),
        None,
    )


def _left_over(statement: SafetyInstance, types: tuple[NodeType, ...]) -> Iterator[Wiring]:
    """Yield wirings of ports that no node has, for the checks to report."""
    for wiring in statement.wirings:
        if all(kind.port(wiring.port) is None for kind in types):
            yield wiring


def _settings(
    statement: SafetyInstance, kind: NodeType, types: tuple[NodeType, ...], is_gate: bool
) -> Iterator[ParameterSetting]:
    for setting in statement.parameters:
        name = setting.name
        is_known = any(each.parameter(name) is not None for each in types)
        is_general = name in BUILT_IN_PARAMETERS or name.startswith("qos_overrides.")
        if kind.parameter(name) is not None or (not is_known and (is_general or not is_gate)):
            yield setting


def _tuned(setting: ParameterSetting, rules: Rules) -> ParameterSetting:
    """Return the setting of a tunable constant in its unit; one that cannot be is left as it is."""
    constant = next((each for each in tunables_of(rules) if each.name == setting.name), None)
    if constant is None:
        return setting
    value = in_unit_of(constant, setting.value, setting.unit, rules)
    return setting if value is None else dataclasses.replace(setting, value=value, unit=None)
