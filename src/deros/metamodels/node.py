"""The typed model of a node description (``*.rnd``)."""

from __future__ import annotations

import enum
from collections.abc import Iterator
from dataclasses import dataclass, field

from deros.diagnostics import SourceFile, Span
from deros.interfaces.types import InterfaceType
from deros.metamodels.common import Interval, QosProfile, Value


class ParameterType(enum.Enum):
    """The parameter types of ROS 2 (``rcl_interfaces/msg/ParameterType``)."""

    BOOL = "bool"
    INTEGER = "integer"
    DOUBLE = "double"
    STRING = "string"
    BYTE_ARRAY = "byte[]"
    BOOL_ARRAY = "bool[]"
    INTEGER_ARRAY = "integer[]"
    DOUBLE_ARRAY = "double[]"
    STRING_ARRAY = "string[]"

    @property
    def is_array(self) -> bool:
        """Whether a value is a sequence."""
        return self.value.endswith("[]")


class PortKind(enum.Enum):
    """What a node does at a port; the value is the keyword of its section."""

    PUBLISHER = "publishes"
    SUBSCRIPTION = "subscribes"
    SERVICE = "services"
    CLIENT = "clients"
    ACTION = "actions"
    ACTION_CLIENT = "action_clients"


@dataclass(frozen=True, slots=True)
class Parameter:
    """One declared parameter, its default and its constraints."""

    name: str
    type: ParameterType
    default: Value | None
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    default_span: Span | None = field(default=None, compare=False, repr=False)
    unit: str | None = None
    unit_span: Span | None = field(default=None, compare=False, repr=False)
    interval: Interval | None = None
    interval_span: Span | None = field(default=None, compare=False, repr=False)
    choices: tuple[Value, ...] | None = None
    size: int | None = None
    read_only: bool = False
    description: str = ""


@dataclass(frozen=True, slots=True)
class FieldUnit:
    """A unit annotated on a field path of a port's message."""

    path: str  # as written, "twist.twist.linear.x"
    unit: str
    span: Span = field(compare=False, repr=False)
    unit_span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Port:
    """A topic, service or action end of a node."""

    kind: PortKind
    name: str  # as written: absolute, relative or private
    type: InterfaceType
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    type_span: Span = field(compare=False, repr=False)
    qos: QosProfile | None = None
    via: str | None = None  # the string parameter that holds the topic's name
    via_span: Span | None = field(default=None, compare=False, repr=False)
    units: tuple[FieldUnit, ...] = ()
    description: str = ""


@dataclass(frozen=True, slots=True)
class Timer:
    """A periodic call of the node's own code; the period is nanoseconds."""

    name: str
    period_ns: int
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    description: str = ""


@dataclass(frozen=True, slots=True)
class NodeType:
    """One node type: its package, its parameters and its ports."""

    name: str
    package: str
    source: SourceFile = field(compare=False, repr=False)
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    package_span: Span = field(compare=False, repr=False)
    description: str = ""
    executable: str | None = None  # of an existing binary; None: the node's name
    executable_span: Span | None = field(default=None, compare=False, repr=False)
    lifecycle: bool = False
    parameters: tuple[Parameter, ...] = ()
    ports: tuple[Port, ...] = ()  # all kinds, in the order written
    timers: tuple[Timer, ...] = ()

    @property
    def executable_name(self) -> str:
        """The program of the package that runs this node."""
        return self.executable or self.name

    def parameter(self, name: str) -> Parameter | None:
        """Return the parameter called ``name``, or ``None``."""
        return next((p for p in self.parameters if p.name == name), None)

    def ports_of(self, kind: PortKind) -> Iterator[Port]:
        """Yield the ports of one kind, in the order written."""
        return (port for port in self.ports if port.kind is kind)

    def port(self, name: str) -> Port | None:
        """Return the port that a wiring means by ``name``: with or without its leading ``/``.

        A port of exactly that name comes first, because ``x`` and ``/x`` are two names to ROS 2.
        """
        wanted = name.removeprefix("/")
        alike = [port for port in self.ports if port.name.removeprefix("/") == wanted]
        return next((port for port in alike if port.name == name), alike[0] if alike else None)
