"""What the templates of a gate see: its lines as conditions, its fields in terms of rclpy."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from deros.generators.gate_python.messages import (
    LimitedField,
    TypeView,
    limited_fields,
    type_views,
)
from deros.generators.gate_python.node import heartbeat_port
from deros.generators.monitor_python.names import RESERVED, Names
from deros.generators.monitor_python.source import comment, origin
from deros.generators.python_source import Call, Text, import_lines, one_line
from deros.generators.rosnode_python.view import (
    NodeView,
    PortView,
    interface_imports,
    node_view,
)
from deros.generators.safety_python.messages import literal
from deros.interfaces.fields import ResolvedField, format_path, resolve
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.metamodels.node import NodeType
from deros.monitor.ir import Action, Binding, Gate, GateLine, Program

# Names that the template of the logic uses itself.
_TAKEN = frozenset(
    (
        "Gate",
        "LINES",
        "Limits",
        "PERIOD",
        "Values",
        "applying",
        "is_new",
        "kept",
        "limits",
        "values",
        "zero",
    )
)


@dataclass(frozen=True, slots=True)
class LineView:
    """One line of the gate.

    Attributes:
        name: the local variable that tells whether the line applies.
        comment: where it stands, and what it says.
        shown: the same on one line, for the diagnostics.
        lost: ``heartbeat`` or ``input``, of a line about a loss; ``after`` is how long it may be
            silent, as a literal.
        action: the attribute with the state of the action, of any other line.
        zero: whether it commands zero; else it limits.
    """

    name: str
    comment: tuple[str, ...]
    shown: Text
    lost: str | None
    after: str
    action: str
    zero: bool


@dataclass(frozen=True, slots=True)
class ActionView:
    """An action that the gate heeds: the attribute of its state, and when a message says active."""

    name: str
    attribute: str
    test: str


@dataclass(frozen=True, slots=True)
class StateView:
    """A topic with the states of actions; ``identifier`` is that of the port."""

    identifier: str
    topic: str
    type: str
    actions: tuple[ActionView, ...]

    @property
    def parameters(self) -> tuple[str, ...]:
        """The parameters of the method that takes the states."""
        return ("self", "t: int", *(f"{action.attribute}: bool" for action in self.actions))

    @property
    def arguments(self) -> tuple[str, ...]:
        """The arguments for it, of a message ``msg`` that may be ``None``."""
        return ("self._watch.now()", *(f"msg is None or {action.test}" for action in self.actions))


@dataclass(frozen=True, slots=True)
class FieldView:
    """A field that limits speak of; ``limit`` chooses the interval that it is to be kept in."""

    field: LimitedField
    limit: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class GateView:
    """All that the templates print.

    Attributes:
        rules: the file name of the rules, and ``origin`` the gate's place in it.
        type: the command's type in ROS 2, and ``command`` as the node's module names it.
        source: the port that commands come in by, and ``target`` that which they go out by.
        heartbeat: the port of the heartbeat, where a line needs one.
        imports: the statements that import the interfaces.
        types: what is done to messages of each type in the command.
        period: between two zeros, as a literal in nanoseconds.
    """

    node: NodeView
    rules: str
    origin: str
    type: str
    command: str
    source: PortView
    target: PortView
    heartbeat: PortView | None
    imports: tuple[str, ...]
    period: str
    types: tuple[TypeView, ...]
    fields: tuple[FieldView, ...]
    lines: tuple[LineView, ...]
    states: tuple[StateView, ...]

    @property
    def has_floats(self) -> bool:
        """Whether a command can hold a NaN."""
        return bool(self.types and self.types[-1].finite)

    @property
    def stamped(self) -> bool:
        """Whether a command carries the time."""
        return bool(self.types and self.types[-1].stamped)

    @property
    def actions(self) -> tuple[ActionView, ...]:
        """The actions that the gate heeds."""
        return tuple(action for state in self.states for action in state.actions)

    @property
    def losses(self) -> tuple[LineView, ...]:
        """The lines about a loss."""
        return tuple(line for line in self.lines if line.lost)

    @property
    def loses_heartbeat(self) -> bool:
        """Whether a line is about the loss of the heartbeat."""
        return any(line.lost == "heartbeat" for line in self.lines)

    @property
    def loses_input(self) -> bool:
        """Whether a line is about the loss of the input."""
        return any(line.lost == "input" for line in self.lines)

    @property
    def lost_heartbeat(self) -> str:
        """The condition that the heartbeat is lost."""
        text = _any_of(line.name for line in self.lines if line.lost == "heartbeat")
        return f"({text})" if " or " in text else text

    @property
    def lost_input(self) -> str:
        """The condition that the input is lost."""
        return _any_of(line.name for line in self.lines if line.lost == "input")

    @property
    def unless_lost(self) -> str:
        """What the limits of an action also depend on."""
        text = _any_of(line.name for line in self.losses)
        return f" and not {f'({text})' if ' or ' in text else text}" if text else ""

    @property
    def zero(self) -> str:
        """The condition that some line commands zero."""
        return _any_of(line.name for line in self.lines if line.zero) or "False"

    @property
    def all_lines(self) -> Call:
        """Of each line, whether it applies."""
        return _tuple(line.name for line in self.lines)

    @property
    def values(self) -> Call:
        """The fields that limits speak of, as local variables."""
        return _tuple(each.field.name for each in self.fields)

    @property
    def unpacked(self) -> Call:
        """The same, taken from ``values``."""
        return dataclasses.replace(self.values, tail=" = values")

    @property
    def command_parameters(self) -> tuple[str, ...]:
        """The parameters of the method that takes a command."""
        fields = (f"{each.field.name}: float | None" for each in self.fields)
        return ("self", "t: int", *fields)

    @property
    def follow(self) -> str:
        """The arguments of the method that does what follows."""
        if not self.fields:
            return "t, zero, is_new"
        return f"t, zero, limits, is_new{f', {self.lost_input}' if self.loses_input else ''}"

    @property
    def lost_due(self) -> Call | str:
        """The earliest instant at which something will be lost."""
        due = [f"NEVER if {e.name} else self._{e.lost} + {e.after}" for e in self.losses]
        return Call("min", tuple(due)) if len(due) > 1 else due[0]


def _any_of(names: Iterable[str]) -> str:
    return " or ".join(names)


def _tuple(names: Iterable[str]) -> Call:
    listed = list(names)
    return Call("", tuple(listed if len(listed) > 1 else [f"{listed[0]},"]))


def gate_view(
    gate: Gate, node: NodeType, program: Program, store: InterfaceStore, safety_node: NodeType
) -> GateView:
    """Return the view of a gate.

    Args:
        gate: the gate.
        node: its node.
        program: the rules that it is of.
        store: the message definitions.
        safety_node: the node whose states and heartbeat it heeds.

    Raises:
        GenerationError: if two ports would get one name.
    """
    base = node_view(node, raw=True)
    heartbeat = heartbeat_port(safety_node)
    names = Names(RESERVED | _TAKEN)
    states = tuple(_states(gate, program, base, store, names))
    attributes = {each.name: each.attribute for state in states for each in state.actions}
    lines = tuple(_line(line, program, attributes, names) for line in gate.lines)
    bound = {e.binding.type for e in program.actions if e.binding and e.name in attributes}
    paths = (limit.path for line in gate.lines for limit in line.limits)
    fields = tuple(
        FieldView(field, _limit(field, gate.lines, lines))
        for field in limited_fields(store, gate.type, paths, names)
    )
    return GateView(
        node=base,
        rules=origin(gate.span).rpartition(":")[0],
        origin=origin(gate.span),
        type=str(gate.type),
        command=dict(base.interfaces)[gate.type],
        source=_port(base.subscriptions, gate.source),
        target=_port(base.publishers, gate.target),
        heartbeat=_port(base.subscriptions, heartbeat) if node.port(heartbeat) else None,
        imports=tuple(_imports(base, node, {gate.type, *bound})),
        period=f"{gate.period_ns:_}",
        types=type_views(store, gate.type),
        fields=fields,
        lines=lines,
        states=states,
    )


def _port(ports: Iterable[PortView], name: str) -> PortView:
    return next(port for port in ports if port.name == name)


def _imports(base: NodeView, node: NodeType, used: Iterable[InterfaceType]) -> list[str]:
    imports = interface_imports(dict(base.interfaces), used)
    own = {f"{base.module}_{module} as {module}" for module in ("logic", "message")}
    imports |= {
        "rclpy.serialization": {"deserialize_message"},
        node.package: {*own, "machine"},
        f"{node.package}.{base.base_module}": {base.base_class},
        f"{node.package}.gate_report": {"decoded", "Report"},
        f"{node.package}.gate_watch": {"GateWatch"},
        f"{node.package}.instance": {"claim"},
        f"{node.package}.process": {"run"},
    }
    return import_lines(imports)


# Actions ------------------------------------------------------------------------------------------


def _states(
    gate: Gate, program: Program, base: NodeView, store: InterfaceStore, names: Names
) -> Iterable[StateView]:
    heeded = dict.fromkeys(line.action for line in gate.lines if line.action is not None)
    by_topic: dict[str, list[tuple[Action, Binding]]] = {}
    for index in heeded:
        action = program.actions[index]
        assert action.binding is not None, action.name
        by_topic.setdefault(action.binding.topic, []).append((action, action.binding))
    for topic, bound in by_topic.items():
        port = _port(base.subscriptions, topic)
        yield StateView(
            port.identifier,
            topic,
            port.type,
            tuple(_action(action, binding, store, names) for action, binding in bound),
        )


def _action(action: Action, binding: Binding, store: InterfaceStore, names: Names) -> ActionView:
    found = resolve(store, binding.type, binding.path)
    assert isinstance(found, ResolvedField), found
    test = f"msg.{format_path(binding.path)}"
    if not isinstance(binding.value, bool):
        test += f" == {literal(found.type, binding.value)}"
    elif not binding.value:
        test = f"not {test}"
    return ActionView(action.name, names.new(action.name, "active"), test)


# Lines --------------------------------------------------------------------------------------------


def _line(
    line: GateLine, program: Program, attributes: Mapping[str, str], names: Names
) -> LineView:
    if line.action is not None:
        action = program.actions[line.action].name
        name, title, attribute = names.new(action), f"Action {action}", attributes[action]
    else:
        assert line.lost is not None
        name, title, attribute = names.new("lost", line.lost), f"Lost {line.lost}", ""
    return LineView(
        name=name,
        comment=tuple(comment(8, title, line.span)),
        shown=Text("", f"{one_line(line.span.text).rstrip('; ')} ({origin(line.span)})"),
        lost=line.lost,
        after=f"{line.lost_ns:_}" if line.lost_ns is not None else "",
        action=attribute,
        zero=not line.limits,
    )


def _limit(
    field: LimitedField, lines: Sequence[GateLine], views: Sequence[LineView]
) -> tuple[str, ...]:
    """Return the choice of a field's limit, one line each: that of the first line that applies."""
    chosen: list[str] = []
    for line, view in zip(lines, views, strict=True):
        chosen += [
            f"({limit.lower!r}, {limit.upper!r}) if {view.name}"
            for limit in line.limits
            if format_path(limit.path) == field.path
        ]
        if not line.limits:
            chosen.append(f"None if {view.name}")
    while chosen[-1].startswith("None"):
        chosen.pop()
    return (*chosen, "None")
