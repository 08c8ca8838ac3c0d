"""The view of a node and its package for the templates of the Python target."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

from deros.generators.node.python.parameters import (
    MapView,
    ParameterView,
    custom_function,
    map_views,
    parameter_views,
)
from deros.generators.node.python.qos import qos_view
from deros.generators.node.view import (
    NodeBase,
    check_names,
    handle,
    mapped_topic,
    period_text,
    port_notes,
    ports_by_kind,
    timer_notes,
    topic_parameter,
)
from deros.generators.text.identifiers import (
    Emitted,
    camel_case,
    check_collisions,
    file_label,
    python_identifier,
)
from deros.generators.text.notice import is_checked
from deros.generators.text.prose import printable_line, sentence
from deros.generators.text.python import Call, Text, wrapped
from deros.interfaces.durations import NS_PER_S
from deros.interfaces.types import InterfaceType
from deros.models.node import NodeType, Port, PortKind

GOAL_THREADS = "goal_threads"
"""The runtime module of packages with actions."""

QOS_REPORT = "qos_report"
"""The runtime module of packages with topics, which reports incompatible QoS."""

ENDPOINTS = "endpoints"
"""The runtime module that `QOS_REPORT` uses."""

MANAGED_NODE = "managed_node"
"""The runtime module of packages with managed nodes."""

# Names in the base class's module besides classes; no module of the user may have them.
_MODULES_USED = ("abstractmethod", "combinations", "dataclass", "os", "partial", "rclpy", "signal")

_RAW_HOOKS = ("on_named",)

# Names in the templates; a message type with such a name is imported under another one.
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
        "Mapping",
        "Node",
        "Parameter",
        "ParameterDescriptor",
        "Parameters",
        "QoSProfile",
        "QosReport",
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
        handle: the attribute with the client, of a port that is one.
        type: the message, service or action class as the module names it.
        topic: Python expression of the name handed to rclpy.
        topics: the expression of the list from which ``topic`` comes, of a port for each entry; of
            the entries and values of a map, where ``by_entry``.
        name: the name as a reader sees it.
        qos: the expression of the profile that the model states, and the names it needs, by module.
        notes: description, units and where the name comes from, each wrapped for a docstring.
    """

    identifier: str
    handle: str
    type: str
    topic: str
    name: str
    qos: str | Call | None
    qos_imports: tuple[tuple[str, str], ...]
    notes: tuple[tuple[str, ...], ...]
    topics: str | None = None
    by_entry: bool = False

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
    maps: tuple[MapView, ...]

    @property
    def base_module(self) -> str:
        """Module of the class that the generator owns."""
        return f"{self.module}_base"

    @property
    def reports_qos(self) -> bool:
        """Whether it logs incompatible QoS; raw nodes have their own report."""
        return not self.raw and bool(self.publishers or self.subscriptions)

    @property
    def declared(self) -> tuple[ParameterView, ...]:
        """All parameters, those of maps last."""
        return (*self.parameters, *(p for each in self.maps for p in each.members))

    @property
    def constrained(self) -> tuple[ParameterView, ...]:
        """The parameters that need more checks than rclpy makes."""
        return tuple(p for p in self.declared if p.constraints)

    @property
    def custom(self) -> tuple[ParameterView, ...]:
        """The parameters that the user's functions check."""
        return tuple(p for p in self.declared if p.custom)

    @property
    def checked(self) -> bool:
        """Whether parameters need checks that rclpy does not make."""
        return bool(self.constrained or self.custom)

    @property
    def checks_maps(self) -> bool:
        """Whether a parameter of a map has checks, which are looked up by its declared name."""
        return any(p.constraints or p.custom for each in self.maps for p in each.members)


def node_view(model: NodeType, raw: bool = False) -> NodeView:
    """Return the view of one node, ``raw`` or not (see :class:`NodeView`).

    Raises:
        GenerationError: if two ports, timers or parameters would get the same name.
    """
    class_name = camel_case(model.name)
    hooks = _RAW_HOOKS if raw else ()
    check_names(model, class_name, "class Parameters", python_identifier, hooks)
    maps = map_views(model)
    own = {each.struct for each in maps if each.struct is not None}
    interfaces = _interface_names(model, {class_name, f"{class_name}Base", *own})
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
        maps=maps,
        of_kind=ports_by_kind(model, lambda port: _port(port, interfaces, model)),
        timers=tuple(
            TimerView(
                python_identifier(timer.name),
                repr(timer.period_ns / NS_PER_S),
                period_text(timer.period_ns),
                _paragraphs(timer_notes(timer)),
            )
            for timer in model.timers
        ),
    )


# Names --------------------------------------------------------------------------------------------


def _interface_names(model: NodeType, own: Collection[str]) -> dict[InterfaceType, str]:
    """Return the name under which each interface type is imported.

    It is the type's own, unless another type, the module itself or a class of its ``own`` has that
    name; then the package stands in front: ``RosgraphMsgsClock``.
    """
    types = sorted({port.type for port in model.ports})
    taken = {*_TAKEN, *own}
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
    """Return the imports of some interface types, by module."""
    imports: dict[str, set[str]] = {}
    for kind in used:
        alias = interfaces[kind]
        name = kind.name if alias == kind.name else f"{kind.name} as {alias}"
        imports.setdefault(f"{kind.package}.{kind.kind}", set()).add(name)
    return imports


# Ports --------------------------------------------------------------------------------------------


