"""The view of a node and its package for the templates of the C++ target."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from deros.generators.node.cpp.parameters import (
    MapView,
    ParameterView,
    cpp_map_views,
    cpp_parameter_views,
)
from deros.generators.node.cpp.qos import qos_expression
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
from deros.generators.runtime.cpp.interface import CppRuntime
from deros.generators.runtime.interface import CPP_RUNTIME, RUNTIME_VERSION
from deros.generators.text.cpp import (
    Chain,
    cpp_header,
    cpp_identifier,
    cpp_string,
    cpp_type,
)
from deros.generators.text.identifiers import Emitted, camel_case, check_collisions, file_label
from deros.generators.text.notice import is_checked
from deros.generators.text.prose import printable_line, sentence
from deros.interfaces.durations import greatest_unit
from deros.models.node import NodeType, Port, PortKind

# Other packages, those of interfaces above all, have a variable that lists their targets.
_TARGETS = {
    CPP_RUNTIME: f"{CPP_RUNTIME}::{CPP_RUNTIME}",
    "rclcpp": "rclcpp::rclcpp",
    "rclcpp_action": "rclcpp_action::rclcpp_action",
    "rclcpp_components": "rclcpp_components::component",
    "rclcpp_lifecycle": "rclcpp_lifecycle::rclcpp_lifecycle",
}
_CHRONO = {"sec": "seconds", "ms": "milliseconds", "us": "microseconds", "ns": "nanoseconds"}


@dataclass(frozen=True, slots=True)
class Provided:
    """A node whose class the caller of the generator provides, instead of the user.

    The caller adds the files: ``include/<package>/<stem>.hpp`` that defines the class, the sources,
    one of which registers the component, and whatever these need. ``stem`` and class are named
    after ``default_name``. The base class opens no port by itself: the class calls ``open_ports``
    with the callback group of its choice, when it is ready for messages.

    Attributes:
        sources: what goes into the node's library beside the base class, relative to the package.
        needs: further ROS packages that the sources use.
        main: the sources of the program; nothing for the usual one, which spins in one thread.
        default_name: the name of the node at run time; nothing for the name of its type.
        memory: a class template, ``robot_safety_cpp::Pool``, of which an object for the message's
            type is handed to each subscription as its memory strategy; nothing for rclcpp's own.
        includes: headers that ``memory`` needs.
    """

    sources: tuple[str, ...]
    needs: tuple[str, ...] = ()
    main: tuple[str, ...] = ()
    default_name: str | None = None
    memory: str | None = None
    includes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class PortView:
    """One port.

    Attributes:
        identifier: the part of method names that stands for the port.
        handle: the data member with the client, of a port that is one.
        type: the C++ type of the message, service or action, and ``header`` that defines it.
        topic: C++ expression of the name handed to rclcpp.
        topics: the expression of the list from which ``topic`` comes, of a port for each entry; of
            the map, where ``by_entry``.
        name: the name as a reader sees it.
        qos: the expression of the profile that the model states.
        notes: description, units and where the name comes from.
        memory: the expression of a subscription's memory strategy; ``None`` for rclcpp's own.
    """

    identifier: str
    handle: str
    type: str
    header: str
    topic: str
    name: str
    qos: Chain | None
    notes: tuple[str, ...]
    memory: str | None
    topics: str | None = None
    by_entry: bool = False

    @property
    def member(self) -> str:
        """The part of the names of data members that stands for the port."""
        return self.identifier.rstrip("_")


@dataclass(frozen=True, slots=True)
class TimerView:
    """One timer; ``period`` is an expression of ``std::chrono``, ``text`` reads ``20 ms``."""

    identifier: str
    period: str
    text: str
    notes: tuple[str, ...]

    @property
    def member(self) -> str:
        """The part of the name of the data member that stands for the timer."""
        return self.identifier.rstrip("_")


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeView(NodeBase[PortView, TimerView]):
    """One node of the package.

    Attributes:
        stem: the stem of its file names.
        default_name: its name at run time.
        provided: the parts from the caller; ``None`` if the user writes the class.
        runtime: the runtime of its package.
    """

    stem: str
    default_name: str
    provided: Provided | None
    runtime: CppRuntime
    parameters: tuple[ParameterView, ...]
    maps: tuple[MapView, ...]

    @property
    def parent(self) -> str:
        """Class of the client library that the base class extends."""
        return "rclcpp_lifecycle::LifecycleNode" if self.lifecycle else "rclcpp::Node"

    @property
    def links_runtime(self) -> bool:
        """Whether its library is linked with that of the runtime."""
        return self.runtime.linked and bool(self.provided or self.runtime_parts)

    @property
    def runtime_parts(self) -> tuple[str, ...]:
        """The parts of the runtime that its base class uses."""
        goals = ("goal_threads",) if self.actions else ()
        managed = ("managed_node",) if self.lifecycle else ()
        topics = ("endpoints", "qos_report") if self.reports_qos else ()
        return (*goals, *managed, *topics)

    @property
    def reports_qos(self) -> bool:
        """Whether it logs ends of other nodes that do not match its own."""
        return self.provided is None and bool(self.publishers or self.subscriptions)

    @property
    def checked(self) -> tuple[ParameterView, ...]:
        """The parameters that need more checks than rclcpp makes."""
        return tuple(p for p in self.declared if p.checks or p.custom)

    @property
    def declared(self) -> tuple[ParameterView, ...]:
        """All parameters, those of maps last."""
        return (*self.parameters, *(p for each in self.maps for p in each.members))

    @property
    def checks_maps(self) -> bool:
        """Whether a parameter of a map has checks, which are looked up by its declared name."""
        return any(p.checks or p.custom for each in self.maps for p in each.members)

    @property
    def helpers(self) -> frozenset[str]:
        """The functions that the checks call."""
        return frozenset(c.helper for p in self.checked for c in p.checks if c.helper)

    @property
    def custom(self) -> tuple[tuple[str, tuple[str, ...]], ...]:
        """The user's functions that check parameters, by their namespace."""
        found: dict[str, dict[str, None]] = {}
        for name in dict.fromkeys(name for p in self.checked for name in p.custom):
            scope, _, function = name.rpartition("::")
            found.setdefault(scope, {})[function] = None
        return tuple((scope, tuple(found[scope])) for scope in sorted(found))

    @property
    def equal(self) -> Chain:
        """The comparison of two structures of parameters."""
        fields = [parameter.field for parameter in self.parameters]
        fields += [each.field for each in self.maps]
        return Chain("", tuple(f"{name} == other.{name}" for name in fields), " && ")

    @property
    def library(self) -> tuple[str, ...]:
        """The sources of the node's library."""
        own = self.provided.sources if self.provided else (f"src/{self.stem}.cpp",)
        shared = self.runtime.sources(self.runtime_parts)
        custom = (f"src/{custom_stem(scope)}.cpp" for scope, _ in self.custom)
        return tuple(sorted({f"src/{self.stem}_base.cpp", *own, *shared, *custom}))

    @property
    def program(self) -> tuple[str, ...]:
        """The sources of the node's program."""
        own = self.provided.main if self.provided else ()
        return own or (f"src/{self.stem}_main.cpp",)


