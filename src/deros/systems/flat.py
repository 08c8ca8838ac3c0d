"""The system at run time, as :mod:`deros.systems.flatten` makes it of a system as written."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from deros.models.common import Value
from deros.models.launch_files import LaunchFile, MadeFile
from deros.models.lifecycle import Autostart
from deros.models.node import NodeType, Parameter, ParameterType, Port
from deros.models.parameter_files import FileValue, ParameterFile
from deros.models.programs import ProcessInstance, Remapping, Variable
from deros.models.system import (
    NodeInstance,
    ParameterSetting,
    SafetyInstance,
    Subsystem,
    System,
    Topic,
    Wiring,
)

LISTED_NODES = "node_names"
"""The parameter in which lifecycle managers list their nodes (nav2_lifecycle_manager)."""


@dataclass(frozen=True, slots=True)
class FlatPort:
    """A port of a node at run time.

    ``topic`` is the graph name it ends on. Without a ``wiring`` that is its own name, because ROS 2
    lets an unwired port talk there all the same. The wiring may be one that a ``remap`` of a group
    stands for, which is none of the node's own. ``requested`` is the full name that the node's
    code asks for; where ``sets_parameter``, the wiring has set the topic. If the port is one of
    several, ``entry`` is its name as parameter ``named_by`` has it: a list with their names, or one
    parameter of a map.
    """

    port: Port
    topic: str
    wiring: Wiring | None
    requested: str
    sets_parameter: bool = False
    entry: str | None = None
    named_by: str | None = None


@dataclass(frozen=True, slots=True)
class UntypedWiring:
    """A wiring through a string parameter that no port claims: its topic is known, its type not."""

    wiring: Wiring
    topic: str


@dataclass(frozen=True, slots=True)
class FlatNode:
    """One node of the running system.

    Attributes:
        path: the subsystems that hold it, outermost first.
        parameters: what the system sets, wirings through parameters included.
        remappings: pairs of a port's own name and the graph name it is connected to, one for each
            name, or one for topics and one for services where these go elsewhere. A port ``via`` a
            parameter has none: its wiring sets the parameter.
        frame: the namespace where the system that writes the node begins.
        statement: the ``safety`` statement that the node comes from, if it does.
        environment: variables, of groups and its own.
        autostart: how the node is brought to active when the system is started; ``None``: it is
            not.
        files: its parameter files, in the order in which it reads them. What it gets from them is
            among the ``parameters``, and among those of the ``instance``, with their origin.
        beaten: what the system sets itself and a file overrides, with the value that wins.
        container: the full name of the node that it is loaded into; ``None``: it is a process.
        launch: the ``launch`` statement whose file starts it, if one does.
        process: the full name of the program in whose process it is, as a part of that; ``None``:
            it is a process, or loaded into one; or that program is not known.
        inside: the nodes that are in its process so.
        host: the name of the computer that it runs on, if the system says so.
        awaited_end: the graph name of the service or topic that it waits for, if it does.
    """

    instance: NodeInstance
    type: NodeType | None
    path: tuple[str, ...]
    namespace: str
    full_name: str
    ports: tuple[FlatPort, ...]
    untyped: tuple[UntypedWiring, ...]
    parameters: tuple[tuple[str, Value], ...]
    remappings: tuple[tuple[str, str], ...]
    frame: str = "/"
    statement: SafetyInstance | None = None
    environment: tuple[Variable, ...] = ()
    autostart: Autostart | None = None
    files: tuple[ParameterFile, ...] = ()
    beaten: tuple[tuple[ParameterSetting, FileValue], ...] = ()
    container: str | None = None
    launch: Subsystem | None = None
    process: str | None = None
    inside: tuple[FlatNode, ...] = ()
    host: str = ""
    awaited_end: str = ""

    @property
    def is_started(self) -> bool:
        """Whether the system itself starts it, or has it loaded."""
        return self.launch is None and self.instance.inside is None


@dataclass(frozen=True, slots=True)
class FlatProcess:
    """A process of the running system that is not a node.

    Attributes:
        path: the subsystems that hold it, outermost first.
        environment: variables, of groups and its own.
        position: the number of nodes that stand before it.
        inside: the nodes in it that the system describes, and their parameter files.
        host: the name of the computer that it runs on, if the system says so.
        awaited_end: the graph name of the service or topic that it waits for, if it does.
    """

    instance: ProcessInstance
    path: tuple[str, ...]
    environment: tuple[Variable, ...]
    position: int
    inside: tuple[FlatNode, ...] = ()
    files: tuple[ParameterFile, ...] = ()
    host: str = ""
    awaited_end: str = ""

    @property
    def full_name(self) -> str:
        """The name that tells it from others: with its subsystems, and no leading ``/``."""
        return "/".join((*self.path, self.instance.name))


@dataclass(frozen=True, slots=True)
class FlatLaunch:
    """An existing launch file that is started, with what goes to all nodes that it starts.

    Attributes:
        instance: the ``launch`` statement: it has a ``launch``.
        path: the subsystems that hold it, outermost first.
        namespace: in which its nodes are.
        environment: variables, of groups.
        parameters: those of groups.
        remappings: those of groups, the innermost first.
        files: parameter files, in the order in which they are read.
        position: the number of nodes that stand before it.
        host: the name of the computer that it is started on, if the system says so.
    """

    instance: Subsystem
    path: tuple[str, ...]
    namespace: str
    environment: tuple[Variable, ...]
    parameters: tuple[ParameterSetting, ...]
    remappings: tuple[Remapping, ...]
    files: tuple[ParameterFile, ...]
    position: int
    host: str = ""

    @property
    def launch(self) -> LaunchFile:
        """The file, and the arguments that it gets."""
        assert self.instance.launch is not None
        return self.instance.launch

    @property
    def full_name(self) -> str:
        """The name that tells it from others: with its subsystems, and no leading ``/``."""
        return "/".join((*self.path, self.instance.name))


FlatProgram = FlatNode | FlatProcess | FlatLaunch
"""What is started, or a node that a launch file starts."""


@dataclass(frozen=True, slots=True)
class FlatTopic:
    """A declared topic under its graph name."""

    name: str
    declaration: Topic
    path: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class FlatSystem:
    """All nodes, topics and processes of a system, imports expanded, in the order written.

    ``others``: what is started and is not a node. ``files``: all parameter files that it names,
    also those that no node reads; ``made``: those that are made. Among the nodes are those that
    launch files start, as far as the system describes them.
    """

    system: System
    nodes: tuple[FlatNode, ...]
    topics: tuple[FlatTopic, ...]
    others: tuple[FlatProcess | FlatLaunch, ...] = ()
    files: tuple[ParameterFile, ...] = ()
    made: tuple[MadeFile, ...] = ()

    def topic(self, name: str) -> FlatTopic | None:
        """Return the first declaration of the graph name ``name``, or ``None``."""
        return next((topic for topic in self.topics if topic.name == name), None)

    @property
    def processes(self) -> tuple[FlatProcess, ...]:
        """The processes that are not nodes, in the order written."""
        return tuple(each for each in self.others if isinstance(each, FlatProcess))

    @property
    def launches(self) -> tuple[FlatLaunch, ...]:
        """The launch files that are started, in the order written."""
        return tuple(each for each in self.others if isinstance(each, FlatLaunch))

    @property
    def programs(self) -> Iterator[FlatProgram]:
        """All that is to be started, in the order written."""
        return (p for p in self.parts if not isinstance(p, FlatNode) or p.is_started)

    @property
    def parts(self) -> Iterator[FlatProgram]:
        """All nodes, processes and launch files, in the order written."""
        waiting = list(reversed(self.others))
        for number, node in enumerate(self.nodes):
            while waiting and waiting[-1].position <= number:
                yield waiting.pop()
            yield node
        yield from reversed(waiting)


def is_topic_parameter(node_type: NodeType, name: str) -> bool:
    """Return whether ``name`` is a string parameter of the type: it may hold a topic's name."""
    parameter = node_type.parameter(name)
    return (
        parameter is not None
        and parameter.type is ParameterType.STRING
        and not parameter.keys  # its values are set by ``param``, one for each entry
    )


def entries_of(
    node_type: NodeType, parameter: Parameter, settings: Mapping[str, Value]
) -> tuple[str, ...] | None:
    """Return the entries that ``gains.<joints>.p`` is declared for; ``None`` if not known."""
    key = node_type.parameter(parameter.keys[0])
    value = settings.get(parameter.keys[0], key.default if key is not None else None)
    if not isinstance(value, tuple):
        return None
    return tuple(entry for entry in value if isinstance(entry, str))


def listed_nodes(node: FlatNode) -> tuple[str, ...]:
    """Return the nodes that a lifecycle manager lists in its parameter, as written there."""
    parameter = node.type.parameter(LISTED_NODES) if node.type is not None else None
    default = parameter.default if parameter is not None else None
    listed = dict(node.parameters).get(LISTED_NODES, default)
    if not isinstance(listed, tuple):
        return ()
    return tuple(name for name in listed if isinstance(name, str))
