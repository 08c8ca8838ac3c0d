"""The view of a system: the nodes and processes to start, each with all that it is started with.

What the system computes from its arguments is :class:`Computed` here.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from deros.diagnostics import Diagnostic
from deros.generators.api.protocol import GenerationError
from deros.generators.system.computed import (
    Setting,
    Text,
    Variables,
    arguments_of,
    plain_settings,
)
from deros.generators.system.described import XacroView, described, made_views
from deros.generators.system.descriptions import collapse_whitespace, description_of
from deros.generators.system.expanded import expanded
from deros.generators.system.files import FileView, parameter_file_view
from deros.generators.system.launched import LaunchView, launch_view, unsupported_launch
from deros.generators.system.settings import (
    environment_of,
    marked_text,
    setting_of,
    value_as_declared,
    value_as_written,
    word_text,
)
from deros.generators.system.unsupported import (
    from_files,
    is_default_that_has_no_spelling,
    unread_files,
    unsupported,
)
from deros.generators.text.identifiers import Emitted, check_collisions
from deros.interfaces.durations import NS_PER_S
from deros.models.arguments import Condition, Lookup
from deros.models.common import Value
from deros.models.lifecycle import Autostart
from deros.models.node import BUILT_IN_PARAMETERS, NodeType, Parameter
from deros.models.starting import AT_ONCE, Starting
from deros.models.system import System
from deros.names.graph_names import from_root, resolve_name
from deros.systems.arguments.symbolic import SymbolicNode, SymbolicSystem, as_written
from deros.systems.flat import FlatLaunch, FlatNode, FlatProcess, FlatProgram
from deros.systems.flatten import flatten
from deros.systems.remapping import ACTION_KINDS, ACTION_SERVICES, ACTION_TOPICS

ACTION_PARTS = (*ACTION_SERVICES, *ACTION_TOPICS)
"""Services and topics that an action consists of (ROS 2 design, "Actions")."""


@dataclass(frozen=True, slots=True)
class NodeView:
    """One node to start.

    Attributes:
        when: the condition of the node in this form; ``None``: it is always started.
        parameters: what the system sets, each value of the type that the node declares.
        files: parameter files, which the node reads before.
        remappings: pairs of a name in the node's code and a graph name, only where they differ;
            the first may start with ``rostopic://`` or ``rosservice://``.
        respawn_delay: seconds until it is started again; ``None``: it is not.
        respawn_max: how often that is done; ``None``: without limit.
        autostart: how it is brought to active when the system is started; ``None``: it is not.
        arguments: of the program, before those of ROS 2.
        environment: variables for the program alone.
        prefix: words before the program, as a shell would take them apart.
        container: the full name of the node that it is loaded into; ``None``: it is a process.
        plugin: the class that is loaded, if it is.
        intra_process: whether it exchanges messages with others in its container by pointers.
        address: of a container, its full name.
        starting: when it is started, and whether its exit stops all.
        described: parameters whose values xacro makes when the system is started.
    """

    name: str
    namespace: Text
    package: str
    executable: str
    lifecycle: bool
    parameters: tuple[tuple[str, Setting], ...]
    remappings: tuple[tuple[str, Text], ...]
    log_level: str | None
    respawn_delay: float | None
    respawn_max: int | None
    description: str
    when: Condition | None = None
    arguments: tuple[Text, ...] = ()
    environment: Variables = ()
    prefix: Text | None = None
    autostart: Autostart | None = None
    files: tuple[FileView, ...] = ()
    container: Text | None = None
    plugin: str = ""
    intra_process: bool = False
    address: Text | None = None
    starting: Starting = AT_ONCE
    described: tuple[tuple[str, XacroView], ...] = ()

    @property
    def is_node(self) -> bool:
        """Whether it is a node, and no other process."""
        return True

    @property
    def full_name(self) -> str:
        """The node's name in the ROS graph; not of one whose namespace is computed."""
        assert isinstance(self.namespace, str)
        return resolve_name(self.name, self.namespace)

    @property
    def plain_parameters(self) -> Iterator[tuple[str, Value]]:
        """The parameters of a node for which nothing is computed."""
        return plain_settings(self.parameters)

    @property
    def logger(self) -> str:
        """The name of the node's own logger, as rcl makes it from the full name."""
        return self.full_name.removeprefix("/").replace("/", ".")


@dataclass(frozen=True, slots=True)
class ProcessView:
    """One process to start that is not a node; the fields are those of :class:`NodeView`.

    Attributes:
        program: a name that is looked up in the ``PATH``, or a path.
        folder: that it runs in; ``None``: that of whoever starts the system.
    """

    name: str
    program: Text
    arguments: tuple[Text, ...]
    environment: Variables
    prefix: Text | None
    folder: Text | None
    respawn_delay: float | None
    respawn_max: int | None
    description: str
    when: Condition | None = None
    starting: Starting = AT_ONCE

    @property
    def is_node(self) -> bool:
        """Whether it is a node, and no other process."""
        return False


ProgramView = NodeView | ProcessView | LaunchView


