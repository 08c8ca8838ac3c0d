"""What the templates of a gate see: its table, and its ports in terms of rclpy."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from dataclasses import dataclass

from deros.generators.gate.python.messages import SEND_WORDS, NumberField, number_field, type_views
from deros.generators.gate.view import (
    ActionView,
    ActionWords,
    GateBase,
    action_views,
    send_views,
    table_of,
)
from deros.generators.node.python.interface import (
    NodeView,
    PortView,
    interface_imports,
    node_view,
)
from deros.generators.text.identifiers import PYTHON_WORDS, python_identifier
from deros.generators.text.provenance import origin
from deros.generators.text.python import Call, Text, import_lines, tuple_entries
from deros.generators.text.python_fields import literal
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.models.node import NodeType
from deros.rules.gates.gate_table import Bound, Line, Stop, numbered_paths, state_topics
from deros.rules.program.ir import Gate, Program
from deros.systems.safety_nodes import HEARTBEAT_TYPE, RESET, TRIGGER, heartbeat_port

_MESSAGE_TESTS = ActionWords("msg.", "not ", literal)


@dataclass(frozen=True, slots=True)
class StateView:
    """A topic with the states of actions; ``identifier`` is that of the port.

    Attributes:
        literal: the topic as an expression.
        actions: the actions whose states its messages hold.
    """

    identifier: str
    topic: str
    literal: str
    type: str
    actions: tuple[ActionView, ...]

    @property
    def names(self) -> Call:
        """The names of the actions."""
        return tuple_of(repr(action.name) for action in self.actions)

    @property
    def active(self) -> Call:
        """For each action, whether a message ``msg``, or ``None``, makes it active."""
        states = (f"{each.name!r}: msg is None or {each.test}" for each in self.actions)
        return dict_of("", states)


@dataclass(frozen=True, slots=True)
class ReadingView:
    """A topic with numbers for limits; ``identifier`` is that of the port.

    Attributes:
        numbers: the expression of each number in a message ``msg``, by that of its input.
    """

    identifier: str
    topic: str
    type: str
    numbers: tuple[tuple[int, str], ...]

    @property
    def read(self) -> Call:
        """The number of each input in a message ``msg``, or ``None``."""
        return dict_of(
            "", (f"{each}: None if msg is None else {text}" for each, text in self.numbers)
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class GateView(GateBase):
    """All that the templates print.

    Attributes:
        rules: the file name of the rules.
        command: the command's type as the node's module names it.
        sources: the ports where commands arrive, and ``target`` the port where they leave.
        heartbeat: the port of the heartbeat, where a line needs one.
        imports: the statements that import the interfaces.
        fields: the fields that have limits or ramps, in the order of the program.
        readings: the topics with numbers for limits.
        tuned: the constants that are parameters, each with its field in the node.
        trigger: the service class of ``~/reset`` as the module names it; empty without latches.
        runtime: the package that the runtime is imported from.
    """

    node: NodeView
    rules: str
    command: str
    sources: tuple[PortView, ...]
    target: PortView
    heartbeat: PortView | None
    imports: tuple[str, ...]
    fields: tuple[NumberField, ...]
    states: tuple[StateView, ...]
    readings: tuple[ReadingView, ...]
    tuned: tuple[tuple[str, str], ...]
    trigger: str
    runtime: str

    @property
    def rows(self) -> tuple[Call, ...]:
        """The lines of the table."""
        return tuple(map(_row, self.table.lines))

    @property
    def actions_row(self) -> Call:
        """The actions that the table names."""
        return dataclasses.replace(tuple_of(map(repr, self.table.actions)), head="actions=")

    @property
    def fields_row(self) -> Call:
        """The fields that have limits or ramps in the table."""
        return dataclasses.replace(tuple_of(map(repr, self.table.fields)), head="fields=")

    @property
    def unpacked(self) -> Call:
        """These fields, as local variables, taken from ``values``."""
        return dataclasses.replace(tuple_of(field.name for field in self.fields), tail=" = values")

    def command_arguments(self, source: str) -> tuple[str, ...]:
        """Return the arguments of the call that takes a command ``msg`` of a source."""
        values = ["message.numbers(msg)"] if self.fields else []
        test = "is_safe" if self.sends else "is_zero"
        zero = [f"is_zero=message.{test}(msg)"] if self.tests_zero else []
        return ("now", *values, *zero, *([f"source={source}"] if self.chooses else []))

    @property
    def source_rows(self) -> tuple[Call, ...]:
        """The sources of the table, where they have times."""
        return tuple(
            Call("Source", (repr(each.topic), f"silent_ns={nanoseconds(each.silent_ns)}", *zero))
            for each in self.table.sources
            for zero in [("from_zero=True",) if each.from_zero else ()]
        )

    @property
    def input_rows(self) -> tuple[str, ...]:
        """The inputs of the table."""
        return tuple(
            f"Input({each.name!r}, silent_ns={nanoseconds(each.silent_ns)})"
            for each in self.table.inputs
        )

    @property
    def safe_tests(self) -> tuple[str, ...]:
        """The operands whose disjunction is that a command is what the gate stops with."""
        sent = (f"is_sent_{each.line}(msg)" for each in self.sends)
        return ("is_zero(msg)", *sent) if self.stops_with_zero else tuple(sent)

    @property
    def table_names(self) -> tuple[str, ...]:
        """The names that the table's module imports."""
        names = {"Line", "Table", *(["Source"] if self.chooses else [])}
        names |= {"Input"} if self.table.inputs else set()
        for line in self.table.lines:
            names |= {"Bound"} if line.bounds else set()
            if line.stop is not None:
                is_plain = not line.stop.ramps and line.stop.what != "send"
                names.add(line.stop.what.upper() if is_plain else "Stop")
        return tuple(sorted(names, key=str.lower))