def _port(port: Port, interfaces: Mapping[InterfaceType, str], model: NodeType) -> PortView:
    topic, topics = repr(port.name), None
    if mapped := mapped_topic(port, model, python_identifier):
        topics, topic = f"self.parameters.{mapped[0]}.items()", mapped[1]
    elif parameter := topic_parameter(port, model):
        value = f"self.parameters.{python_identifier(parameter.name)}"
        topic, topics = ("topic", value) if model.is_listed(port) else (f"{value} or {topic}", None)
    qos = qos_view(port.qos)
    return PortView(
        identifier=python_identifier(port.name),
        handle=handle(port, model, python_identifier),
        type=interfaces[port.type],
        topic=topic,
        name=port.name,
        qos=qos.expression if qos else None,
        qos_imports=qos.imports if qos else (),
        notes=_paragraphs(port_notes(port, model)),
        topics=topics,
        by_entry=mapped is not None,
    )


def _paragraphs(texts: Iterable[str]) -> tuple[tuple[str, ...], ...]:
    return tuple(tuple(wrapped(text, indent=8)) for text in texts)


# The package --------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class CustomView:
    """A module with the user's checks of parameters.

    Attributes:
        functions: for each, its name and what it checks, wrapped for a docstring.
    """

    module: str
    functions: tuple[tuple[str, tuple[str, ...]], ...]


def _custom_modules(models: Sequence[NodeType]) -> dict[str, Emitted]:
    """Return the modules of the user's functions, each with the place where it is first needed.

    Raises:
        GenerationError: if a module is called as another one that its user imports.
    """
    found: dict[str, Emitted] = {}
    for model in models:
        for parameter in model.parameters:
            for function in parameter.custom:
                module = custom_function(function)[0]
                origin = f"the namespace of {function.text!r}"
                found.setdefault(module, Emitted(module, origin, function.span))
    start = models[0].package_span
    used = [Emitted(name, f"the module {name!r}", start) for name in _MODULES_USED]
    check_collisions([*used, *found.values()], "the imports of the base class")
    return found


def _custom_view(module: str, nodes: Sequence[NodeView]) -> CustomView:
    checks: dict[str, list[str]] = {}
    for node in nodes:
        for parameter in node.custom:
            for where, function in parameter.custom:
                if where == module:
                    checks.setdefault(function, []).append(f"{parameter.name} of {node.name}")
    return CustomView(
        module,
        tuple(
            (name, tuple(wrapped(f"It checks {' and '.join(what)}.", indent=4)))
            for name, what in checks.items()
        ),
    )


@dataclass(frozen=True, slots=True)
class PackageView:
    """The ROS 2 package around one or more nodes.

    Attributes:
        description: on one line.
        dependencies: packages needed to run, sorted.
        copyright: the text above each file; empty for none.
        licence: the licence for manifests.
        runtime_version: of ``deros_runtime``, which the package depends on; empty if it has a copy.
    """

    name: str
    nodes: tuple[NodeView, ...]
    custom: tuple[CustomView, ...]
    description: str
    dependencies: tuple[str, ...]
    maintainer: str
    email: str
    copyright: str
    licence: str
    runtime_version: str

    @property
    def checks_copyright(self) -> bool:
        """Whether ament_copyright recognizes the headers."""
        return is_checked(self.copyright)

    @property
    def description_argument(self) -> Text:
        """The description as an argument in setup.py."""
        return Text("description=", self.description)


def package_view(
    models: tuple[NodeType, ...],
    maintainer: tuple[str, str],
    copyright_line: str,
    licence: str,
    raw: Collection[str] = (),
    needs: Collection[str] = (),
    runtime_version: str = "",
) -> PackageView:
    """Return the view of the package that ``models``, all of one package, make up.

    Args:
        models: the nodes.
        maintainer: name and address.
        copyright_line: the text above each file, or nothing.
        licence: the licence for manifests.
        raw: the names of the nodes that are raw (see :class:`NodeView`).
        needs: further packages, which the caller's own modules import.
        runtime_version: of ``deros_runtime``; empty for a package with a copy of the runtime.

    Raises:
        GenerationError: if two names collide, in a node or between the nodes' modules.
    """
    modules: list[Emitted] = []
    for model in models:
        name = python_identifier(model.name)
        origin = f"node {model.name!r}"
        modules += [Emitted(m, origin, model.name_span) for m in (name, f"{name}_base")]
    with_actions = [model for model in models if any(model.ports_of(PortKind.ACTION))]
    for model in with_actions[:1]:
        modules.append(Emitted(GOAL_THREADS, "the threads of goals", model.name_span))
    managed = [model for model in models if model.lifecycle]
    for model in managed[:1]:
        modules.append(Emitted(MANAGED_NODE, "the class of managed nodes", model.name_span))
    with_topics = [model for model in models if model.name not in raw and _has_topics(model)]
    for model in with_topics[:1]:
        modules.append(Emitted(QOS_REPORT, "the report of QoS", model.name_span))
        modules.append(Emitted(ENDPOINTS, "the report of QoS", model.name_span))
    nodes = tuple(node_view(model, model.name in raw) for model in models)
    custom = _custom_modules(models)
    modules += custom.values()
    check_collisions(modules, f"the modules of package {models[0].package}", files=True)
    description = " ".join(node.summary for node in nodes)
    needed = {"ament_index_python", "launch", "launch_ros", "rclpy", *needs}
    needed |= {port.type.package for model in models for port in model.ports}
    if any(node.parameters for node in nodes):
        needed.add("rcl_interfaces")
    return PackageView(
        name=models[0].package,
        nodes=nodes,
        custom=tuple(_custom_view(module, nodes) for module in custom),
        description=printable_line(description),
        dependencies=tuple(sorted(needed)),
        maintainer=maintainer[0],
        email=maintainer[1],
        copyright=copyright_line,
        licence=licence,
        runtime_version=runtime_version,
    )


def _has_topics(model: NodeType) -> bool:
    return any(port.kind in (PortKind.PUBLISHER, PortKind.SUBSCRIPTION) for port in model.ports)