def custom_stem(scope: str) -> str:
    """Return the stem of the files with the user's functions of a namespace."""
    return scope.replace("::", "_")


@dataclass(frozen=True, slots=True)
class PackageView:
    """The ROS 2 package around one or more nodes.

    Attributes:
        description: on one line.
        libraries: packages needed to build and run, sorted; ``launch`` those to launch.
        copyright: the text above each file; empty for none.
        licence: the licence for manifests.
    """

    name: str
    nodes: tuple[NodeView, ...]
    description: str
    libraries: tuple[str, ...]
    maintainer: str
    email: str
    copyright: str
    licence: str

    @property
    def configured(self) -> bool:
        """Whether there is a parameter file."""
        return any(node.parameters for node in self.nodes)

    @property
    def linters(self) -> tuple[str, ...]:
        """The ament packages that lint this one."""
        checked = ("cppcheck", "cpplint", "flake8", "lint_cmake", "pep257", "uncrustify", "xmllint")
        names = sorted((*checked, "copyright")) if is_checked(self.copyright) else checked
        return tuple(f"ament_cmake_{name}" for name in names)

    def requirement(self, library: str) -> str:
        """Return a library as CMake looks for it: the runtime in the version of this deros."""
        return f"{library} {RUNTIME_VERSION} EXACT" if library == CPP_RUNTIME else library

    def depend(self, library: str) -> str:
        """Return the element of the manifest for a library."""
        version = f' version_eq="{RUNTIME_VERSION}"' if library == CPP_RUNTIME else ""
        return f"<depend{version}>{library}</depend>"

    def targets(self, node: NodeView) -> tuple[str, ...]:
        """Return the CMake targets that one node's library links."""
        return tuple(_TARGETS.get(name, f"${{{name}_TARGETS}}") for name in _needed(node))


