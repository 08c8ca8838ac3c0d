"""The safety node as a node type: what it subscribes to, publishes and serves."""

from __future__ import annotations

import re
from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Related, SourceFile, Span, report
from deros.generators.protocol import GenerationError, Options
from deros.interfaces.names import check_node_name, check_package_name
from deros.interfaces.types import InterfaceType
from deros.metamodels import safety_qos
from deros.metamodels.common import Interval, QosProfile, Scalar
from deros.metamodels.node import NodeType, Parameter, ParameterType, Port, PortKind
from deros.monitor import walk
from deros.monitor.ir import Program
from deros.monitor.topics import SystemTopics

HEARTBEAT = "~/heartbeat"
EVENTS = "~/events"
DIAGNOSTICS = "/diagnostics"
RESET = "~/reset"

HEARTBEAT_TYPE = InterfaceType("std_msgs", "msg", "UInt64")
TRIGGER = InterfaceType("std_srvs", "srv", "Trigger")
_STATUS = InterfaceType("diagnostic_msgs", "msg", "DiagnosticStatus")
DIAGNOSTICS_TYPE = InterfaceType("diagnostic_msgs", "msg", "DiagnosticArray")


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
        parameters=tuple(_parameters(program, start)),
        ports=tuple(_ports(program, topics, start)),
    )


def _check_ends(program: Program) -> None:
    """Refuse a topic with both ends in this node: its own state would come back as an input."""
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


def enabled_parameter(behaviour: str) -> str:
    """Return the name of the parameter that enables an optional behaviour."""
    return f"behaviours.{behaviour}.enabled"


def _parameters(program: Program, span: Span) -> Iterator[Parameter]:
    kinds = ParameterType

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
        10.0,
        "How often the states of the actions and the heartbeat are published",
        "Hz",
        Interval(0.0, 1000.0, lower_closed=False),
    )
    yield fixed(
        "startup_grace",
        kinds.DOUBLE,
        0.0,
        "How long inputs may be late at the start; until they have come there is no heartbeat",
        "s",
        Interval(0.0, 86400.0),
    )
    if any(action.latched for action in program.actions):
        yield fixed(
            "state_file",
            kinds.STRING,
            "",
            "Where latched actions outlive the process; empty: in deros below $ROS_HOME or ~/.ros",
        )
    yield fixed(
        "diagnostics_freq",
        kinds.DOUBLE,
        1.0,
        "How often the state is published without a change",
        "Hz",
        Interval(0.0, 100.0, lower_closed=False),
    )
    yield fixed(
        "realtime_priority",
        kinds.INTEGER,
        0,
        "Priority under SCHED_FIFO; 0 leaves the scheduling as it is",
        interval=Interval(0, 99),
    )
    yield fixed("lock_memory", kinds.BOOL, False, "Whether the memory is never paged out")
    yield fixed("garbage_collection", kinds.BOOL, True, "Whether Python looks for unused cycles")
    for behaviour in walk.behaviours(program):
        if behaviour.optional:
            name = enabled_parameter(behaviour.name)
            description = f"Whether the behaviour {behaviour.name} is watched"
            yield Parameter(name, kinds.BOOL, True, span, span, description=description)


def _ports(program: Program, topics: SystemTopics, start: Span) -> list[Port]:
    ports: list[Port] = []
    for action in program.actions:
        if action.binding is None or any(p.name == action.binding.topic for p in ports):
            continue
        span = action.span or start
        topic, kind = action.binding.topic, action.binding.type
        description = f"Active: {' or '.join(bound_actions(program, topic))}"
        ports.append(
            made_port(PortKind.PUBLISHER, topic, kind, span, safety_qos.STATE, description)
        )
    description = "Counts up at publish_freq: stop when it stops"
    ports.append(
        made_port(
            PortKind.PUBLISHER, HEARTBEAT, HEARTBEAT_TYPE, start, safety_qos.HEARTBEAT, description
        )
    )
    description = "Tells of each action, reset and fault"
    ports.append(
        made_port(PortKind.PUBLISHER, EVENTS, _STATUS, start, safety_qos.EVENTS, description)
    )
    description = "State of the node, of its actions and of its rules"
    name = _diagnostics_name(program)
    ports.append(
        made_port(
            PortKind.PUBLISHER, name, DIAGNOSTICS_TYPE, start, safety_qos.DIAGNOSTICS, description
        )
    )
    spans = {each.topic: each.span for each in reversed(program.inputs)}
    for topic, kind in program.topics.items():
        qos = safety_qos.input_qos(topics.offers(topic))
        ports.append(made_port(PortKind.SUBSCRIPTION, topic, kind, spans[topic], qos, ""))
    if any(action.latched for action in program.actions):
        description = "Resets the latched actions that no behaviour calls for"
        ports.append(made_port(PortKind.SERVICE, RESET, TRIGGER, start, None, description))
    return ports


def _diagnostics_name(program: Program) -> str:
    """Return the usual topic, or one of the node's own where the rules need the usual one."""
    bound = (action.binding.topic for action in program.actions if action.binding is not None)
    return f"~{DIAGNOSTICS}" if DIAGNOSTICS in {*program.topics, *bound} else DIAGNOSTICS


def bound_actions(program: Program, topic: str) -> list[str]:
    """Return the names of the actions whose states a topic carries, in the order declared."""
    return [a.name for a in program.actions if a.binding is not None and a.binding.topic == topic]


def made_port(
    kind: PortKind,
    name: str,
    interface: InterfaceType,
    span: Span,
    qos: QosProfile | None,
    description: str,
) -> Port:
    """Return a port that nobody has written: its places are those of what it comes from."""
    return Port(kind, name, interface, span, span, span, qos=qos, description=description)
