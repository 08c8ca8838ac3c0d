"""What the templates of a gate see: its table, and its ports in terms of C++."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from deros.generators.gate.cpp.messages import (
    SEND_WORDS,
    NumberField,
    TypeView,
    number_fields,
    type_views,
)
from deros.generators.gate.view import (
    ActionView,
    ActionWords,
    GateBase,
    action_views,
    send_views,
    table_of,
)
from deros.generators.node.cpp.interface import qos_expression
from deros.generators.text.cpp import (
    Expression,
    Table,
    Text,
    cpp_double,
    cpp_header,
    cpp_identifier,
    cpp_string,
    cpp_type,
)
from deros.generators.text.cpp_fields import number, scalar
from deros.generators.text.identifiers import camel_case
from deros.generators.text.prose import sentence
from deros.interfaces.durations import LATEST_NS
from deros.interfaces.fields import format_path
from deros.interfaces.message_fields import unsized_arrays
from deros.interfaces.store import InterfaceStore
from deros.models.node import NodeType, Port, PortKind
from deros.rules.gates.gate_table import Bound, Line, state_topics
from deros.rules.program.ir import Gate, InputBound, Program
from deros.systems.safety_nodes import CPP_SUFFIX, heartbeat_port

_MESSAGE_TESTS = ActionWords("message.", "!", lambda field, value: scalar(str(field.base), value))


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
    def active(self) -> tuple[str, ...]:
        """For each action, whether a message makes it active."""
        return tuple(
            f"{{{cpp_string(each.name)}, !is_known || {each.test}}}" for each in self.actions
        )

    @property
    def identifier(self) -> str:
        """The part of names that stands for the topic."""
        return self.port.identifier

    @property
    def type(self) -> str:
        """The struct of its messages."""
        return self.port.type


@dataclass(frozen=True, slots=True)
class ReadingView:
    """A topic with numbers for limits.

    Attributes:
        numbers: the expression of each number in a message, by that of its input.
    """

    port: PortView
    topic: str
    numbers: tuple[tuple[int, str], ...]

    @property
    def identifier(self) -> str:
        """The part of names that stands for the topic."""
        return self.port.identifier

    @property
    def type(self) -> str:
        """The struct of its messages."""
        return self.port.type

    @property
    def read(self) -> tuple[str, ...]:
        """The number of each input in a message, or what stands for an unknown one."""
        return tuple(f"{{{number}, {expression}}}" for number, expression in self.numbers)


@dataclass(frozen=True, slots=True)
class RowsView:
    """The limits or the ramps of a line: the name of their array, and its rows, if any."""

    name: str
    rows: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class GateView(GateBase):
    """All that the templates print.

    Attributes:
        node: the gate's name when it runs; ``package`` is that of its package.
        name: the stem of its files and, in camel case, of its classes.
        description: its purpose.
        sources: the topics of incoming commands, and ``target`` that of outgoing ones.
        command: the command's struct, and ``header`` what declares it.
        source_ports, target_port: the ports of incoming and outgoing commands.
        heartbeat_port: the subscription of the heartbeat, if a line needs it.
        readings: the topics with numbers for limits.
        tuned: the fields of the parameters that limits name, by their numbers.
    """

    node: str
    package: str
    name: str
    description: str
    sources: tuple[str, ...]
    target: str
    command: str
    header: str
    source_ports: tuple[PortView, ...]
    target_port: PortView
    heartbeat_port: PortView | None
    types: tuple[TypeView, ...]
    fields: tuple[NumberField, ...]
    states: tuple[StateView, ...]
    readings: tuple[ReadingView, ...]
    tuned: tuple[str, ...]

    @property
    def message_class(self) -> str:
        """The functions for commands."""
        return f"{self.node_class}Message"

    @property
    def node_class(self) -> str:
        """The class of its node."""
        return camel_case(self.node)

    @property
    def silence_ns(self) -> int:
        """The silence of the heartbeat after which every line about it applies; 0 without any."""
        lines = (line for line in self.table.lines if line.lost == "heartbeat")
        return max((line.lost_ns for line in lines), default=0)

    @property
    def action_names(self) -> tuple[str, ...]:
        """The names of the actions, as literals."""
        return tuple(map(cpp_string, self.table.actions))

    @property
    def limits(self) -> tuple[RowsView, ...]:
        """The limits of each line."""
        bases = {field.path: field.base for field in self.fields}
        return tuple(
            RowsView(
                f"LIMITS_{index}",
                tuple(
                    f"{{{cpp_string(path)}, {', '.join(number(bases[path], e) for e in ends)}}}"
                    for path, ends in _closed(line).items()
                ),
            )
            for index, line in enumerate(self.table.lines, start=1)
        )

    @property
    def input_rows(self) -> tuple[str, ...]:
        """The inputs of the table."""
        return tuple(
            f"{{{cpp_string(each.name)}, {nanoseconds(each.silent_ns)}}}"
            for each in self.table.inputs
        )

    @property
    def bound_rows(self) -> tuple[Table, ...]:
        """The ends of standing limits that messages and parameters give."""
        names = [each.name for each in self.gate.tunables]
        return tuple(
            _bound_row(path, place, end, names)
            for line in self.table.lines
            for path, ends in line.bounds.items()
            for place, end in zip(("LOWER", "UPPER"), ends, strict=True)
            if isinstance(end, Bound)
        )

    @property
    def ramps(self) -> tuple[RowsView, ...]:
        """The ramps of each line."""
        return tuple(
            RowsView(
                f"RAMPS_{index}",
                tuple(
                    f"{{{cpp_string(path)}, {cpp_double(rate)}}}"
                    for path, rate in (line.stop.ramps if line.stop else {}).items()
                ),
            )
            for index, line in enumerate(self.table.lines, start=1)
        )

    @property
    def has_least_int64(self) -> bool:
        """Whether a limit is the least number that there is."""
        return any("numeric_limits" in row for each in self.limits for row in each.rows)

    @property
    def rows(self) -> tuple[Expression, ...]:
        """The lines of the table."""
        return tuple(
            _row(line, limits.name, ramps.name if ramps.rows else "")
            for line, limits, ramps in zip(self.table.lines, self.limits, self.ramps, strict=True)
        )

    @property
    def source_rows(self) -> tuple[str, ...]:
        """The sources of the table, where they have times."""
        return tuple(
            f"{{{cpp_string(each.topic)}, {nanoseconds(each.silent_ns)},"
            f" {'true' if each.from_zero else 'false'}}}"
            for each in self.table.sources
        )

    @property
    def safe_tests(self) -> tuple[str, ...]:
        """The operands whose disjunction is that a command is what the gate stops with."""
        if not self.tests_zero:
            return ()
        sent = (f"is_sent_{each.line}(command)" for each in self.sends)
        # Inside the class that has a function of this name, the one of the namespace is meant.
        zero = (f"{self.package}::is_zero(command)",) if self.stops_with_zero else ()
        return (*zero, *sent)

    @property
    def type_headers(self) -> tuple[str, ...]:
        """The message headers that the functions for commands include besides the command's."""
        return tuple(sorted({view.header for view in self.types} - {self.header}))


