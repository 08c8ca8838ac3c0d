"""The typed model of a node description (``*.rnd``)."""

from __future__ import annotations

import enum
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from deros.diagnostics import SourceFile, Span
from deros.interfaces.fields import parse_path, without_indices
from deros.interfaces.types import InterfaceType
from deros.models.arguments import Expression
from deros.models.common import Interval, Name, QosProfile, Scalar, Value

_PLACEHOLDER = re.compile(r"<([^<>]*)>")


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


def as_double(value: Value, kind: ParameterType) -> Value:
    """Return an integer value of a double parameter as a double."""
    if kind is ParameterType.DOUBLE and type(value) is int:
        return float(value)
    if kind is ParameterType.DOUBLE_ARRAY and isinstance(value, tuple):
        return tuple(float(item) if type(item) is int else item for item in value)
    return value


class PortKind(enum.Enum):
    """The kind of a port; the value is the keyword of its section."""

    PUBLISHER = "publishes"
    SUBSCRIPTION = "subscribes"
    SERVICE = "services"
    CLIENT = "clients"
    ACTION = "actions"
    ACTION_CLIENT = "action_clients"

    @property
    def word(self) -> str:
        """The word for the kind before a port's name in a wiring."""
        return _KIND_WORDS[self]


_KIND_WORDS = {
    PortKind.PUBLISHER: "publisher",
    PortKind.SUBSCRIPTION: "subscriber",
    PortKind.SERVICE: "service",
    PortKind.CLIENT: "client",
    PortKind.ACTION: "action",
    PortKind.ACTION_CLIENT: "action_client",
}
KINDS_BY_WORD = {word: kind for kind, word in _KIND_WORDS.items()}


BUILT_IN_PARAMETERS: Mapping[str, ParameterType] = {
    "use_sim_time": ParameterType.BOOL,
    "start_type_description_service": ParameterType.BOOL,
}
"""Parameters that every ROS 2 node has without declaring them."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """One declared parameter, its default and its constraints.

    Attributes:
        interval: the range of a number, or of each element; a bound that is not given is infinite.
        choices: the allowed values, or those of each element.
        size, min_size, max_size: numbers of elements, or of a text's characters.
        custom: functions of the user's, ``ns::function``, that check the value further.
        default_from: of an argument of a system whose default is computed; it has no ``default``.
    """

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
    choices: tuple[Scalar, ...] | None = None
    size: int | None = None
    min_size: int | None = None
    max_size: int | None = None
    not_empty: bool = False
    unique: bool = False
    custom: tuple[Name, ...] = ()
    read_only: bool = False
    description: str = ""
    default_from: Expression | None = None

    @property
    def has_default(self) -> bool:
        """Whether it need not be given."""
        return self.default is not None or self.default_from is not None

    @property
    def keys(self) -> tuple[str, ...]:
        """The parameters whose entries it is declared for: ``joints`` of ``gains.<joints>.p``."""
        return tuple(_PLACEHOLDER.findall(self.name)) if "<" in self.name else ()

    @property
    def least_size(self) -> int:
        """The fewest elements, or characters, that the constraints allow."""
        return max(self.size or 0, self.min_size or 0, int(self.not_empty))

    def name_for(self, entry: str) -> str:
        """Return the name that the parameter has for one entry of its key."""
        return _PLACEHOLDER.sub(lambda _: entry, self.name, 1)

    def entry_of(self, name: str) -> str | None:
        """Return the entry for which the parameter is called ``name``; ``None`` for no entry."""
        before, opening, rest = self.name.partition("<")
        after = rest.partition(">")[2]
        entry = name.removeprefix(before).removesuffix(after)
        return entry if opening and entry and f"{before}{entry}{after}" == name else None


@dataclass(frozen=True, slots=True)
class FieldUnit:
    """A unit annotated on a field path of a port's message; an angle may be ``wrapping``."""

    path: str  # as written, "twist.twist.linear.x"
    unit: str
    span: Span = field(compare=False, repr=False)
    unit_span: Span = field(compare=False, repr=False)
    wrapping: bool = False

    @property
    def field_path(self) -> tuple[str, ...]:
        """The path without indices: elements share their unit."""
        return without_indices(parse_path(self.path))


