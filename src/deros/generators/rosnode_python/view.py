"""What the templates of the Python package see: the node description in terms of rclpy."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from deros.generators.names import Emitted, camel_case, check_collisions, python_identifier
from deros.generators.python_source import Call, Text, one_line, sentence, wrapped
from deros.generators.rosnode_python.parameters import ParameterView, parameter_views
from deros.generators.rosnode_python.qos import qos_view
from deros.interfaces.types import InterfaceType
from deros.metamodels.node import NodeType, Port, PortKind

_HOOKS = ("on_parameters_changed",)
_RAW_HOOKS = ("on_named",)
_LIFECYCLE_HOOKS = (
    "on_activate",
    "on_cleanup",
    "on_configure",
    "on_deactivate",
    "on_error",
    "on_shutdown",
)
_METHODS = {
    PortKind.PUBLISHER: ("publish_{}",),
    PortKind.SUBSCRIPTION: ("on_{}",),
    PortKind.SERVICE: ("handle_{}",),
    PortKind.CLIENT: ("call_{}", "client_{}"),
    PortKind.ACTION: ("accept_{}", "execute_{}", "cancel_{}"),
    PortKind.ACTION_CLIENT: ("send_{}", "client_{}"),
}
_UNITS_OF_TIME = ((10**9, "s"), (10**6, "ms"), (10**3, "us"), (1, "ns"))

# Names that the templates use themselves; a message type called so is imported under another name.
_TAKEN = frozenset(
    (
        "ABC",
        "ActionClient",
        "ActionServer",
        "Any",
        "Callable",
        "CancelResponse",
        "Clock",
        "ClockType",
        "DurabilityPolicy",
        "Duration",
        "FloatingPointRange",
        "Future",
        "GoalResponse",
        "HistoryPolicy",
        "IntegerRange",
        "LifecycleNode",
        "LivelinessPolicy",
        "MultiThreadedExecutor",
        "Node",
        "Parameter",
        "ParameterDescriptor",
        "Parameters",
        "QoSProfile",
        "ReentrantCallbackGroup",
        "ReliabilityPolicy",
        "ServerGoalHandle",
        "SetParametersResult",
        "SimpleManagedEntity",
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


@dataclass(frozen=True, slots=True)
class NodeView:
    """One node of the package.

    Attributes:
        source: file name of the node description.
        raw: whether its subscriptions hand over serialized messages, and its class and program
            come from elsewhere.
        interfaces: for each interface type, module, class name, and its name in the modules.
    """

    name: str
    module: str
    class_name: str
    lifecycle: bool
    source: str
    raw: bool
    summary: str
    interfaces: tuple[tuple[InterfaceType, str], ...]
    parameters: tuple[ParameterView, ...]
    publishers: tuple[PortView, ...]
    subscriptions: tuple[PortView, ...]
    services: tuple[PortView, ...]
    clients: tuple[PortView, ...]
    actions: tuple[PortView, ...]
    action_clients: tuple[PortView, ...]
    timers: tuple[TimerView, ...]

    @property
    def base_module(self) -> str:
        """Module of the class that the generator owns."""
        return f"{self.module}_base"

    @property
    def base_class(self) -> str:
        """Class that the generator owns."""
        return f"{self.class_name}Base"

    @property
    def has_handlers(self) -> bool:
        """Whether the user's class has something to fill in."""
        return bool(self.subscriptions or self.timers or self.services or self.actions)

    @property
    def gated(self) -> bool:
        """Whether there are callbacks that rest while a managed node is not active."""
        return self.lifecycle and bool(self.subscriptions or self.timers)

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
    check_collisions(_methods(model, raw), f"the methods of class {camel_case(model.name)}")
    check_collisions(
        (
            Emitted(python_identifier(p.name), f"parameter {p.name!r}", p.name_span)
            for p in model.parameters
        ),
        "the class Parameters",
    )
    class_name = camel_case(model.name)
    interfaces = _interface_names(model, class_name)
    views = {
        kind: tuple(_port(p, interfaces, model) for p in model.ports_of(kind)) for kind in PortKind
    }
    return NodeView(
        name=model.name,
        module=python_identifier(model.name),
        class_name=class_name,
        lifecycle=model.lifecycle,
        source=Path(model.source.path).name,
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
                _paragraphs(sentence(timer.description)),
            )
            for timer in model.timers
        ),
    )


def duration_text(nanoseconds: int) -> str:
    """Return a duration in the greatest unit that needs no fraction, ``20 ms``."""
    size, unit = next((s, u) for s, u in _UNITS_OF_TIME if nanoseconds % s == 0)
    return f"{nanoseconds // size} {unit}"


# Names --------------------------------------------------------------------------------------------


def _methods(model: NodeType, raw: bool) -> Iterator[Emitted]:
    """Yield every method that the base class gets, the hooks first."""
    lifecycle_hooks = _LIFECYCLE_HOOKS if model.lifecycle else ()
    for hook in (*_HOOKS, *(_RAW_HOOKS if raw else ()), *lifecycle_hooks):
        yield Emitted(hook, f"the hook {hook!r}", model.name_span)
    for port in model.ports:
        for method in _METHODS[port.kind]:
            name = method.format(python_identifier(port.name))
            yield Emitted(name, f"port {port.name!r}", port.name_span)
    for timer in model.timers:
        name = f"on_{python_identifier(timer.name)}"
        yield Emitted(name, f"timer {timer.name!r}", timer.name_span)


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
    notes = [sentence(port.description)]
    if port.units:
        listed = ", ".join(f"{unit.path} [{unit.unit}]" for unit in port.units)
        notes.append(f"Units: {listed}.")
    if port.via is not None and model.parameter(port.via) is not None:
        topic = f"self.parameters.{python_identifier(port.via)} or {topic}"
        notes.append(f"The parameter {port.via} gives the topic's name at start.")
    qos = qos_view(port.qos)
    return PortView(
        identifier=python_identifier(port.name),
        type=interfaces[port.type],
        topic=topic,
        name=port.name,
        qos=qos.expression if qos else None,
        qos_imports=qos.imports if qos else (),
        notes=_paragraphs(*notes),
    )


def _paragraphs(*texts: str) -> tuple[tuple[str, ...], ...]:
    return tuple(tuple(wrapped(text, indent=8)) for text in texts if text)


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
    check_collisions(modules, f"the modules of package {models[0].package}")
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