def _row(line: Line) -> Call:
    """Return the constructor of a line, without what is the default."""
    limits = (f"{name!r}: {ends!r}" for name, ends in line.limits.items())
    bounds = (
        Call(f"{name!r}: ", (_end(lower), _end(upper)))
        for name, (lower, upper) in line.bounds.items()
    )
    given = (
        Text("", line.text),
        f"action={line.action!r}" if line.action else "",
        f"lost={line.lost!r}" if line.lost else "",
        f"lost_ns={nanoseconds(line.lost_ns)}" if line.lost_ns else "",
        _stop(line.stop) if line.stop else "",
        "until_reset=True" if line.until_reset else "",
        f"wait_ns={nanoseconds(line.wait_ns)}" if line.wait_ns else "",
        dict_of("limits=", limits) if line.limits else "",
        "is_severe=True" if line.is_severe else "",
        dict_of("bounds=", bounds) if line.bounds else "",
    )
    return Call("Line", tuple(each for each in given if each))


def _end(end: float | Bound) -> str:
    """Return an end of a limit that always holds, as an expression."""
    if not isinstance(end, Bound):
        return repr(end)
    given = (
        repr(end.text),
        "" if end.number is None else f"number={end.number}",
        f"parameter={end.parameter!r}" if end.parameter else "",
        "" if end.factor == 1 else f"factor={end.factor!r}",
        "" if end.kind == "float64" else f"kind={end.kind!r}",
    )
    return f"Bound({', '.join(each for each in given if each)})"


def _stop(stop: Stop) -> str | Call:
    if stop.ramps:
        ramps = dict_of("ramps=", (f"{name!r}: {rate!r}" for name, rate in stop.ramps.items()))
        return Call("stop=Stop", (repr(stop.what), ramps))
    if stop.what == "send":
        sends = dict_of("sends=", (f"{name!r}: {each!r}" for name, each in stop.sends.items()))
        return Call("stop=Stop", (repr(stop.what), sends))
    return f"stop={stop.what.upper()}"


def dict_of(head: str, entries: Iterable[str | Call]) -> Call:
    """Return a dictionary of entries such as ``key: value``."""
    return Call(head, tuple(entries), brackets=("{", "}"))


def tuple_of(names: Iterable[str]) -> Call:
    """Return a tuple of expressions."""
    return Call("", tuple(tuple_entries(names)))


