"""What one look at a running graph has seen: nodes, their ends and their parameters.

A snapshot has the names of the graph, absolute and remapped, and nothing that the graph does not
show: no history and depth of an end, no programs and packages, no defaults of parameters.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from deros.models.common import Interval, QosProfile, Value
from deros.models.node import ParameterType, PortKind

VALUE_FIELDS = (
    "bool_value",
    "integer_value",
    "double_value",
    "string_value",
    "byte_array_value",
    "bool_array_value",
    "integer_array_value",
    "double_array_value",
    "string_array_value",
)
"""The fields of a parameter's value in ROS 2, by the numbers of their types, which begin with 1."""


class End(NamedTuple):
    """An end of a topic, service or action at a node.

    Attributes:
        kind: which of the six kinds it is.
        name: the graph name.
        type: in the spelling of ROS 2, ``std_msgs/msg/Bool``.
        qos: of a topic, without history and depth; ``None`` for services and actions.
    """

    kind: PortKind
    name: str
    type: str
    qos: QosProfile | None = None


@dataclass(frozen=True, slots=True)
class SeenParameter:
    """A parameter with its value, and what its descriptor says.

    Attributes:
        constraints: further ones, in the words of the node.
        step: of the range; 0 where every value in it is allowed.
    """

    name: str
    type: ParameterType
    value: Value
    description: str = ""
    constraints: str = ""
    read_only: bool = False
    interval: Interval | None = None
    step: float = 0


@dataclass(frozen=True, slots=True)
class SeenNode:
    """A node by its full name.

    Attributes:
        ends: without those that every node has; sorted.
        parameters: sorted by name; ``None`` if the node has no parameter services or did not
            answer.
        lifecycle: the state of a managed node, ``unknown`` if it did not answer; else ``None``.
        container: whether it loads components.
        count: how many nodes have that name; they are seen as one.
        components: the full names of the nodes that a container has loaded, sorted; ``None`` if it
            did not say, or is not a container.
    """

    full_name: str
    ends: tuple[End, ...] = ()
    parameters: tuple[SeenParameter, ...] | None = None
    lifecycle: str | None = None
    container: bool = False
    count: int = 1
    components: tuple[str, ...] | None = None

    @property
    def name(self) -> str:
        """The last part of its full name."""
        return self.full_name.rpartition("/")[2]

    @property
    def namespace(self) -> str:
        """All before that, ``/`` for the root."""
        return self.full_name.rpartition("/")[0] or "/"


class Unseen(NamedTuple):
    """What of a graph could not be seen, in words.

    Attributes:
        node: the full name of the node that it is about; empty if it is about the whole graph.
        is_of_container: whether it is that a container has no parameter services. Those of ROS 2
            have none, and a system sets no parameters of a container.
    """

    what: str
    node: str = ""
    is_of_container: bool = False

    def __str__(self) -> str:
        """Return the words."""
        return self.what


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The nodes of a graph, sorted by name, and what of them could not be seen."""

    nodes: tuple[SeenNode, ...]
    unseen: tuple[Unseen, ...] = ()