@dataclass(frozen=True, slots=True)
class GroupView:
    """What follows each other in one subsystem; the path of the system's own is empty."""

    path: tuple[str, ...]
    description: str
    programs: tuple[ProgramView, ...]

    @property
    def nodes(self) -> tuple[NodeView, ...]:
        """Those that are nodes."""
        return tuple(each for each in self.programs if isinstance(each, NodeView))


@dataclass(frozen=True, slots=True)
class SystemView:
    """All nodes and processes of a system, in the order written.

    Attributes:
        name: of the system.
        stem: the start of the names of files made from it.
        description: the first line of what its author says about it, or nothing.
        arguments: that are to be given when it is started.
        folder: of the file that describes it.
        looks_up: whether something is to be found out where it is started, a default included.
        made: the files that xacro makes, each with how.
    """

    name: str
    stem: str
    description: str
    groups: tuple[GroupView, ...]
    arguments: tuple[Parameter, ...] = ()
    folder: Path = Path()
    looks_up: bool = False
    made: tuple[tuple[Lookup, XacroView], ...] = ()

    @property
    def arguments_in_names(self) -> set[str]:
        """The arguments of which names in the ROS graph are made."""
        programs: list[NodeView | LaunchView] = [*self.nodes, *self.launches]
        return arguments_of(target for each in programs for _, target in each.remappings)

    @property
    def arguments_in_namespaces(self) -> set[str]:
        """The arguments of which namespaces are made."""
        programs: list[NodeView | LaunchView] = [*self.nodes, *self.launches]
        return arguments_of(each.namespace for each in programs)

    @property
    def reads_files(self) -> bool:
        """Whether a node of it, or a launch file, has parameter files."""
        programs: list[NodeView | LaunchView] = [*self.nodes, *self.launches]
        return any(each.files for each in programs)

    @property
    def makes_files(self) -> bool:
        """Whether files are made before anything is started."""
        return self.moves_keys or bool(self.made)

    @property
    def moves_keys(self) -> bool:
        """Whether the keys of parameter files are moved."""
        programs: list[NodeView | LaunchView] = [*self.nodes, *self.launches]
        return any(file.below is not None for each in programs for file in each.files)

    @property
    def describes(self) -> bool:
        """Whether xacro makes values of parameters when the system is started."""
        return any(node.described for node in self.nodes)

    @property
    def brings_up(self) -> bool:
        """Whether managed nodes are brought to active when the system is started."""
        return any(node.autostart is not None for node in self.nodes)

    @property
    def starts_later(self) -> bool:
        """Whether a program is started after the others."""
        return any(each.starting.is_later for each in self.programs)

    @property
    def nodes(self) -> Iterator[NodeView]:
        """All nodes of all groups."""
        return itertools.chain.from_iterable(group.nodes for group in self.groups)

    @property
    def launches(self) -> Iterator[LaunchView]:
        """All launch files of all groups."""
        return (each for each in self.programs if isinstance(each, LaunchView))

    @property
    def programs(self) -> Iterator[ProgramView]:
        """All that is to be started, of all groups."""
        return itertools.chain.from_iterable(group.programs for group in self.groups)


def system_view(
    system: System, *, with_files: bool = False, loads_files: bool = False, root: str = "/"
) -> SystemView:
    """Return the nodes and processes to start.

    Args:
        system: the system.
        with_files: whether the values in parameter files are among the parameters, too.
        root: the namespace that it is started in.
        loads_files: whether a node in a container has the files that cannot be read before the
            start; else there is no view of it.

    Raises:
        GenerationError: if a node's type is unknown, two nodes have one full name, or a node is to
            be given a parameter that ROS 2 has no way to give at start, or the conditions differ in
            too many ways.
    """
    flat = flatten(system, root)
    symbolic = expanded(system, root) if system.is_computed else None
    always = (SymbolicNode(program, None) for program in flat.programs)
    everything = always if symbolic is None else symbolic.nodes
    found = tuple(e for e in everything if not isinstance(e.node, FlatNode) or not e.node.launch)
    faults = [fault for each in found for fault in _unsupported(each.node, loads_files)]
    if faults:
        raise GenerationError(faults)
    check_collisions(map(_emitted, flat.nodes), "the ROS graph")
    groups = []
    for path, programs in itertools.groupby(found, key=lambda each: each.node.path):
        views = tuple(_program(each, symbolic, system, with_files) for each in programs)
        groups.append(GroupView(path, description_of(system, path), views))
    return SystemView(
        system.name,
        snake_case(system.name),
        collapse_whitespace(system.description),
        tuple(groups),
        system.arguments,
        Path(system.source.path).absolute().parent,
        (symbolic is not None and symbolic.looks_up)
        or any(each.default_from is not None for each in system.arguments),
        () if symbolic is None else made_views(symbolic.made, system),
    )


def snake_case(name: str) -> str:
    """Return a name in lower case with its words parted: ``RobotSafety`` is ``robot_safety``."""
    parted = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name)
    return re.sub(r"_+", "_", parted).lower()


