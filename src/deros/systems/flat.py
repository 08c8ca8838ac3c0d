"""The system at run time, as :mod:`deros.systems.flatten` makes it of a system as written."""

from __future__ import annotations

from dataclasses import dataclass

from deros.models.common import Value
from deros.models.node import NodeType, ParameterType, Port
from deros.models.system import NodeInstance, SafetyInstance, System, Topic, Wiring


@dataclass(frozen=True, slots=True)
class FlatPort:
    """A port of a node at run time.

    ``topic`` is the graph name it ends on. Without a ``wiring`` that is its own name, because ROS 2
    lets an unwired port talk there all the same. ``requested`` is the full name that the node's
    code asks for; where ``sets_parameter``, the wiring has set the topic. ``entry`` is that of the
    list parameter which the port stands for, if it is one of several.
    """

    port: Port
    topic: str
    wiring: Wiring | None
    requested: str
    sets_parameter: bool = False
    entry: str | None = None


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


@dataclass(frozen=True, slots=True)
class FlatTopic:
    """A declared topic under its graph name."""

    name: str
    declaration: Topic
    path: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class FlatSystem:
    """All nodes and declared topics of a system, imports expanded, in the order written."""

    system: System
    nodes: tuple[FlatNode, ...]
    topics: tuple[FlatTopic, ...]

    def topic(self, name: str) -> FlatTopic | None:
        """Return the first declaration of the graph name ``name``, or ``None``."""
        return next((topic for topic in self.topics if topic.name == name), None)


def is_topic_parameter(node_type: NodeType, name: str) -> bool:
    """Return whether ``name`` is a string parameter of the type: it may hold a topic's name."""
    parameter = node_type.parameter(name)
    return parameter is not None and parameter.type is ParameterType.STRING