TRANSFORMS = "tf2_msgs.TFMessage"
"""The type of the messages in which frames are broadcast."""


@dataclass(frozen=True, slots=True)
class FrameName:
    """The name of a tf2 frame; ``<x>`` in it stands for the value of string parameter ``x``."""

    text: str  # as written
    span: Span = field(compare=False, repr=False)

    @property
    def parameters(self) -> tuple[str, ...]:
        """The parameters whose values are parts of the name."""
        return tuple(_PLACEHOLDER.findall(self.text))

    def filled_in(self, values: Mapping[str, Value | None]) -> str | None:
        """Return the name for some values of parameters; ``None`` where one has no text."""
        if not all(isinstance(values.get(name), str) for name in self.parameters):
            return None
        # As tf2 does: "/odom" and "odom" are one frame.
        return _PLACEHOLDER.sub(lambda x: str(values[x[1]]), self.text).removeprefix("/")


@dataclass(frozen=True, slots=True)
class Frame:
    """A transform that a node broadcasts, while parameter ``switch``, if it has one, is true."""

    parent: FrameName
    child: FrameName
    switch: Name | None = None


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
    via: str | None = None  # the parameter that holds the topic's name, or those of several
    via_span: Span | None = field(default=None, compare=False, repr=False)
    units: tuple[FieldUnit, ...] = ()
    frames: tuple[Frame, ...] = ()  # of a publisher of transforms
    stops_after_ns: int | None = None  # the silence of a subscription after which the node stops
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
    takes_any_parameter: bool = False  # also those that are not declared
    ports: tuple[Port, ...] = ()  # all kinds, in the order written
    timers: tuple[Timer, ...] = ()
    plugin: Name | None = None  # the class, as rclcpp_components has it registered

    @property
    def executable_name(self) -> str:
        """The program of the package that runs this node."""
        return self.executable or self.name

    def parameter(self, name: str) -> Parameter | None:
        """Return the parameter called ``name``, or ``None``."""
        return next((p for p in self.parameters if p.name == name), None)

    def is_listed(self, port: Port) -> bool:
        """Return whether a port stands for several: one for each entry of its list parameter.

        The list holds their names, or is that of a map with a name for each entry.
        """
        parameter = self.parameter(port.via) if port.via is not None else None
        if parameter is None:
            return False
        return parameter.type is ParameterType.STRING_ARRAY or bool(parameter.keys)

    def parameter_for(self, name: str) -> Parameter | None:
        """Return the parameter that declares ``name``, by itself or for an entry, or ``None``."""
        found = self.parameter(name)
        if found is not None:
            return found
        return next((p for p in self.parameters if p.keys and p.entry_of(name)), None)

    def ports_of(self, kind: PortKind) -> Iterator[Port]:
        """Yield the ports of one kind, in the order written."""
        return (port for port in self.ports if port.kind is kind)

    def ports_named(self, name: str, kind: PortKind | None = None) -> tuple[Port, ...]:
        """Return the ports that a wiring means by ``name``: with or without its leading ``/``.

        Ports of exactly that name are meant alone, because ``x`` and ``/x`` are two names to ROS 2.
        One name may have a port of each kind; ``kind`` leaves the others out.
        """
        wanted = name.removeprefix("/")
        alike = tuple(
            port
            for port in self.ports
            if port.name.removeprefix("/") == wanted and (kind is None or port.kind is kind)
        )
        return tuple(port for port in alike if port.name == name) or alike

    def port(self, name: str, kind: PortKind | None = None) -> Port | None:
        """Return the first port that a wiring means by ``name``, see :meth:`ports_named`."""
        return next(iter(self.ports_named(name, kind)), None)
