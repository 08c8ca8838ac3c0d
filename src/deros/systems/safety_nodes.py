"""The nodes that safety rules become: the safety node and its gates, with parameters and ports.

This is their only definition. The generators write these nodes, a ``safety``
statement of a system creates them, and checks compare hand-written wirings with them.

The nodes follow from an :class:`Outline`, which the rules as written give as well as the program
that is built from them, and from what the publishers of the used systems offer; their QoS is that
of :mod:`deros.systems.safety_qos`.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Iterator

from deros.diagnostics import SourceFile, Span
from deros.interfaces.types import InterfaceType
from deros.models.common import Interval, QosProfile, Scalar
from deros.models.node import (
    BUILT_IN_PARAMETERS,
    NodeType,
    Parameter,
    ParameterType,
    Port,
    PortKind,
)
from deros.systems import safety_qos
from deros.systems.outlines import GateOutline, InputOutline, Outline, StateOutline
from deros.systems.safety_qos import Offers
from deros.systems.tunables import tunable_parameter

HEARTBEAT = "~/heartbeat"
EVENTS = "~/events"
DIAGNOSTICS = "/diagnostics"
RESET = "~/reset"

HEARTBEAT_TYPE = InterfaceType("std_msgs", "msg", "UInt64")
TRIGGER = InterfaceType("std_srvs", "srv", "Trigger")
_STATUS = InterfaceType("diagnostic_msgs", "msg", "DiagnosticStatus")
DIAGNOSTICS_TYPE = InterfaceType("diagnostic_msgs", "msg", "DiagnosticArray")

PUBLISH_HZ, FASTEST_PUBLISH_HZ = 10.0, 1000.0
"""The default and the maximum of ``publish_freq``, the rate of the heartbeat and the states."""

DIAGNOSTICS_HZ, FASTEST_DIAGNOSTICS_HZ = 1.0, 100.0
"""The default and the maximum of ``diagnostics_freq``."""

SLOWEST_HZ = 0.001
"""The minimum of both: a period of which every target can count the nanoseconds."""

PROCESS_PARAMETERS = ("realtime_priority", "lock_memory", "garbage_collection")
"""The parameters that gates share with the safety node."""

CPP_SUFFIX = "_cpp"
"""The suffix of the node types that the C++ target generates from rules."""

_NOT_IN_NAMES = re.compile(r"[^A-Za-z0-9]+")

OffersOf = Callable[[str], Offers]
"""Returns the QoS that the publishers of a topic offer, by its graph name."""


# Names --------------------------------------------------------------------------------------------


def package_name(rules_name: str) -> str:
    """Return the name of the package generated from rules, adapted to REP 144.

    >>> package_name("Courier-2")
    'courier_2_safety'
    """
    stem = re.sub(r"[^a-z0-9]+", "_", rules_name.lower()).strip("_")
    stem = stem if stem[:1].isalpha() else f"rules_{stem}".rstrip("_")
    return stem if stem.endswith("safety") else f"{stem}_safety"


def node_name(package: str) -> str:
    """Return the name of the safety node in a package."""
    return f"{package}_node"


def gate_node_name(target: str) -> str:
    """Return the name of the node type of the gate to a topic.

    >>> gate_node_name("/front/cmd_vel")
    'front_cmd_vel_gate'
    >>> gate_node_name("/_2")
    'topic_2_gate'
    """
    stem = _NOT_IN_NAMES.sub("_", target).strip("_")
    stem = stem if stem[:1].isalpha() else f"topic_{stem}".rstrip("_")
    return f"{stem}_gate"


def is_gate_node(name: str, target: str) -> bool:
    """Return whether a node type, in Python or C++, is the gate to a topic."""
    return name.removesuffix(CPP_SUFFIX) == gate_node_name(target)


def is_gate(name: str) -> bool:
    """Return whether a node type, in Python or C++, has the name of a gate."""
    return name.removesuffix(CPP_SUFFIX).endswith("_gate")


def heartbeat_port(safety_node: NodeType) -> str:
    """Return the name of a gate's heartbeat port: the default topic of the safety node's."""
    return f"{safety_node.name.removesuffix(CPP_SUFFIX)}/heartbeat"


def is_safety_node(node: NodeType) -> bool:
    """Return whether a node type publishes a heartbeat like every generated safety node."""
    return any(
        port.kind is PortKind.PUBLISHER and port.name == HEARTBEAT and (port.type == HEARTBEAT_TYPE)
        for port in node.ports
    )


def cpp_twin(node: NodeType) -> NodeType:
    """Return the C++ node type that corresponds to a Python one."""
    name, package = f"{node.name}{CPP_SUFFIX}", f"{node.package}{CPP_SUFFIX}"
    source = SourceFile(f"{name}.rnd", node.source.text)
    return dataclasses.replace(node, name=name, package=package, source=source)


# The safety node ----------------------------------------------------------------------------------


def safety_node_type(outline: Outline, offers: OffersOf, package: str, name: str) -> NodeType:
    """Return the node that runs the rules, in Python."""
    start = outline.start
    return NodeType(
        name,
        package,
        SourceFile(f"{name}.rnd", ""),
        start,
        start,
        start,
        description=f"Monitors the safety rules of {outline.name}",
        parameters=tuple(_parameters(outline)),
        ports=tuple(_safety_ports(outline, offers)),
    )


def enabled_parameter(behaviour: str) -> str:
    """Return the name of the parameter that enables an optional behaviour."""
    return f"behaviours.{behaviour}.enabled"


def _parameters(outline: Outline) -> Iterator[Parameter]:
    kinds = ParameterType
    span = outline.start

    def fixed(
        name: str,
        kind: ParameterType,
        default: Scalar,
        description: str,
        unit: str | None = None,
        interval: Interval | None = None,
    ) -> Parameter:
        return Parameter(
            name,
            kind,
            default,
            span,
            span,
            unit=unit,
            interval=interval,
            read_only=True,
            description=description,
        )

    yield fixed(
        "publish_freq",
        kinds.DOUBLE,
        PUBLISH_HZ,
        "How often the states of the actions and the heartbeat are published",
        "Hz",
        Interval(SLOWEST_HZ, FASTEST_PUBLISH_HZ),
    )
    yield fixed(
        "startup_grace",
        kinds.DOUBLE,
        0.0,
        "How long inputs may be late at startup; there is no heartbeat until they have arrived",
        "s",
        Interval(0.0, 86400.0),
    )
    if outline.latched:
        yield fixed(
            "state_file",
            kinds.STRING,
            "",
            "File that keeps latched actions; empty: in deros below $ROS_HOME or ~/.ros",
        )
    yield fixed(
        "diagnostics_freq",
        kinds.DOUBLE,
        DIAGNOSTICS_HZ,
        "How often the state is published without a change",
        "Hz",
        Interval(SLOWEST_HZ, FASTEST_DIAGNOSTICS_HZ),
    )
    yield fixed(
        "realtime_priority",
        kinds.INTEGER,
        0,
        "Priority under SCHED_FIFO; 0 leaves the scheduling as it is",
        interval=Interval(0, 99),
    )
    yield fixed(
        "lock_memory", kinds.BOOL, False, "Whether the memory is locked and never paged out"
    )
    yield fixed(
        "garbage_collection", kinds.BOOL, True, "Whether Python's cyclic garbage collector runs"
    )
    for behaviour in outline.optional:
        name = enabled_parameter(behaviour)
        description = f"Whether the behaviour {behaviour} is enabled"
        yield Parameter(name, kinds.BOOL, True, span, span, description=description)
    yield from map(tunable_parameter, outline.tunables)


def parameter_names() -> frozenset[str]:
    """Return the names of the parameters that a safety node has beside tunable constants."""
    start = Span(SourceFile("", ""), 0, 0)
    own = (each.name for each in _parameters(Outline("", start, latched=True)))
    return frozenset((*own, *BUILT_IN_PARAMETERS))


def _safety_ports(outline: Outline, offers: OffersOf) -> list[Port]:
    start = outline.start
    ports: list[Port] = []
    for state in outline.states:
        if any(port.name == state.topic for port in ports):
            continue
        names = [each.name for each in outline.states if each.topic == state.topic]
        description = f"Active: {' or '.join(names)}"
        ports.append(_port(PortKind.PUBLISHER, state, safety_qos.STATE, description))
    description = "Counts up at publish_freq: stop when it stops"
    ports.append(
        synthesized_port(
            PortKind.PUBLISHER, HEARTBEAT, HEARTBEAT_TYPE, start, safety_qos.HEARTBEAT, description
        )
    )
    description = "Reports each action, reset and fault"
    ports.append(
        synthesized_port(PortKind.PUBLISHER, EVENTS, _STATUS, start, safety_qos.EVENTS, description)
    )
    description = "State of the node, of its actions and of its rules"
    name = _diagnostics_name(outline)
    ports.append(
        synthesized_port(
            PortKind.PUBLISHER, name, DIAGNOSTICS_TYPE, start, safety_qos.DIAGNOSTICS, description
        )
    )
    ports += [
        _port(PortKind.SUBSCRIPTION, read, safety_qos.input_qos(offers(read.topic)))
        for read in outline.inputs
    ]
    for service, kind in dict.fromkeys((call.service, call.type) for call in outline.services):
        calls = [call for call in outline.services if call.service == service]
        description = f"Called by: {' or '.join(call.name for call in calls)}"
        ports.append(
            synthesized_port(PortKind.CLIENT, service, kind, calls[0].span, None, description)
        )
    if outline.latched:
        description = "Resets the latched actions that no behaviour triggers"
        ports.append(synthesized_port(PortKind.SERVICE, RESET, TRIGGER, start, None, description))
    return ports


def _diagnostics_name(outline: Outline) -> str:
    """Return the usual topic, or a private one if the rules use the usual one."""
    needed = {read.topic for read in outline.inputs} | {state.topic for state in outline.states}
    return f"~{DIAGNOSTICS}" if DIAGNOSTICS in needed else DIAGNOSTICS


# Gates --------------------------------------------------------------------------------------------


def gate_node_types(outline: Outline, offers: OffersOf, safety_node: NodeType) -> list[NodeType]:
    """Return the nodes of the gates, in Python, in the package of the safety node.

    Args:
        outline: the rules.
        offers: what publishers offer, for the QoS of the commands.
        safety_node: the node whose states and heartbeat the gates follow, in Python.
    """
    return [_gate_node(gate, offers, safety_node) for gate in outline.gates]


def _gate_node(gate: GateOutline, offers: OffersOf, safety_node: NodeType) -> NodeType:
    name = gate_node_name(gate.target)
    sources = " or ".join(gate.sources)
    described = f"Passes commands from {sources} to {gate.target} as far as it is safe"
    return NodeType(
        name,
        safety_node.package,
        SourceFile(f"{name}.rnd", ""),
        gate.span,
        gate.span,
        gate.span,
        description=gate.description or described,
        parameters=(
            *(p for p in safety_node.parameters if p.name in PROCESS_PARAMETERS),
            _losses_in_simulated_time(gate),
            *map(tunable_parameter, gate.tunables),
        ),
        ports=tuple(_gate_ports(gate, offers, safety_node)),
    )


LOSSES_IN_SIMULATED_TIME = "losses_in_simulated_time"
"""The parameter that gates alone have."""


def _losses_in_simulated_time(gate: GateOutline) -> Parameter:
    description = (
        "Under use_sim_time, measure losses and the period of zeros on /clock, for tests: while it"
        " stands still, nothing is lost"
    )
    return Parameter(
        LOSSES_IN_SIMULATED_TIME,
        ParameterType.BOOL,
        False,
        gate.span,
        gate.span,
        read_only=True,
        description=description,
    )


def _gate_ports(gate: GateOutline, offers: OffersOf, safety_node: NodeType) -> list[Port]:
    span = gate.span
    description = "Commands that have passed the gate"
    target = synthesized_port(
        PortKind.PUBLISHER, gate.target, gate.type, span, safety_qos.GATE_TARGET, description
    )
    ports: dict[str, Port] = {}
    for name in gate.sources:
        qos = safety_qos.gate_source_qos(offers(name))
        source = synthesized_port(
            PortKind.SUBSCRIPTION, name, gate.type, span, qos, "Commands before the gate"
        )
        ports.setdefault(name, source)
    for line in gate.lines:
        if line.state is not None:
            state = dataclasses.replace(line.state, span=line.span)
            ports.setdefault(state.topic, _port(PortKind.SUBSCRIPTION, state, safety_qos.STATE))
        for read in line.inputs:
            qos = safety_qos.input_qos(offers(read.topic))
            described = "Numbers for limits"
            ports.setdefault(read.topic, _port(PortKind.SUBSCRIPTION, read, qos, described))
        if line.heartbeat:
            name = heartbeat_port(safety_node)
            beat = synthesized_port(
                PortKind.SUBSCRIPTION,
                name,
                HEARTBEAT_TYPE,
                line.span,
                safety_qos.GATE_HEARTBEAT,
                "",
            )
            ports.setdefault(name, beat)
    description = "State of the gate"
    diagnostics = synthesized_port(
        PortKind.PUBLISHER, DIAGNOSTICS, DIAGNOSTICS_TYPE, span, safety_qos.DIAGNOSTICS, description
    )
    resets: list[Port] = []
    if gate.is_latching:
        description = "Ends the zeros that last until a reset, once their causes are over"
        resets = [synthesized_port(PortKind.SERVICE, RESET, TRIGGER, span, None, description)]
    return [target, diagnostics, *ports.values(), *resets]


# Ports --------------------------------------------------------------------------------------------


def synthesized_port(
    kind: PortKind,
    name: str,
    interface: InterfaceType,
    span: Span,
    qos: QosProfile | None,
    description: str,
) -> Port:
    """Return a synthesized port with the span of its origin."""
    return Port(kind, name, interface, span, span, span, qos=qos, description=description)


def _port(
    kind: PortKind, end: StateOutline | InputOutline, qos: QosProfile, description: str = ""
) -> Port:
    return synthesized_port(kind, end.topic, end.type, end.span, qos, description)