def _emitted(node: FlatNode) -> Emitted:
    name = node.instance.name
    return Emitted(from_root(node.full_name), f"node {name!r}", node.instance.name_span)


def _unsupported(program: FlatProgram, loads_files: bool) -> Iterator[Diagnostic]:
    if isinstance(program, FlatNode):
        yield from unsupported(program, loads_files=loads_files)
    elif isinstance(program, FlatLaunch):
        yield from unsupported_launch(program)


def _program(
    each: SymbolicNode, symbolic: SymbolicSystem | None, system: System, with_files: bool
) -> ProgramView:
    if isinstance(each.node, FlatProcess):
        return _process(each.node, each.when, symbolic)
    if isinstance(each.node, FlatLaunch):
        return launch_view(
            each.node,
            each.when,
            system,
            lambda text: marked_text(text, symbolic),
            lambda value: setting_of(value_as_written(value), None, symbolic),
        )
    passes_values = each.node.container is not None and not unread_files(each.node)
    read = () if passes_values else each.node.files
    files = tuple(
        parameter_file_view(statement, system, lambda text: marked_text(text, symbolic))
        for statement in read
    )
    made = described(each.node, system, lambda text: marked_text(text, symbolic))
    without = frozenset() if with_files else from_files(each.node)
    without |= {name for name, _ in made}
    node = _node(each.node, each.when, symbolic, files, without)
    return replace(node, described=made) if made else node


def _node(
    node: FlatNode,
    when: Condition | None,
    symbolic: SymbolicSystem | None,
    files: tuple[FileView, ...],
    without: frozenset[str],
) -> NodeView:
    instance, node_type = node.instance, node.type
    assert node_type is not None  # else it is unsupported
    is_process = node.container is None
    respawn = instance.respawn if is_process else None
    return NodeView(
        name=instance.name,
        namespace=marked_text(node.namespace, symbolic),
        package=node_type.package,
        executable=node_type.executable_name,
        lifecycle=node_type.lifecycle,
        parameters=tuple(
            pair for pair in _parameters(node, node_type, symbolic) if pair[0] not in without
        ),
        remappings=tuple(
            (name, marked_text(as_written(target), symbolic)) for name, target in _remappings(node)
        ),
        log_level=instance.log_level if is_process else None,
        respawn_delay=respawn.delay_ns / NS_PER_S if respawn else None,
        respawn_max=respawn.max_restarts if respawn else None,
        description=collapse_whitespace(instance.description or node_type.description),
        when=when,
        arguments=tuple(word_text(each, symbolic) for each in instance.arguments if is_process),
        environment=environment_of(node.environment if is_process else (), symbolic),
        prefix=word_text(instance.prefix, symbolic) if instance.prefix and is_process else None,
        autostart=node.autostart,
        files=files,
        container=None
        if node.container is None
        else marked_text(as_written(node.container), symbolic),
        plugin=str(instance.component or "") if not is_process else "",
        intra_process=not is_process and instance.intra_process is not None,
        address=marked_text(as_written(node.full_name), symbolic)
        if instance.is_container
        else None,
        starting=instance.starting if is_process else AT_ONCE,
    )


def _process(
    process: FlatProcess, when: Condition | None, symbolic: SymbolicSystem | None
) -> ProcessView:
    instance, respawn = process.instance, process.instance.respawn
    return ProcessView(
        name=instance.name,
        program=word_text(instance.program, symbolic),
        arguments=tuple(word_text(each, symbolic) for each in instance.arguments),
        environment=environment_of(process.environment, symbolic),
        prefix=None if instance.prefix is None else word_text(instance.prefix, symbolic),
        folder=None if instance.folder is None else word_text(instance.folder, symbolic),
        respawn_delay=respawn.delay_ns / NS_PER_S if respawn else None,
        respawn_max=respawn.max_restarts if respawn else None,
        description=collapse_whitespace(instance.description),
        when=when,
        starting=instance.starting,
    )


def _parameters(
    node: FlatNode, node_type: NodeType, symbolic: SymbolicSystem | None
) -> Iterator[tuple[str, Setting]]:
    for name, setting in node.parameters:
        declared = node_type.parameter_for(name)
        value = value_as_written(setting)
        if is_default_that_has_no_spelling(declared, value):
            continue
        kind = declared.type if declared is not None else BUILT_IN_PARAMETERS.get(name)
        found = setting_of(value, kind, symbolic)
        yield name, value_as_declared(value, declared) if found == value else found


def _remappings(node: FlatNode) -> Iterator[tuple[str, str]]:
    """Yield the remappings, those of an action with all its parts.

    rcl learned to remap an action's own name only after Jazzy; there its parts have to be remapped.
    """
    actions = {port.port.name for port in node.ports if port.port.kind in ACTION_KINDS}
    for source, target in node.remappings:
        scheme, _, name = source.rpartition("://")
        if resolve_name(name, node.namespace, node.instance.name) == target:
            continue
        yield source, target
        if name in actions and scheme != "rosservice":
            for part in ACTION_PARTS:
                yield f"{name}/_action/{part}", f"{target}/_action/{part}"
