"""What the templates of the Python package see: the node description in terms of rclpy."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

from deros.generators.names import (
    Emitted,
    camel_case,
    check_collisions,
    file_label,
    python_identifier,
)
from deros.generators.node_view import (
    NodeBase,
    check_names,
    duration_text,
    port_notes,
    timer_notes,
    topic_parameter,
)
from deros.generators.python_source import Call, Text, one_line, sentence, wrapped
from deros.generators.rosnode_python.parameters import ParameterView, parameter_views
from deros.generators.rosnode_python.qos import qos_view
from deros.interfaces.types import InterfaceType
from deros.metamodels.node import NodeType, Port, PortKind

GOAL_THREADS = "goal_threads"
"""The module that packages have whose nodes have actions."""

MANAGED_NODE = "managed_node"
"""The module that packages have with managed nodes."""

_RAW_HOOKS = ("on_named",)

# Names that the templates use themselves; a message type called so is imported under another name.
_TAKEN = frozenset(
    (
        "ABC",
        "ActionClient",
        "Any",
        "Callable",
        "CancelResponse",
        "Clock",
        "ClockType",
        "DurabilityPolicy",
        "Duration",
        "FloatingPointRange",
        "Future",
        "GoalServer",
        "GoalThreads",
        "GoalResponse",
        "HistoryPolicy",
        "IntegerRange",
        "LivelinessPolicy",
        "ManagedNode",
        "Node",
        "Parameter",
        "ParameterDescriptor",
        "Parameters",
        "QoSProfile",
        "ReliabilityPolicy",
        "ServerGoalHandle",
        "SetParametersResult",
        "SignalHandlerOptions",
        "SingleThreadedExecutor",
        "SimpleManagedEntity",
        "Thread",
    )
)


@dataclass(frozen=True, slots=True)
class PortView:
    """One port.

    Attributes:
        identifier: the part of method names that stands for the port.
        type: the message, service or action class as the module names it.
        topic: Python expression of the name handed to rclpy.
        name: the name as a reader sees it.
        qos: the expression of the profile that the model states, and the names it needs, by module.
        notes: description, units and where the name comes from, each wrapped for a docstring.
    """

    identifier: str
    type: str
    topic: str
    name: str
    qos: str | Call | None
    qos_imports: tuple[tuple[str, str], ...]
    notes: tuple[tuple[str, ...], ...]

    @property
    def qos_keyword(self) -> str | Call | None:
        """The profile as the keyword argument of a service or client."""
        if isinstance(self.qos, Call):
            return Call(f"qos_profile={self.qos.head}", self.qos.arguments)
        return f"qos_profile={self.qos}" if self.qos else None


@dataclass(frozen=True, slots=True)
class TimerView:
    """One timer; ``period`` is the literal in seconds, ``text`` reads ``20 ms``."""

    identifier: str
    period: str
    text: str
    notes: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeView(NodeBase[PortView, TimerView]):
    """One node of the package.

    Attributes:
        raw: whether its subscriptions hand over serialized messages, and its class and program
            come from elsewhere.
        interfaces: for each interface type, module, class name, and its name in the modules.
    """

    module: str
    raw: bool
    interfaces: tuple[tuple[InterfaceType, str], ...]
    parameters: tuple[ParameterView, ...]

    @property
    def base_module(self) -> str:
        """Module of the class that the generator owns."""
        return f"{self.module}_base"

    @property
    def configured(self) -> bool:
        """Whether the parameter file has a value to hold."""
        return any(p.yaml is not None for p in self.parameters)

    @property
    def checked(self) -> tuple[ParameterView, ...]:
        """The parameters that need more checks than rclpy makes."""
        return tuple(p for p in self.parameters if p.constraints)


def node_view(model: NodeType, raw: bool = False) -> NodeView:
    """Return the view of one node, ``raw`` or not (see :class:`NodeView`).

    Raises:
        GenerationError: if two ports, timers or parameters would get one name.
    """
    class_name = camel_case(model.name)
    hooks = _RAW_HOOKS if raw else ()
    check_names(model, class_name, "class Parameters", python_identifier, hooks)
    interfaces = _interface_names(model, class_name)
    views = {
        kind: tuple(_port(p, interfaces, model) for p in model.ports_of(kind)) for kind in PortKind
    }
    return NodeView(
        name=model.name,
        module=python_identifier(model.name),
        class_name=class_name,
        lifecycle=model.lifecycle,
        source=file_label(model.source.path),
        raw=raw,
        summary=sentence(model.description) or f"The node {model.name}.",
        interfaces=tuple(interfaces.items()),
        parameters=parameter_views(model),
        publishers=views[PortKind.PUBLISHER],
        subscriptions=views[PortKind.SUBSCRIPTION],
        services=views[PortKind.SERVICE],
        clients=views[PortKind.CLIENT],
        actions=views[PortKind.ACTION],
        action_clients=views[PortKind.ACTION_CLIENT],
        timers=tuple(
            TimerView(
                python_identifier(timer.name),
                repr(timer.period_ns / 10**9),
                duration_text(timer.period_ns),
                _paragraphs(timer_notes(timer)),
            )
            for timer in model.timers
        ),
    )


# Names --------------------------------------------------------------------------------------------


def _interface_names(model: NodeType, class_name: str) -> dict[InterfaceType, str]:
    """Return the name under which each interface type is imported.

    It is the type's own, unless another type or the module itself has that name; then the package
    stands in front: ``RosgraphMsgsClock``.
    """
    types = sorted({port.type for port in model.ports})
    taken = {*_TAKEN, class_name, f"{class_name}Base"}
    names: dict[InterfaceType, str] = {}
    for kind in types:
        alone = sum(other.name == kind.name for other in types) == 1
        name = (
            kind.name if alone and kind.name not in taken else camel_case(kind.package) + kind.name
        )
        while name in taken:
            name += kind.kind.capitalize()
        taken.add(name)
        names[kind] = name
    return names


def interface_imports(
    interfaces: Mapping[InterfaceType, str], used: Iterable[InterfaceType]
) -> dict[str, set[str]]:
    """Return what to import for some interface types, by module."""
    imports: dict[str, set[str]] = {}
    for kind in used:
        alias = interfaces[kind]
        name = kind.name if alias == kind.name else f"{kind.name} as {alias}"
        imports.setdefault(f"{kind.package}.{kind.kind}", set()).add(name)
    return imports


# Ports --------------------------------------------------------------------------------------------


def _port(port: Port, interfaces: Mapping[InterfaceType, str], model: NodeType) -> PortView:
    topic = repr(port.name)
    if parameter := topic_parameter(port, model):
        topic = f"self.parameters.{python_identifier(parameter.name)} or {topic}"
    qos = qos_view(port.qos)
    return PortView(
        identifier=python_identifier(port.name),
        type=interfaces[port.type],
        topic=topic,
        name=port.name,
        qos=qos.expression if qos else None,
        qos_imports=qos.imports if qos else (),
        notes=_paragraphs(port_notes(port, model)),
    )


def _paragraphs(texts: Iterable[str]) -> tuple[tuple[str, ...], ...]:
    return tuple(tuple(wrapped(text, indent=8)) for text in texts)


# The package --------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class PackageView:
    """The ROS 2 package around one or more nodes.

    Attributes:
        description: on one line.
        dependencies: packages needed to run, sorted.
        copyright: years and holder for the headers; empty for none.
    """

    name: str
    nodes: tuple[NodeView, ...]
    description: str
    dependencies: tuple[str, ...]
    maintainer: str
    email: str
    copyright: str

    @property
    def description_argument(self) -> Text:
        """The description as setup.py hands it over."""
        return Text("description=", self.description)


def package_view(
    models: tuple[NodeType, ...],
    maintainer: tuple[str, str],
    copyright_line: str,
    raw: Collection[str] = (),
    needs: Collection[str] = (),
) -> PackageView:
    """Return the view of the package that ``models``, all of one package, make up.

    Args:
        models: the nodes.
        maintainer: name and address.
        copyright_line: years and holder, or nothing.
        raw: the names of the nodes that are raw (see :class:`NodeView`).
        needs: further packages, which the caller's own modules import.

    Raises:
        GenerationError: if two names collide, in a node or between the nodes' modules.
    """
    modules: list[Emitted] = []
    for model in models:
        name = python_identifier(model.name)
        origin = f"node {model.name!r}"
        modules += [Emitted(m, origin, model.name_span) for m in (name, f"{name}_base")]
    with_actions = [model for model in models if model.ports_of(PortKind.ACTION)]
    for model in with_actions[:1]:
        modules.append(Emitted(GOAL_THREADS, "the threads of goals", model.name_span))
    managed = [model for model in models if model.lifecycle]
    for model in managed[:1]:
        modules.append(Emitted(MANAGED_NODE, "the class of managed nodes", model.name_span))
    check_collisions(modules, f"the modules of package {models[0].package}", files=True)
    nodes = tuple(node_view(model, model.name in raw) for model in models)
    description = " ".join(node.summary for node in nodes)
    needed = {"ament_index_python", "launch", "launch_ros", "rclpy", *needs}
    needed |= {port.type.package for model in models for port in model.ports}
    if any(node.parameters for node in nodes):
        needed.add("rcl_interfaces")
    return PackageView(
        name=models[0].package,
        nodes=nodes,
        description=one_line(description),
        dependencies=tuple(sorted(needed)),
        maintainer=maintainer[0],
        email=maintainer[1],
        copyright=copyright_line,
    )
