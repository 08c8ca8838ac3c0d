"""What the templates of a gate see: its lines as conditions, its fields in terms of C++."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from deros.generators.gate.command import limited_paths
from deros.generators.gate.cpp.messages import (
    LimitedField,
    TypeView,
    limited_field,
    type_views,
)
from deros.generators.gate.cpp.source import CppNames
from deros.generators.gate.view import (
    ActionView,
    GateBase,
    LineView,
    deciding_lines,
    heeded_actions,
    limiting_lines,
    line_views,
)
from deros.generators.node.cpp.interface import qos_expression
from deros.generators.text.cpp import (
    Expression,
    cpp_header,
    cpp_identifier,
    cpp_string,
    cpp_type,
)
from deros.generators.text.cpp_fields import number, scalar
from deros.generators.text.identifiers import camel_case
from deros.generators.text.prose import sentence
from deros.generators.text.provenance import origin
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.fields import format_path
from deros.interfaces.message_fields import field_type
from deros.interfaces.store import InterfaceStore
from deros.metamodels.node import NodeType, Port, PortKind
from deros.metamodels.safety_nodes import CPP_SUFFIX, heartbeat_port
from deros.monitor.ir import Action, Binding, Gate, Limit, Program

LATEST = 2**62 - 1
"""The greatest time, and the greatest duration, in nanoseconds: sums of two stay in 64 bits."""


@dataclass(frozen=True, slots=True)
class PortView:
    """A port of the gate's node: expressions of its topic and its QoS, and the message's struct."""

    identifier: str
    topic: str
    type: str
    header: str
    qos: Expression


@dataclass(frozen=True, slots=True)
class StateView:
    """A topic with the states of actions."""

    port: PortView
    topic: str
    actions: tuple[ActionView, ...]

    @property
    def identifier(self) -> str:
        """What stands for the topic in names."""
        return self.port.identifier

    @property
    def type(self) -> str:
        """The struct of its messages."""
        return self.port.type


@dataclass(frozen=True, slots=True)
class FieldView:
    """A field that limits speak of; ``limit`` chooses the interval that it is to be kept in."""

    field: LimitedField
    limit: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class GateView(GateBase):
    """All that the templates print.

    Attributes:
        node: the gate's name when it runs; ``package`` is that of its package.
        name: the stem of its files and, in camel case, of its classes.
        description: what it is for.
        source: the topic that commands come in by, and ``target`` that which they go out by.
        command: the command's struct, and ``header`` what declares it.
        source_port, target_port: where commands come in, and go out.
        heartbeat_port: where the heartbeat is heard, if a line needs it.
    """

    node: str
    package: str
    name: str
    description: str
    source: str
    target: str
    command: str
    header: str
    source_port: PortView
    target_port: PortView
    heartbeat_port: PortView | None
    types: tuple[TypeView, ...]
    fields: tuple[FieldView, ...]
    states: tuple[StateView, ...]

    @property
    def logic_class(self) -> str:
        """The class that decides what is published."""
        return f"{self.node_class}Logic"

    @property
    def summary(self) -> str:
        """What the gate is for."""
        return (
            f"What {self.node} lets through of the commands on {self.source} to {self.target},"
            " and when."
        )

    @property
    def node_class(self) -> str:
        """The class of its node."""
        return camel_case(self.node)

    def is_lost(self, what: str) -> str:
        """Return the condition that something, which a line is about, is lost."""
        return " || ".join(line.name for line in self.losses if line.lost == what)

    @property
    def silence_ns(self) -> int:
        """After what silence of the heartbeat every line about it applies; 0 without any."""
        return max((line.lost_ns for line in self.losses if line.lost == "heartbeat"), default=0)

    @property
    def unless_lost(self) -> str:
        """What the limits of an action also depend on."""
        return "".join(f" && !is_{what}_lost" for what in self.lost)

    @property
    def zero(self) -> str:
        """The condition that some line commands zero, or is latched."""
        releasing = (line.name for line in self.releasing)
        return " || ".join((*releasing, *(["is_latched"] if self.latching else []))) or "false"

    @property
    def latched(self) -> str:
        """The condition that some line is latched."""
        return " || ".join(f"{line.latch}_" for line in self.latching)

    @property
    def all_lines(self) -> tuple[str, ...]:
        """Of all that can hold commands back, whether it does."""
        names = [line.name for line in self.lines]
        names += [f"{line.latch}_ && !{line.name}" for line in self.latching]
        return (*names, *(["waits_ && !zero"] if self.waits else []))

    @property
    def settled(self) -> str:
        """The parameters of what settles, after the time, and their defaults."""
        return "bool is_new = false" + (", bool may_release = false" if self.waits else "")

    @property
    def headers(self) -> tuple[str, ...]:
        """What the header of the logic includes of messages."""
        stamp = ["builtin_interfaces/msg/time.hpp"] if self.stamped else []
        return tuple(sorted({self.header, *stamp, *(state.port.header for state in self.states)}))

    @property
    def type_headers(self) -> tuple[str, ...]:
        """What its source includes beside that."""
        return tuple(sorted({view.header for view in self.types} - set(self.headers)))


def gate_view(
    gate: Gate, node: NodeType, program: Program, store: InterfaceStore, safety_node: NodeType
) -> GateView:
    """Return the view of a gate.

    Args:
        gate: the gate.
        node: its node.
        program: the rules that it is of.
        store: the message definitions.
        safety_node: the node whose states and heartbeat it heeds, by the name of the Python one.
    """
    names = CppNames()
    name = node.name.removesuffix(CPP_SUFFIX)
    topics = (port for port in node.ports if port.kind is not PortKind.SERVICE)
    ports = {port.name: _port(port) for port in topics}
    states = tuple(
        _state(ports[topic], topic, bound, store, names)
        for topic, bound in heeded_actions(gate, program).items()
    )
    actions = tuple(action for state in states for action in state.actions)
    lines = line_views(gate, program, actions, names)
    return GateView(
        node=name,
        package=node.package,
        name=cpp_identifier(name),
        description=sentence(node.description),
        origin=origin(gate.span),
        source=gate.source,
        target=gate.target,
        type=str(gate.type),
        command=cpp_type(gate.type),
        header=cpp_header(gate.type),
        period_ns=gate.period_ns,
        source_port=ports[gate.source],
        target_port=ports[gate.target],
        heartbeat_port=ports.get(heartbeat_port(safety_node)),
        types=type_views(store, gate.type),
        fields=tuple(_fields(gate, lines, store, names)),
        lines=lines,
        actions=actions,
        states=states,
        waits=gate.resume_on_zero,
    )


def nanoseconds(count: int) -> str:
    """Return a time as a literal; durations beyond the last of times, in 2116, are all the same."""
    return f"{min(count, LATEST):_}".replace("_", "'")


def _port(port: Port) -> PortView:
    qos = qos_expression(port.qos)
    assert qos is not None, port.name
    return PortView(
        cpp_identifier(port.name),
        cpp_string(port.name),
        cpp_type(port.type),
        cpp_header(port.type),
        qos,
    )


# Actions ------------------------------------------------------------------------------------------


def _state(
    port: PortView,
    topic: str,
    bound: Iterable[tuple[Action, Binding]],
    store: InterfaceStore,
    names: UniqueNames,
) -> StateView:
    actions = tuple(_action(action, binding, store, names) for action, binding in bound)
    return StateView(port, topic, actions)


def _action(
    action: Action, binding: Binding, store: InterfaceStore, names: UniqueNames
) -> ActionView:
    base = field_type(store, binding.type, binding.path).base
    assert isinstance(base, str), binding.path
    test = f"message->{format_path(binding.path)}"
    if not isinstance(binding.value, bool):
        test += f" == {scalar(base, binding.value)}"
    elif not binding.value:
        test = f"!{test}"
    return ActionView(action.name, names.new(action.name, "active"), test)


# Limits -------------------------------------------------------------------------------------------


def _fields(
    gate: Gate, lines: Sequence[LineView], store: InterfaceStore, names: UniqueNames
) -> Iterator[FieldView]:
    limiting = limiting_lines(gate, lines)
    for path in limited_paths(gate):
        field = limited_field(store, gate.type, path, names.new(*path))
        decided = (
            f"{line.name} ? {_interval(field, limit)} :"
            for line, limit in deciding_lines(limiting, field.path)
        )
        held = [f"{_held(gate)} ? {_interval(field, None)} :"] if gate.is_holding else []
        yield FieldView(field, (*held, *decided, _interval(field, None)))


def _held(gate: Gate) -> str:
    """Return the condition that all numbers are zero, whatever the lines say."""
    return "waits_" if gate.resume_on_zero else "is_latched"


def _interval(field: LimitedField, limit: Limit | None) -> str:
    if limit is None:
        return f"runtime::no_limit<{field.type}>()"
    ends = ", ".join(number(field.base, end) for end in (limit.lower, limit.upper))
    return f"runtime::limit<{field.type}>({ends})"
