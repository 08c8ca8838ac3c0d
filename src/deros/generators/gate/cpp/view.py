"""What the templates of a gate see: its program, named, and its ports in terms of C++."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from deros.generators.gate.cpp.messages import (
    LimitedField,
    TypeView,
    limited_field,
    type_views,
)
from deros.generators.gate.cpp.source import CppNames
from deros.generators.gate.printing import ConditionPrinter
from deros.generators.gate.view import ActionView, ActionWords, GateBase, named_parts, shown
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
from deros.interfaces.durations import LATEST_NS
from deros.interfaces.store import InterfaceStore
from deros.metamodels.node import NodeType, Port, PortKind
from deros.metamodels.safety_nodes import CPP_SUFFIX, heartbeat_port
from deros.monitor import gate_program as form
from deros.monitor.gate_table import gate_table
from deros.monitor.ir import Gate, Limit, Program

_MESSAGE_TESTS = ActionWords("message->", "!", lambda field, value: scalar(str(field.base), value))


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
    steps: tuple[form.Step, ...]

    @property
    def identifier(self) -> str:
        """The part of names that stands for the topic."""
        return self.port.identifier

    @property
    def type(self) -> str:
        """The struct of its messages."""
        return self.port.type


@dataclass(frozen=True, slots=True, kw_only=True)
class GateView(GateBase):
    """All that the templates print.

    Attributes:
        node: the gate's name when it runs; ``package`` is that of its package.
        name: the stem of its files and, in camel case, of its classes.
        description: its purpose.
        source: the topic of incoming commands, and ``target`` that of outgoing ones.
        command: the command's struct, and ``header`` what declares it.
        source_port, target_port: the ports of incoming and outgoing commands.
        heartbeat_port: the subscription of the heartbeat, if a line needs it.
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
    fields: tuple[LimitedField, ...]
    states: tuple[StateView, ...]

    @property
    def logic_class(self) -> str:
        """The class that decides what is published."""
        return f"{self.node_class}Logic"

    @property
    def summary(self) -> str:
        """The purpose of the gate."""
        return f"The logic of {self.node}: commands from {self.source} to {self.target}."

    @property
    def node_class(self) -> str:
        """The class of its node."""
        return camel_case(self.node)

    @property
    def silence_ns(self) -> int:
        """The silence of the heartbeat after which every line about it applies; 0 without any."""
        lines = (line for line in self.program.gate.lines if line.lost == "heartbeat")
        return max((line.lost_ns or 0 for line in lines), default=0)

    @property
    def settled(self) -> str:
        """The parameters of ``settle``, after the time, with their defaults."""
        return "bool is_new = false" + (", bool may_release = false" if self.waits else "")

    @property
    def headers(self) -> tuple[str, ...]:
        """The message headers that the header of the logic includes."""
        stamp = ["builtin_interfaces/msg/time.hpp"] if self.stamped else []
        return tuple(sorted({self.header, *stamp, *(state.port.header for state in self.states)}))

    @property
    def type_headers(self) -> tuple[str, ...]:
        """The message headers that its source includes besides those."""
        return tuple(sorted({view.header for view in self.types} - set(self.headers)))


class Conditions(ConditionPrinter):
    """Prints conditions, and what depends on them, as expressions."""

    language = "C++"
    all_of = " && "
    any_of = " || "
    never = "false"

    def __init__(self, gate: GateView) -> None:
        """Print conditions of ``gate``."""
        super().__init__(gate)
        self._fields = gate.fields

    def variable(self, name: str) -> str:
        """Return the member of the gate."""
        return f"{name}_"

    def nanoseconds(self, count: int) -> str:
        """Return the literal of a duration."""
        return nanoseconds(count)

    def losses(self, sources: Sequence[form.Source]) -> list[str]:
        """Return the variables that hold whether each of ``sources`` is lost."""
        return [f"is_{source}_lost" for source in sources]

    def none_of(self, operands: list[str]) -> str:
        """Return the conjunction of the negations."""
        return self.all_of.join(f"!{operand}" for operand in operands)

    def limit_choices(self, field: form.FieldChoice, index: int) -> tuple[str, ...]:
        """Return the parts of the conditional expression that chooses a field's limit."""
        view = self._fields[index]
        choices = (
            f"{self(choice.condition)} ? {_interval(view, choice.limit)} :"
            for choice in field.choices
        )
        return (*choices, _interval(view, None))


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
    names = CppNames()
    name = node.name.removesuffix(CPP_SUFFIX)
    topics = (port for port in node.ports if port.kind is not PortKind.SERVICE)
    ports = {port.name: _port(port) for port in topics}
    steps, actions, lines = named_parts(gate, program, store, _MESSAGE_TESTS, names)
    fields = (limited_field(store, gate.type, path, names.new(*path)) for path in steps.fields)
    return GateView(
        program=steps,
        table=gate_table(gate, program.actions, shown),
        types=type_views(store, gate.type),
        actions=actions,
        lines=lines,
        node=name,
        package=node.package,
        name=cpp_identifier(name),
        description=sentence(node.description),
        source=gate.source,
        target=gate.target,
        command=cpp_type(gate.type),
        header=cpp_header(gate.type),
        source_port=ports[gate.source],
        target_port=ports[gate.target],
        heartbeat_port=ports.get(heartbeat_port(safety_node)),
        fields=tuple(fields),
        states=tuple(_states(steps, ports, actions)),
    )


def _states(
    steps: form.GateProgram, ports: Mapping[str, PortView], actions: Mapping[int, ActionView]
) -> Iterator[StateView]:
    for state in steps.states:
        named = tuple(actions[action] for action in state.actions)
        yield StateView(ports[state.topic], state.topic, named, state.steps)


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


def _interval(field: LimitedField, limit: Limit | None) -> str:
    if limit is None:
        return f"runtime::no_limit<{field.type}>()"
    ends = ", ".join(number(field.base, end) for end in (limit.lower, limit.upper))
    return f"runtime::limit<{field.type}>({ends})"