def _closed(line: Line) -> dict[str, tuple[float, float]]:
    """Return the limits of a line, with 0 at the ends that others give."""
    opened = {
        path: (
            0 if isinstance(lower, Bound) else lower,
            0 if isinstance(upper, Bound) else upper,
        )
        for path, (lower, upper) in line.bounds.items()
    }
    return {**line.limits, **opened}


def _bound_row(path: str, place: str, end: Bound, parameters: Sequence[str]) -> Table:
    """Return an end of a standing limit; ``parameters`` are the names of those of the gate."""
    is_input = end.number is not None
    return Table(
        (
            Text(end.text),
            cpp_string(path),
            f"runtime::End::{place}",
            f"runtime::Origin::{'INPUT' if is_input else 'PARAMETER'}",
            str(end.number if is_input else parameters.index(end.parameter)),
            cpp_double(end.factor),
            f"runtime::Holds::{end.kind.upper()}",
        )
    )


def _row(line: Line, limits: str, ramps: str) -> Table:
    if line.lost:
        condition = f"runtime::lost_{line.lost}({nanoseconds(line.lost_ns)})"
    elif line.action:
        condition = f"runtime::active({cpp_string(line.action)})"
    else:
        condition = "runtime::always()"
    effect = f"runtime::limited({limits})"
    if line.wait_ns:
        effect = f"runtime::wait({nanoseconds(line.wait_ns)})"
    elif line.stop:
        effect = f"runtime::{line.stop.what}({ramps})"
        effect = f"runtime::until_reset({effect})" if line.until_reset else effect
    severity = f"runtime::Severity::{'SEVERE' if line.is_severe else 'WARNING'}"
    return Table((Text(line.text), condition, effect, severity))


def gate_view(
    gate: Gate, node: NodeType, program: Program, store: InterfaceStore, safety_node: NodeType
) -> GateView:
    """Return the view of a gate.

    Args:
        gate: the gate.
        node: its node.
        program: the rules that it is of.
        store: the message definitions.
        safety_node: the node whose states and heartbeat it follows, by the name of the Python one.
    """
    name = node.name.removesuffix(CPP_SUFFIX)
    topics = (port for port in node.ports if port.kind is not PortKind.SERVICE)
    ports = {port.name: _port(port) for port in topics}
    return GateView(
        gate=gate,
        table=table_of(gate, program),
        types=type_views(store, gate.type),
        node=name,
        package=node.package,
        name=cpp_identifier(name),
        description=sentence(node.description),
        sources=gate.topics,
        target=gate.target,
        command=cpp_type(gate.type),
        header=cpp_header(gate.type),
        source_ports=tuple(ports[topic] for topic in gate.topics),
        target_port=ports[gate.target],
        heartbeat_port=ports.get(heartbeat_port(safety_node)),
        fields=number_fields(gate, store),
        sends=send_views(gate, store, SEND_WORDS),
        states=tuple(
            StateView(
                ports[state.topic],
                state.topic,
                action_views(state, program, store, _MESSAGE_TESTS),
            )
            for state in state_topics(gate, program.actions)
        ),
        readings=tuple(
            ReadingView(
                ports[topic],
                topic,
                tuple(
                    (number, _number(each, store))
                    for number, each in enumerate(gate.inputs)
                    if each.topic == topic
                ),
            )
            for topic in gate.input_types
        ),
        tuned=tuple(cpp_identifier(each.name) for each in gate.tunables),
    )


def _number(bound: InputBound, store: InterfaceStore) -> str:
    """Return the number that a message holds, or what stands for an unknown one."""
    guards = [
        f"message.{format_path(array)}.size() > {index}"
        for array, index in unsized_arrays(store, bound.type, bound.path)
    ]
    known = " && ".join(["is_known", *guards])
    place = f"message.{format_path(bound.path)}"
    return f"{known} ? static_cast<double>({place}) : runtime::UNKNOWN"


def nanoseconds(count: int) -> str:
    """Return a time as a literal; longer durations become the latest time, in 2116."""
    return f"{min(count, LATEST_NS):_}".replace("_", "'")


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
