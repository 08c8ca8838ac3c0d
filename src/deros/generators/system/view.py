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
    arguments_of,
)
from deros.generators.system.described import XacroView, described, made_views
from deros.generators.system.descriptions import collapse_whitespace, description_of
from deros.generators.system.expanded import expanded
from deros.generators.system.files import FileView, parameter_file_view
from deros.generators.system.hosts import HostView, host_view
from deros.generators.system.launched import LaunchView, launch_view, unsupported_launch
from deros.generators.system.programs import InsideView, NodeView, ProcessView
from deros.generators.system.settings import (
    environment_of,
    marked_text,
    setting_of,
    value_as_written,
    word_text,
)
from deros.generators.system.unsupported import (
    from_files,
    is_default_that_has_no_spelling,
    unread_files,
    unsupported,
)
from deros.generators.system.waiting.wait_view import WaitView
from deros.generators.system.waiting.waits import Waits
from deros.generators.text.identifiers import Emitted, check_collisions
from deros.interfaces.durations import NS_PER_S
from deros.models.arguments import Condition, Lookup
from deros.models.node import BUILT_IN_PARAMETERS, NodeType, Parameter
from deros.models.starting import AT_ONCE
from deros.models.system import System
from deros.names.graph_names import from_root, resolve_name
from deros.systems.arguments.symbolic import SymbolicNode, SymbolicSystem, as_written
from deros.systems.flat import FlatLaunch, FlatNode, FlatProcess, FlatProgram
from deros.systems.flatten import flatten
from deros.systems.remapping import ACTION_KINDS, ACTION_SERVICES, ACTION_TOPICS

__all__ = [
    "ACTION_PARTS",
    "GroupView",
    "NodeView",
    "ProcessView",
    "ProgramView",
    "SystemView",
    "snake_case",
    "system_view",
]