def gate_view(
    gate: Gate,
    node: NodeType,
    program: Program,
    store: InterfaceStore,
    safety_node: NodeType,
    runtime: str = "",
) -> GateView:
    """Return the view of a gate.

    Args:
        gate: the gate.
        node: its node.
        program: the rules that it is of.
        store: the message definitions.
        safety_node: the node whose states and heartbeat it evaluates.
        runtime: the package that the runtime is imported from; by default, the node's own.

    Raises:
        GenerationError: if two ports would get one name.
    """
    base = node_view(node, raw=True)
    heartbeat = heartbeat_port(safety_node)
    names = UniqueNames(PYTHON_WORDS | {"msg", "values"})
    fields = (
        number_field(store, gate.type, path, names.new(*path)) for path in numbered_paths(gate)
    )
    states = state_topics(gate, program.actions)
    heard = {binding.type for state in states for binding in state.bindings.values()}
    read = set(gate.input_types.values())
    if node.port(heartbeat):
        heard.add(HEARTBEAT_TYPE)
    called = {TRIGGER} if node.port(RESET) else set()
    return GateView(
        gate=gate,
        table=table_of(gate, program),
        types=type_views(store, gate.type),
        node=base,
        rules=origin(gate.span).rpartition(":")[0],
        command=dict(base.interfaces)[gate.type],
        sources=tuple(_port(base.subscriptions, topic) for topic in gate.topics),
        target=_port(base.publishers, gate.target),
        heartbeat=_port(base.subscriptions, heartbeat) if node.port(heartbeat) else None,
        imports=tuple(
            _imports(
                base,
                node,
                {gate.type, *heard, *called, *read},
                runtime or node.package,
                is_heeding=bool(heard),
            )
        ),
        fields=tuple(fields),
        sends=send_views(gate, store, SEND_WORDS),
        states=tuple(
            _state(
                _port(base.subscriptions, state.topic),
                action_views(state, program, store, _MESSAGE_TESTS),
            )
            for state in states
        ),
        readings=tuple(
            _reading(_port(base.subscriptions, topic), topic, gate, store)
            for topic in gate.input_types
        ),
        tuned=tuple((each.name, python_identifier(each.name)) for each in gate.tunables),
        trigger=dict(base.interfaces)[TRIGGER] if node.port(RESET) else "",
        runtime=runtime or node.package,
    )


def _state(port: PortView, actions: tuple[ActionView, ...]) -> StateView:
    return StateView(port.identifier, port.name, port.topic, port.type, actions)


def _reading(port: PortView, topic: str, gate: Gate, store: InterfaceStore) -> ReadingView:
    numbers = tuple(
        (number, number_field(store, each.type, each.path, "").read)
        for number, each in enumerate(gate.inputs)
        if each.topic == topic
    )
    return ReadingView(port.identifier, port.name, port.type, numbers)


def nanoseconds(count: int) -> str:
    """Return a time as a literal."""
    return f"{count:_}"


def _port(ports: Iterable[PortView], name: str) -> PortView:
    return next(port for port in ports if port.name == name)


def _imports(
    base: NodeView, node: NodeType, used: Iterable[InterfaceType], runtime: str, *, is_heeding: bool
) -> list[str]:
    imports = interface_imports(dict(base.interfaces), used)
    imports |= {
        "rclpy.serialization": {"deserialize_message"},
        runtime: {"gate_logic"},
        f"{node.package}.{base.module}_table": {"TABLE"},
        f"{node.package}.{base.base_module}": {base.base_class},
        f"{runtime}.gate_report": {"decoded", "GateReport"},
        f"{runtime}.gate_runner": {"GateRunner"},
        f"{runtime}.instance": {"claim"},
        f"{runtime}.process": {"run"},
        f"{runtime}.realtime": {"configure_process"},
    }
    imports.setdefault(node.package, set()).add(f"{base.module}_message as message")
    if is_heeding:
        imports[f"{runtime}.safety_source"] = {"SafetySource"}
    return import_lines(imports)
