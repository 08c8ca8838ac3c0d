"""The safety node as a node type: what it subscribes to, publishes and serves."""

from __future__ import annotations

import re

from deros import codes
from deros.diagnostics import Related, SourceFile, Span, report
from deros.generators.protocol import GenerationError, Options
from deros.interfaces.names import check_node_name, check_package_name
from deros.interfaces.types import InterfaceType
from deros.metamodels.common import Interval, QosProfile
from deros.metamodels.node import NodeType, Parameter, ParameterType, Port, PortKind
from deros.monitor.ir import Program
from deros.monitor.topics import SystemTopics

HEARTBEAT = "~/heartbeat"
RESET = "~/reset"

_UINT64 = InterfaceType("std_msgs", "msg", "UInt64")
_TRIGGER = InterfaceType("std_srvs", "srv", "Trigger")
_STATE_QOS = QosProfile(reliability="reliable", durability="transient_local", depth=1)
_HEARTBEAT_QOS = QosProfile(reliability="reliable", depth=1)
_INPUT_DEPTH = 10
_RELIABLE_PRESETS = frozenset({"services", "parameters"})


def safety_node(
    program: Program, topics: SystemTopics, options: Options, rules_source: SourceFile
) -> NodeType:
    """Return the node that runs ``program``.

    Its subscriptions are as reliable and as durable as all publishers of the topic say they are,
    and ask for nothing that a publisher might not offer.

    Args:
        program: the rules.
        topics: what the used systems tell of the topics, for the QoS of the subscriptions.
        options: ``package`` and ``node``, which else come from the name of the rules.
        rules_source: for the places that diagnostics about the node speak of.

    Raises:
        GenerationError: if the rules watch a topic that they publish.
        ValueError: if an option is no name that ROS 2 accepts.
    """
    _check_ends(program)
    package = _package(program, options)
    name = options.get("node", f"{package}_node")
    if (why := check_node_name(name)) is not None:
        raise ValueError(f"node name {name!r} {why}")
    start = Span(rules_source, 0, 0)
    return NodeType(
        name,
        package,
        SourceFile(f"{name}.rnd", ""),
        start,
        start,
        start,
        description=f"Watches the safety rules of {program.name}",
        parameters=(_publish_freq(start),),
        ports=tuple(_ports(program, topics, start)),
    )


def _check_ends(program: Program) -> None:
    """Refuse a topic with both ends in this node: a node description names its ports apart."""
    watched = {each.topic: each.span for each in reversed(program.inputs)}
    found = [
        report(
            codes.UNSUPPORTED_BY_TARGET,
            f"the rules both publish and watch '{action.binding.topic}'",
            action.span,
            hint="where the topic is watched, use the conditions that trigger the action",
            related=(Related(watched[action.binding.topic], "watched here"),),
        )
        for action in program.actions
        if action.binding is not None and action.span and action.binding.topic in watched
    ]
    if found:
        raise GenerationError(found)


def _package(program: Program, options: Options) -> str:
    """Return the package's name: the option, or what REP 144 leaves of the rules' name."""
    if "package" in options:
        package = options["package"]
        if (why := check_package_name(package)) is not None:
            raise ValueError(f"package name {package!r} {why}")
        return package
    stem = re.sub(r"[^a-z0-9]+", "_", program.name.lower()).strip("_")
    stem = stem if stem[:1].isalpha() else f"rules_{stem}".rstrip("_")
    return stem if stem.endswith("safety") else f"{stem}_safety"


def _publish_freq(span: Span) -> Parameter:
    return Parameter(
        "publish_freq",
        ParameterType.DOUBLE,
        10.0,
        span,
        span,
        unit="Hz",
        interval=Interval(0.0, 1000.0, lower_closed=False),
        read_only=True,
        description="How often the states of the actions and the heartbeat are published",
    )


def _ports(program: Program, topics: SystemTopics, start: Span) -> list[Port]:
    ports: list[Port] = []
    for action in program.actions:
        if action.binding is None or any(p.name == action.binding.topic for p in ports):
            continue
        span = action.span or start
        topic, kind = action.binding.topic, action.binding.type
        description = f"Active: {' or '.join(bound_actions(program, topic))}"
        ports.append(_port(PortKind.PUBLISHER, topic, kind, span, _STATE_QOS, description))
    description = "Counts up at publish_freq: stop when it stops"
    ports.append(_port(PortKind.PUBLISHER, HEARTBEAT, _UINT64, start, _HEARTBEAT_QOS, description))
    spans = {each.topic: each.span for each in reversed(program.inputs)}
    for topic, kind in program.topics.items():
        qos = _input_qos(topics, topic)
        ports.append(_port(PortKind.SUBSCRIPTION, topic, kind, spans[topic], qos, ""))
    if any(action.latched for action in program.actions):
        description = "Resets the latched actions that no behaviour calls for"
        ports.append(_port(PortKind.SERVICE, RESET, _TRIGGER, start, None, description))
    return ports


def bound_actions(program: Program, topic: str) -> list[str]:
    """Return the names of the actions whose states a topic carries, in the order declared."""
    return [a.name for a in program.actions if a.binding is not None and a.binding.topic == topic]


def _port(
    kind: PortKind,
    name: str,
    interface: InterfaceType,
    span: Span,
    qos: QosProfile | None,
    description: str,
) -> Port:
    return Port(kind, name, interface, span, span, span, qos=qos, description=description)


def _input_qos(topics: SystemTopics, topic: str) -> QosProfile:
    known = topics.get(topic)
    stated = [flat.port.qos for flat in known.publishers] if known else []
    reliable = bool(stated) and all(map(is_reliable, stated))
    durable = bool(stated) and all(
        q is not None and q.durability == "transient_local" for q in stated
    )
    depths = [qos.depth or 0 for qos in stated if qos is not None]
    return QosProfile(
        reliability="reliable" if reliable else "best_effort",
        durability="transient_local" if durable else None,
        depth=max([_INPUT_DEPTH, *depths]),
    )


def is_reliable(qos: QosProfile | None) -> bool:
    """Tell whether a publisher is stated to be reliable."""
    if qos is None:
        return False
    if qos.reliability is not None:
        return qos.reliability == "reliable"
    return qos.preset in _RELIABLE_PRESETS