ACTION_PARTS = (*ACTION_SERVICES, *ACTION_TOPICS)
"""Services and topics that an action consists of (ROS 2 design, "Actions")."""


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
        hosts: the computers that its programs are on, if it says so.
    """

    name: str
    stem: str
    description: str
    groups: tuple[GroupView, ...]
    arguments: tuple[Parameter, ...] = ()
    folder: Path = Path()
    looks_up: bool = False
    made: tuple[tuple[Lookup, XacroView], ...] = ()
    hosts: tuple[HostView, ...] = ()

    @property
    def arguments_in_names(self) -> set[str]:
        """The arguments of which names in the ROS graph are made."""
        names = [n for each in self._named for pair in each.remappings for n in pair]
        ends = (each.name for each in self.waits if not each.ready.names_program)
        return arguments_of([*names, *ends])

    @property
    def arguments_in_namespaces(self) -> set[str]:
        """The arguments of which namespaces are made."""
        return arguments_of(each.namespace for each in self._named)

    @property
    def reads_files(self) -> bool:
        """Whether a node of it, or a launch file, has parameter files."""
        return any(each.files for each in self.programs)

    @property
    def shares(self) -> bool:
        """Whether several nodes are parts of one program."""
        programs = (each for each in self.programs if not isinstance(each, LaunchView))
        return any(each.inside for each in programs)

    @property
    def _named(self) -> Iterator[NodeView | LaunchView | InsideView]:
        """All that has a namespace and remappings."""
        yield from self.nodes
        yield from self.launches
        for each in self.programs:
            if not isinstance(each, LaunchView):
                yield from each.inside

    @property
    def makes_files(self) -> bool:
        """Whether files are made before anything is started."""
        made = self.moves_keys, self.reads_plain_files, self.substitutes
        return any(made) or bool(self.made)

    @property
    def moves_keys(self) -> bool:
        """Whether the keys of parameter files are moved."""
        return any(file.below is not None for each in self.programs for file in each.files)

    @property
    def reads_plain_files(self) -> bool:
        """Whether there are parameter files without names of nodes."""
        return any(file.plain is not None for each in self.programs for file in each.files)

    @property
    def substitutes(self) -> bool:
        """Whether something is substituted in parameter files."""
        return any(file.given is not None for each in self.programs for file in each.files)

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
    def waits(self) -> tuple[WaitView, ...]:
        """What programs wait for in the ROS graph."""
        found = (each.wait for each in self.programs if not isinstance(each, LaunchView))
        return tuple(each for each in found if each is not None)

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
    system: System,
    *,
    with_files: bool = False,
    root: str = "/",
    everywhere: System | None = None,
) -> SystemView:
    """Return the nodes and processes to start.

    Args:
        system: the system.
        with_files: whether the values in parameter files are among the parameters, too.
        root: the namespace that it is started in.
        everywhere: the system before its programs were placed on hosts, if they were.

    Raises:
        GenerationError: if a node's type is unknown, two nodes have one full name, or a node is to
            be given a parameter that ROS 2 has no way to give at start, or the conditions differ in
            too many ways.
    """
    flat = flatten(system, root)
    symbolic = expanded(system, root) if system.is_computed else None
    always = (SymbolicNode(program, None) for program in flat.programs)
    everything = always if symbolic is None else symbolic.nodes
    known = [e for e in everything if not isinstance(e.node, FlatNode) or not e.node.launch]
    faults = [fault for each in known for fault in _unsupported(each.node)]
    if faults:
        raise GenerationError(faults)
    check_collisions(map(_emitted, flat.nodes), "the ROS graph")
    found = [e for e in known if not isinstance(e.node, FlatNode) or e.node.is_started]
    waits = Waits(everywhere or system, root) if any(map(_waits, found)) else None
    groups = []
    for path, programs in itertools.groupby(found, key=lambda each: each.node.path):
        views = tuple(_program(each, symbolic, system, with_files, waits) for each in programs)
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
        tuple(map(host_view, system.hosts)),
    )


def snake_case(name: str) -> str:
    """Return a name in lower case with its words parted: ``RobotSafety`` is ``robot_safety``."""
    parted = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name)
    return re.sub(r"_+", "_", parted).lower()


def _emitted(node: FlatNode) -> Emitted:
    name = node.instance.name
    return Emitted(from_root(node.full_name), f"node {name!r}", node.instance.name_span)


def _unsupported(program: FlatProgram) -> Iterator[Diagnostic]:
    if isinstance(program, FlatNode):
        yield from unsupported(program)
    elif isinstance(program, FlatLaunch):
        yield from unsupported_launch(program)


def _waits(each: SymbolicNode) -> bool:
    return not isinstance(each.node, FlatLaunch) and each.node.instance.starting.ready is not None


def _program(
    each: SymbolicNode,
    symbolic: SymbolicSystem | None,
    system: System,
    with_files: bool,
    waits: Waits | None,
) -> ProgramView:
    if isinstance(each.node, FlatProcess):
        process = _process(each.node, each.when, symbolic, system, with_files)
        return process if waits is None else waits.added(process, each.node, symbolic)
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
    if each.node.inside:
        node = replace(node, inside=_inside(each.node, symbolic, with_files))
    node = replace(node, described=made) if made else node
    return node if waits is None else waits.added(node, each.node, symbolic)


def _inside(
    program: FlatNode | FlatProcess, symbolic: SymbolicSystem | None, with_files: bool
) -> tuple[InsideView, ...]:
    """Return the nodes in the process of a program."""
    found = []
    for node in program.inside:
        without = frozenset() if with_files else from_files(node)
        view = _node(node, None, symbolic, (), without)
        found.append(InsideView(view.name, view.namespace, view.parameters, view.remappings))
    return tuple(found)


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

    def written(name: str) -> Text:
        return marked_text(as_written(name), symbolic)

    return NodeView(
        name=instance.name,
        namespace=marked_text(node.namespace, symbolic),
        package=node_type.package,
        executable=node_type.executable_name,
        lifecycle=node_type.lifecycle,
        parameters=tuple(
            pair for pair in _parameters(node, node_type, symbolic) if pair[0] not in without
        ),
        remappings=tuple((written(name), written(target)) for name, target in _remappings(node)),
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
        container=None if node.container is None else written(node.container),
        plugin=str(instance.component or "") if not is_process else "",
        intra_process=not is_process and instance.intra_process is not None,
        address=written(node.full_name) if instance.is_container else None,
        starting=instance.starting if is_process else AT_ONCE,
        own_name=is_process and instance.own_name is not None,
    )


def _process(
    process: FlatProcess,
    when: Condition | None,
    symbolic: SymbolicSystem | None,
    system: System,
    with_files: bool,
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
        inside=_inside(process, symbolic, with_files),
        files=tuple(
            parameter_file_view(file, system, lambda text: marked_text(text, symbolic))
            for file in process.files
        ),
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
        yield name, setting_of(value, kind, symbolic)


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
