"""The typed model of a system description (``*.system``), as written.

What a system amounts to at run time (full names, connections) is :mod:`deros.metamodels.flatten`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from deros.diagnostics import SourceFile, Span
from deros.interfaces.types import InterfaceType
from deros.metamodels.common import QosProfile, Value
from deros.metamodels.node import NodeType, PortKind


@dataclass(frozen=True, slots=True)
class Import:
    """An ``import`` line: a path or a glob, and the files that it found, in sorted order."""

    path: str
    files: tuple[str, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Topic:
    """A declared topic; ``type`` is there only when the declaration pins it."""

    name: str  # as written
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    type: InterfaceType | None = None
    type_span: Span | None = field(default=None, compare=False, repr=False)
    qos: QosProfile | None = None
    external: bool = False
    description: str = ""


@dataclass(frozen=True, slots=True)
class ParameterSetting:
    """``param NAME = VALUE`` of a node instance."""

    name: str
    value: Value
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    value_span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Wiring:
    """``connect PORT to TOPIC``: the port, or string parameter, and the graph name, as written.

    ``kind`` says which of the ports of that name is meant; without it, all are.
    """

    port: str
    target: str
    span: Span = field(compare=False, repr=False)
    port_span: Span = field(compare=False, repr=False)
    target_span: Span = field(compare=False, repr=False)
    kind: PortKind | None = None


@dataclass(frozen=True, slots=True)
class Respawn:
    """Restart a node when it exits; ``max_restarts`` ``None`` means without limit."""

    delay_ns: int = 0
    max_restarts: int | None = None


@dataclass(frozen=True, slots=True)
class NodeInstance:
    """A node of the system; ``type`` is ``None`` when no import defines ``type_name``."""

    name: str
    type_name: str
    type: NodeType | None = field(compare=False, repr=False)
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    type_span: Span = field(compare=False, repr=False)
    namespace: str | None = None
    namespace_span: Span | None = field(default=None, compare=False, repr=False)
    parameters: tuple[ParameterSetting, ...] = ()
    wirings: tuple[Wiring, ...] = ()
    respawn: Respawn | None = None
    log_level: str | None = None
    description: str = ""


@dataclass(frozen=True, slots=True)
class Subsystem:
    """A named group of nodes and subsystems, or the use of an imported system.

    ``subsystem left : Arm namespace /left`` has ``system_name`` and, when an import defines it,
    ``system``; it has no topics and members of its own.
    """

    name: str
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    namespace: str | None = None
    namespace_span: Span | None = field(default=None, compare=False, repr=False)
    topics: tuple[Topic, ...] = ()
    members: tuple[NodeInstance | Subsystem, ...] = ()
    system_name: str | None = None
    system_span: Span | None = field(default=None, compare=False, repr=False)
    system: System | None = field(default=None, compare=False, repr=False)
    description: str = ""


@dataclass(frozen=True, slots=True)
class System:
    """A whole system description.

    ``node_types`` and ``systems`` are what its imports define, by name.
    """

    name: str
    source: SourceFile = field(compare=False, repr=False)
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    imports: tuple[Import, ...] = ()
    topics: tuple[Topic, ...] = ()
    members: tuple[NodeInstance | Subsystem, ...] = ()
    node_types: Mapping[str, NodeType] = field(default_factory=dict, compare=False, repr=False)
    systems: Mapping[str, System] = field(default_factory=dict, compare=False, repr=False)
    description: str = ""
