"""Nodes that share a process: what a container loads into its own, and what a program makes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from deros.diagnostics import SourceFile, Span
from deros.models.arguments import Condition, Expression
from deros.models.node import NodeType

ContainerKind = Literal["single_threaded", "multi_threaded", "isolated"]

_PACKAGE = "rclcpp_components"
_PROGRAMS: dict[ContainerKind, str] = {
    "single_threaded": "component_container",
    "multi_threaded": "component_container_mt",
    "isolated": "component_container_isolated",
}


@dataclass(frozen=True, slots=True)
class IntraProcess:
    """``intra_process [if CONDITION]``: messages go to others in the container by pointers."""

    span: Span = field(compare=False, repr=False)
    when: Condition | None = None


@dataclass(frozen=True, slots=True)
class OtherType:
    """The type that a container has in place of its usual one where a condition holds."""

    type: NodeType
    when: Condition


CONTAINER = "container"
"""The name of the type that containers have in place of one that is described in a file."""


@dataclass(frozen=True, slots=True)
class Into:
    """``into CONTAINER [when CONDITION]``: the node is loaded into a container, if that holds.

    Where the condition fails, the node runs as a process of its own.

    Attributes:
        container: its graph name, as written.
        is_computed: the name has been computed.
        braces: the place of the name of the container in whose braces the node stands; without
            them, ``None``.
    """

    container: str
    span: Span = field(compare=False, repr=False)
    container_span: Span = field(compare=False, repr=False)
    container_from: Expression | None = None
    when: Condition | None = None
    is_computed: bool = False
    braces: Span | None = None


@dataclass(frozen=True, slots=True)
class Inside:
    """``inside PROCESS { node … }``: the node is a part of what another program runs.

    Attributes:
        process: the name of the node, container or process, as written.
        owners: the places of the names of what is called so in the innermost group around that has
            the name; several, where each has a condition. Empty, if nothing is called so.
        levels: how many groups lie between the node and its owners.
    """

    process: str
    process_span: Span = field(compare=False, repr=False)
    owners: tuple[Span, ...] = field(default=(), compare=False, repr=False)
    levels: int = 0

    def places(self, path: tuple[str, ...]) -> tuple[tuple[tuple[str, ...], Span], ...]:
        """Return path and place of each owner, given the subsystems that hold the node."""
        around = path[: len(path) - self.levels]
        return tuple((around, span) for span in self.owners)


def usual_class(package: str, name: str) -> str:
    """Return the class of C++ that the node type of a name usually is."""
    words = (word[0].upper() + word[1:] for word in name.split("_") if word)
    return f"{package}::{''.join(words)}"


def container_type(kind: ContainerKind, source: SourceFile, span: Span) -> NodeType:
    """Return the type of a container: a program of rclcpp_components, itself a node.

    Args:
        kind: how it runs the callbacks of its nodes.
        source: the file in which the container is written.
        span: its place there, in place of that of a description.
    """
    return NodeType(
        CONTAINER,
        _PACKAGE,
        source,
        span,
        span,
        span,
        executable=_PROGRAMS[kind],
        takes_any_parameter=True,
    )