def package_view(
    models: tuple[NodeType, ...],
    maintainer: tuple[str, str],
    copyright_line: str,
    licence: str,
    provided: Mapping[str, Provided],
    runtime: CppRuntime,
) -> PackageView:
    """Return the view of the package that ``models``, all of one package, make up.

    Raises:
        GenerationError: if two names collide, in a node or between the nodes.
    """
    nodes = tuple(_node(model, provided.get(model.name), runtime) for model in models)
    package = models[0].package
    pairs = list(zip(models, nodes, strict=True))
    emitted = [*_files(pairs), *_custom_files(models)]
    check_collisions(emitted, f"the sources of package {package}", files=True)
    check_collisions(
        (
            Emitted(name, f"node {model.name!r}", model.name_span)
            for model, node in pairs
            for name in (node.class_name, node.base_class)
        ),
        f"the namespace {package}",
    )
    needed = {each for node in nodes for each in _needed(node)}
    return PackageView(
        name=package,
        nodes=nodes,
        description=printable_line(" ".join(node.summary for node in nodes)),
        libraries=tuple(sorted(needed)),
        maintainer=maintainer[0],
        email=maintainer[1],
        copyright=copyright_line,
        licence=licence,
    )


def _files(pairs: list[tuple[NodeType, NodeView]]) -> Iterator[Emitted]:
    for model, node in pairs:
        for suffix in ("", "_base", "_main"):
            yield Emitted(f"{node.stem}{suffix}", f"node {model.name!r}", model.name_span)


def _custom_files(models: tuple[NodeType, ...]) -> Iterator[Emitted]:
    found: dict[str, Emitted] = {}
    for model in models:
        for function in (each for parameter in model.parameters for each in parameter.custom):
            stem = custom_stem(function.text.rpartition("::")[0])
            origin = f"the namespace of {function.text!r}"
            found.setdefault(stem, Emitted(stem, origin, function.span))
    yield from found.values()


def _needed(node: NodeView) -> tuple[str, ...]:
    needed = {"rclcpp", "rclcpp_components"}
    needed |= {port.type.partition("::")[0] for port in node.ports}
    if node.parameters:
        needed.add("rcl_interfaces")
    if node.lifecycle:
        needed.add("rclcpp_lifecycle")
    if node.actions or node.action_clients:
        needed.add("rclcpp_action")
    if node.provided:
        needed.update(node.provided.needs)
    if node.links_runtime:
        needed.add(CPP_RUNTIME)
    return tuple(sorted(needed))


# Nodes --------------------------------------------------------------------------------------------


def _node(model: NodeType, provided: Provided | None, runtime: CppRuntime) -> NodeView:
    name = (provided and provided.default_name) or model.name
    class_name = camel_case(name)
    check_names(model, class_name, "struct Parameters", cpp_identifier)
    return NodeView(
        name=model.name,
        stem=cpp_identifier(name),
        class_name=class_name,
        default_name=name,
        lifecycle=model.lifecycle,
        source=file_label(model.source.path),
        summary=sentence(model.description) or f"The node {name}.",
        provided=provided,
        runtime=runtime,
        parameters=cpp_parameter_views(model),
        maps=cpp_map_views(model),
        of_kind=ports_by_kind(model, lambda port: _port(port, model, provided)),
        timers=tuple(
            TimerView(
                cpp_identifier(timer.name),
                _period(timer.period_ns),
                period_text(timer.period_ns),
                timer_notes(timer),
            )
            for timer in model.timers
        ),
    )


def _period(nanoseconds: int) -> str:
    count, unit = greatest_unit(nanoseconds, "sec")
    return f"std::chrono::{_CHRONO[unit]}({count})"


def _port(port: Port, model: NodeType, provided: Provided | None) -> PortView:
    kind = cpp_type(port.type)
    topic, topics = cpp_string(port.name), None
    if mapped := mapped_topic(port, model, cpp_identifier):
        topics, topic = f"parameters_->{mapped[0]}", mapped[1]
    elif parameter := topic_parameter(port, model):
        field = f"parameters_->{cpp_identifier(parameter.name)}"
        if model.is_listed(port):
            topic, topics = "topic", field
        else:
            topic = f"{field}.empty() ? {topic} : {field}"
    return PortView(
        identifier=cpp_identifier(port.name),
        handle=client_member(port, model),
        type=kind,
        header=cpp_header(port.type),
        topic=topic,
        name=port.name,
        qos=qos_expression(port.qos),
        notes=port_notes(port, model),
        memory=f"std::make_shared<{provided.memory}<{kind}>>()"
        if provided and provided.memory and port.kind is PortKind.SUBSCRIPTION
        else None,
        topics=topics,
        by_entry=mapped is not None,
    )


def client_member(port: Port, model: NodeType) -> str:
    """Return the data member with the client of a service or action."""
    return f"{handle(port, model, cpp_identifier).rstrip('_')}_"
