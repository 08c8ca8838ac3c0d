"""What the templates of a gate see: its lines as conditions, its fields in terms of C++."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from deros.generators.cpp_source import (
    Expression,
    cpp_header,
    cpp_identifier,
    cpp_string,
    cpp_type,
)
from deros.generators.gate_cpp.messages import (
    LimitedField,
    TypeView,
    limited_fields,
    type_views,
)
from deros.generators.gate_cpp.source import CppNames, number, origin_comment, scalar
from deros.generators.gate_python.node import heartbeat_port
from deros.generators.monitor_python.names import Names
from deros.generators.monitor_python.source import origin
from deros.generators.names import camel_case
from deros.generators.python_source import one_line, sentence
from deros.generators.rosnode_cpp.qos import qos_expression
from deros.interfaces.fields import ResolvedField, format_path, resolve
from deros.interfaces.store import InterfaceStore
from deros.metamodels.node import NodeType, Port
from deros.monitor.gates import CPP_SUFFIX
from deros.monitor.ir import Action, Binding, Gate, GateLine, Program

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
class LineView:
    """One line of the gate.

    Attributes:
        name: the local variable that tells whether the line applies.
        comment: where it stands, and what it says.
        shown: the same in one line, for the diagnostics.
        lost: ``heartbeat`` or ``input``, of a line about a loss; ``after`` is how long it may be
            silent, as a literal.
        action: the member with the state of the action, of any other line.
        zero: whether it commands zero; else it limits.
    """

    name: str
    comment: tuple[str, ...]
    shown: str
    lost: str | None
    after: str
    action: str
    zero: bool


@dataclass(frozen=True, slots=True)
class ActionView:
    """An action that the gate heeds: the member with its state, and when a message says active."""

    name: str
    member: str
    test: str


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


@dataclass(frozen=True, slots=True)
class GateView:
    """All that the templates print.

    Attributes:
        node: the gate's name when it runs; ``package`` is that of its package.
        name: the stem of its files and, in camel case, of its classes.
        executable: its program, and ``description`` what it is for.
        rules: the file name of the rules, and ``origin`` the gate's place in it.
        source: the topic that commands come in by, and ``target`` that which they go out by.
        type: the command's type in ROS 2, ``command`` its struct, and ``header`` what declares it.
        period: between two zeros, as a literal in nanoseconds.
        source_port, target_port: where commands come in, and go out.
        heartbeat_port: where the heartbeat is heard, if a line needs it.
        types: what is done to messages of each type in the command.
    """

    node: str
    package: str
    name: str
    executable: str
    description: str
    rules: str
    origin: str
    source: str
    target: str
    type: str
    command: str
    header: str
    period: str
    source_port: PortView
    target_port: PortView
    heartbeat_port: PortView | None
    types: tuple[TypeView, ...]
    fields: tuple[FieldView, ...]
    lines: tuple[LineView, ...]
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

    @property
    def has_floats(self) -> bool:
        """Whether a command can hold a NaN."""
        return bool(self.types[-1].finite)

    @property
    def stamped(self) -> bool:
        """Whether a command carries the time."""
        return self.types[-1].stamped

    @property
    def actions(self) -> tuple[ActionView, ...]:
        """The actions that the gate heeds."""
        return tuple(action for state in self.states for action in state.actions)

    @property
    def losses(self) -> tuple[LineView, ...]:
        """The lines about a loss."""
        return tuple(line for line in self.lines if line.lost)

    @property
    def lost(self) -> tuple[str, ...]:
        """What the lines about a loss are about."""
        return tuple(dict.fromkeys(line.lost for line in self.losses if line.lost))

    def is_lost(self, what: str) -> str:
        """Return the condition that something, which a line is about, is lost."""
        return " || ".join(line.name for line in self.losses if line.lost == what)

    @property
    def unless_lost(self) -> str:
        """What the limits of an action also depend on."""
        return "".join(f" && !is_{what}_lost" for what in self.lost)

    @property
    def zero(self) -> str:
        """The condition that some line commands zero."""
        return " || ".join(line.name for line in self.lines if line.zero) or "false"

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
    ports = {port.name: _port(port) for port in node.ports}
    states = tuple(_states(gate, program, ports, store, names))
    members = {each.name: each.member for state in states for each in state.actions}
    lines = tuple(_line(line, program, members, names) for line in gate.lines)
    paths = (limit.path for line in gate.lines for limit in line.limits)
    fields = tuple(
        FieldView(field, _limit(field, gate.lines, lines))
        for field in limited_fields(store, gate.type, paths, names)
    )
    return GateView(
        node=name,
        package=node.package,
        name=cpp_identifier(name),
        executable=node.name,
        description=sentence(node.description),
        rules=origin(gate.span).rpartition(":")[0],
        origin=origin(gate.span),
        source=gate.source,
        target=gate.target,
        type=str(gate.type),
        command=cpp_type(gate.type),
        header=cpp_header(gate.type),
        period=_nanoseconds(gate.period_ns),
        source_port=ports[gate.source],
        target_port=ports[gate.target],
        heartbeat_port=ports.get(heartbeat_port(safety_node)),
        types=type_views(store, gate.type),
        fields=fields,
        lines=lines,
        states=states,
    )


def _nanoseconds(count: int) -> str:
    """Return a literal; durations beyond the last of times, in 2116, are all the same."""
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


def _states(
    gate: Gate,
    program: Program,
    ports: Mapping[str, PortView],
    store: InterfaceStore,
    names: Names,
) -> Iterable[StateView]:
    heeded = dict.fromkeys(line.action for line in gate.lines if line.action is not None)
    by_topic: dict[str, list[tuple[Action, Binding]]] = {}
    for index in heeded:
        action = program.actions[index]
        assert action.binding is not None, action.name
        by_topic.setdefault(action.binding.topic, []).append((action, action.binding))
    for topic, bound in by_topic.items():
        yield StateView(
            ports[topic],
            topic,
            tuple(_action(action, binding, store, names) for action, binding in bound),
        )


def _action(action: Action, binding: Binding, store: InterfaceStore, names: Names) -> ActionView:
    found = resolve(store, binding.type, binding.path)
    assert isinstance(found, ResolvedField), found
    assert isinstance(found.type.base, str), found
    test = f"message->{format_path(binding.path)}"
    if not isinstance(binding.value, bool):
        test += f" == {scalar(found.type.base, binding.value)}"
    elif not binding.value:
        test = f"!{test}"
    return ActionView(action.name, f"{names.new(action.name, 'active')}_", test)


# Lines --------------------------------------------------------------------------------------------


def _line(line: GateLine, program: Program, members: Mapping[str, str], names: Names) -> LineView:
    if line.action is not None:
        action = program.actions[line.action].name
        name, title, member = names.new(action), f"Action {action}", members[action]
    else:
        assert line.lost is not None
        name, title, member = names.new("lost", line.lost), f"Lost {line.lost}", ""
    return LineView(
        name=name,
        comment=tuple(origin_comment(2, title, line.span)),
        shown=f"{one_line(line.span.text).rstrip('; ')} ({origin(line.span)})",
        lost=line.lost,
        after=_nanoseconds(line.lost_ns) if line.lost_ns is not None else "",
        action=member,
        zero=not line.limits,
    )


def _limit(
    field: LimitedField, lines: Sequence[GateLine], views: Sequence[LineView]
) -> tuple[str, ...]:
    """Return the choice of a field's limit, one line each: that of the first line that applies."""
    none = f"runtime::no_limit<{field.type}>()"
    chosen: list[str] = []
    for line, view in zip(lines, views, strict=True):
        for limit in line.limits:
            if format_path(limit.path) == field.path:
                ends = ", ".join(number(field.base, end) for end in (limit.lower, limit.upper))
                chosen.append(f"{view.name} ? runtime::limit<{field.type}>({ends}) :")
        if not line.limits:
            chosen.append(f"{view.name} ? {none} :")
    while chosen[-1].endswith(f"{none} :"):
        chosen.pop()
    return (*chosen, none)
