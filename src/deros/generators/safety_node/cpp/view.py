"""The view of the templates of the safety node in C++: the program in terms of rclcpp."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from deros import codes
from deros.diagnostics import report
from deros.generators.api.protocol import GenerationError
from deros.generators.monitor.c.interface import MonitorView, monitor_view
from deros.generators.node.cpp.interface import client_member
from deros.generators.safety_node.cpp.messages import Lookup, MessageFields, literal
from deros.generators.safety_node.cpp.rule_metadata import Item, rule_metadata_view
from deros.generators.safety_node.cpp.rule_state import held_timeouts, rule_states
from deros.generators.safety_node.cpp.whys import (
    CauseFunction,
    Told,
    cause_functions,
    told,
    why_rule,
)
from deros.generators.safety_node.messages import is_stamped
from deros.generators.safety_node.node import bound_actions
from deros.generators.safety_node.view import (
    ChannelView,
    FieldView,
    action_notes,
    argument_types,
    calls,
    needs_code,
    only_resets,
    origin_file,
    states_by_path,
)
from deros.generators.text.cpp import (
    Call,
    Expression,
    cpp_double,
    cpp_header,
    cpp_identifier,
    cpp_int64,
    cpp_string,
    cpp_type,
)
from deros.generators.text.cpp_fields import scalar
from deros.generators.text.identifiers import Emitted, camel_case, check_collisions
from deros.generators.text.prose import sentence
from deros.interfaces.message_fields import request_field
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.models.node import NodeType, Port, PortKind
from deros.models.rules import Rules
from deros.rules.engine.early import early_ones
from deros.rules.program.ir import PUBLISHER, RECEIPT, Action, Binding, Program, Scalar
from deros.systems.safety_nodes import DIAGNOSTICS_TYPE, RESET, enabled_parameter

_PARAMETER_TYPES = {
    "bool": "bool",
    "int": "std::int64_t",
    "float": "double",
    "str": "const std::string &",
}


@dataclass(frozen=True, slots=True)
class HandlerView:
    """The messages of one topic; ``call`` passes one to the monitor.

    Of one that ``is_stamped`` the monitor compares the stamp with the time of receipt. If it
    ``needs_one_publisher``, the monitor asks whether there are several.
    """

    identifier: str
    type: str
    topic: str
    ros_type: str
    call: Call
    lookups: tuple[Lookup, ...]
    is_stamped: bool
    needs_one_publisher: bool

    @property
    def beside(self) -> list[str]:
        """What is known beside a message, as parameters in C++."""
        received = ["std::int64_t received"] if self.is_stamped else []
        publisher = ["bool has_one_publisher"] if self.needs_one_publisher else []
        return ["std::int64_t now", *received, *publisher]

    @property
    def values_beside(self) -> str:
        """The arguments for these behind the time."""
        received = ["received"] if self.is_stamped else []
        publisher = ["has_one_publisher"] if self.needs_one_publisher else []
        return "".join(f", {name}" for name in (*received, *publisher))

    @property
    def is_read(self) -> bool:
        """Whether the monitor reads any field of the message."""
        return len(self.call.arguments) > 1 + len(self.beside)


@dataclass(frozen=True, slots=True)
class ActionView:
    """An action whose code the user writes; ``calls`` are the sites with the call of each.

    An ``optional`` action may do nothing.
    """

    name: str
    enumerator: str
    method: str
    parameters: tuple[str, ...]
    notes: tuple[str, ...]
    calls: tuple[tuple[int, Expression], ...]
    optional: bool

    @property
    def unnamed(self) -> list[str]:
        """The parameters of a function that does not use them."""
        words = (each.rpartition(" ") for each in self.parameters)
        return [f"{kind} /*{name}*/" for kind, _, name in words]


@dataclass(frozen=True, slots=True)
class ServiceView:
    """An action that calls a service, by its enumerator.

    Attributes:
        type: of the service.
        arguments: the client, and the function that fills in a request if it is not empty.
    """

    action: str
    type: str
    arguments: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class SafetyView:
    """The data of all templates.

    Attributes:
        package: also the namespace.
        stem: of the node's files; ``class_name`` of its classes.
        node_name: of the node at run time.
        rules: the file name of the rules.
        headers: those of the messages and services of the node's class;
            ``message_headers`` are without the services.
        monitor: the view of the monitor in C.
        shared: the watched topics that may have several publishers.
        rule_states: the expressions of the states of the rules, each with the monitor's field of
            the verdict, and the function that returns why the rule is true.
        cause_functions: these functions, and those of behaviours and negated rules.
        rule_metadata: the tables of behaviours, actions and sites.
        latched: name and enumerator of each latched action.
        optional: enumerator of each behaviour that can be disabled, the function that does it, and
            the field of its parameter.
        held: from when the timeouts count that a copy of the monitor can hold still.
        tunables: the field of each tunable constant in C, and that of its parameter.
        reset: whether there is a service to reset the latched actions.
    """

    package: str
    stem: str
    class_name: str
    node_name: str
    rules: str
    summary: str
    headers: tuple[str, ...]
    message_headers: tuple[str, ...]
    monitor: MonitorView
    handlers: tuple[HandlerView, ...]
    shared: frozenset[str]
    channels: tuple[ChannelView, ...]
    services: tuple[ServiceView, ...]
    actions: tuple[ActionView, ...]
    rule_states: tuple[tuple[Expression, str, str], ...]
    cause_functions: tuple[CauseFunction, ...]
    rule_metadata: list[Item]
    latched: tuple[tuple[str, str], ...]
    optional: tuple[tuple[str, str, str], ...]
    held: tuple[str, ...]
    tunables: tuple[tuple[str, str], ...]
    diagnostics: str
    reset: bool

    @property
    def prefix(self) -> str:
        """The prefix of the names of the monitor's functions."""
        return self.monitor.prefix

    @property
    def macro(self) -> str:
        """The prefix of its constants."""
        return self.monitor.macro

    @property
    def header(self) -> str:
        """The monitor's header."""
        return f"{self.prefix}_monitor.h"

    @property
    def required_actions(self) -> tuple[ActionView, ...]:
        """The actions that have to be implemented."""
        return tuple(action for action in self.actions if not action.optional)

    @property
    def actions_class(self) -> str:
        """The class of the user's actions."""
        return f"{self.class_name}Actions"

    @property
    def actions_stem(self) -> str:
        """The stem of the files of that class."""
        return f"{self.stem}_actions"

    @property
    def conditions(self) -> list[tuple[str, Told, Told | None]]:
        """The enumerator of each behaviour, its condition, and that of its early one, if any."""
        program, layout = self.monitor.program, self.monitor.layout
        early = early_ones(program)
        return [
            (
                name,
                told(program, layout, index),
                told(program, layout, early[index]) if index in early else None,
            )
            for index, (_, name) in enumerate(self.monitor.behaviour_names)
        ]

    @property
    def bound(self) -> list[tuple[str, str]]:
        """The enumerator of each bound action, with the channel of its state."""
        return [(action, each.identifier) for each in self.channels for action in each.actions]


def safety_view(
    model: Rules,
    program: Program,
    python: NodeType,
    node: NodeType,
    store: InterfaceStore,
    shared: frozenset[str],
) -> SafetyView:
    """Return the view of the safety node ``node`` that runs ``program``.

    Args:
        model: the rules as written.
        program: the same with all names resolved.
        python: the Python twin, whose name the node has at run time.
        node: the node type in C++.
        store: for the fields of the messages.
        shared: the watched topics that may have several publishers.

    Raises:
        GenerationError: if C++ cannot express the rules.
    """
    monitor = monitor_view(program)
    described = {action.name.text: action.description for action in model.actions}
    code = [each for each in program.actions if needs_code(each)]
    actions = tuple(_action(each, program, monitor, described.get(each.name, "")) for each in code)
    _check_names(actions, code, node)
    taken = tuple(node.ports_of(PortKind.SUBSCRIPTION))
    published = node.ports_of(PortKind.PUBLISHER)
    bound = [port for port in published if bound_actions(program, port.name)]
    stem = cpp_identifier(python.name)
    diagnostics = next(port for port in node.ports if port.type == DIAGNOSTICS_TYPE)
    return SafetyView(
        package=node.package,
        stem=stem,
        class_name=camel_case(python.name),
        node_name=python.name,
        rules=origin_file(model),
        summary=sentence(node.description),
        headers=_headers(
            taken, bound, [*node.ports_of(PortKind.SERVICE), *node.ports_of(PortKind.CLIENT)]
        ),
        message_headers=_headers(taken, bound),
        monitor=monitor,
        handlers=tuple(_handlers(program, monitor, store)),
        shared=shared,
        channels=tuple(_channels(program, node, monitor, store)),
        services=tuple(_services(program, node, monitor, store)),
        actions=actions,
        rule_states=tuple(
            (state, monitor.layout.verdicts[rule.index], why_rule(monitor.layout, rule.index))
            for rule, state in zip(program.rules, rule_states(program, monitor.layout), strict=True)
        ),
        cause_functions=tuple(cause_functions(monitor.program, monitor.layout)),
        rule_metadata=rule_metadata_view(model, program, monitor, f"{stem}_actions.cpp"),
        latched=tuple((a.name, a.enumerator) for a in monitor.actions if a.latched),
        optional=tuple(_optional(monitor)),
        held=held_timeouts(program, monitor.layout),
        tunables=tuple((each.field, cpp_identifier(each.name)) for each in monitor.constants),
        diagnostics=cpp_identifier(diagnostics.name),
        reset=node.port(RESET) is not None,
    )


def _headers(*ports: Iterable[Port]) -> tuple[str, ...]:
    return tuple(sorted({cpp_header(port.type) for group in ports for port in group}))


def _check_names(actions: tuple[ActionView, ...], code: list[Action], node: NodeType) -> None:
    reserved = Emitted("node", "the accessor of the class itself", node.name_span)
    methods = [
        Emitted(view.method, f"action {view.name!r}", action.span or node.name_span)
        for view, action in zip(actions, code, strict=True)
    ]
    check_collisions([reserved, *methods], "the class of the actions")


# Messages -----------------------------------------------------------------------------------------


def _handlers(
    program: Program, monitor: MonitorView, store: InterfaceStore
) -> Iterator[HandlerView]:
    for message in monitor.messages:
        handler = message.handler
        kind = program.topics[handler.topic]
        read = MessageFields(store, kind, handler.parameters)
        yield HandlerView(
            cpp_identifier(handler.topic),
            cpp_type(kind),
            handler.topic,
            str(kind),
            Call(handler.function, ("&m", "now", *read.arguments())),
            read.lookups,
            is_stamped=any(each.path == RECEIPT for each in handler.parameters),
            needs_one_publisher=any(each.path == PUBLISHER for each in handler.parameters),
        )


def _channels(
    program: Program, node: NodeType, monitor: MonitorView, store: InterfaceStore
) -> Iterator[ChannelView]:
    enumerators = {each.name: each.enumerator for each in monitor.actions}
    for port in node.ports_of(PortKind.PUBLISHER):
        actions = tuple(enumerators[name] for name in bound_actions(program, port.name))
        if not actions:
            continue
        yield ChannelView(
            cpp_identifier(port.name),
            cpp_type(port.type),
            port.name,
            actions,
            is_stamped(store, port.type),
            tuple(
                _field(port.type, path, [(enumerators[a.name], b) for a, b in states], store)
                for path, states in states_by_path(program, port.name).items()
            ),
        )


def _field(
    kind: InterfaceType,
    path: tuple[str, ...],
    bound: list[tuple[str, Binding]],
    store: InterfaceStore,
) -> FieldView:
    states = tuple((name, literal(store, kind, path, b.value)) for name, b in bound)
    name, first = bound[0]
    inactive, single = f"{cpp_type(kind)}().{'.'.join(path)}", None
    if isinstance(first.value, bool):
        inactive = "false" if first.value else "true"
        active = f"active[{name}]" if first.value else f"!active[{name}]"
        single = active if len(bound) == 1 else None
    return FieldView(f"msg.{'.'.join(path)}", inactive, single, states)


def _services(
    program: Program, node: NodeType, monitor: MonitorView, store: InterfaceStore
) -> Iterator[ServiceView]:
    clients = {port.name: client_member(port, node) for port in node.ports_of(PortKind.CLIENT)}
    for action in program.actions:
        call = action.service
        if call is None:
            continue
        fill: tuple[str, ...] = ()
        if call.field is not None and call.value is not None:
            base = request_field(store, call.type, call.field).base
            assert isinstance(base, str)
            value = scalar(base, call.value)
            fill = (f"[](auto & request) {{request.{call.field} = {value};}}",)
        enumerator = monitor.actions[action.index].enumerator
        yield ServiceView(enumerator, cpp_type(call.type), (clients[call.service], *fill))


def _optional(monitor: MonitorView) -> Iterator[tuple[str, str, str]]:
    enumerators = dict(monitor.behaviour_names)
    for name, function, _ in monitor.optional:
        yield enumerators[name], function, cpp_identifier(enabled_parameter(name))


# Actions ------------------------------------------------------------------------------------------


def _action(action: Action, program: Program, monitor: MonitorView, description: str) -> ActionView:
    types = _argument_types(action, program)
    method = cpp_identifier(action.name)
    return ActionView(
        action.name,
        monitor.actions[action.index].enumerator,
        method,
        tuple(
            f"{_PARAMETER_TYPES[kind]} {cpp_identifier(name)}"
            for name, kind in zip(action.parameters, types, strict=True)
        ),
        tuple(action_notes(action, program, description)),
        tuple(
            (site, Call(f"actions_.{method}", tuple(map(_argument, call.arguments, types))))
            for site, call in enumerate(calls(program))
            if call.action == action.index
        ),
        only_resets(action, program),
    )


def _argument_types(action: Action, program: Program) -> list[str]:
    """Return the type of each parameter, which is that of all arguments given for it.

    Raises:
        GenerationError: if one is a number here and a text there.
    """
    found: list[str] = []
    for name, types in zip(action.parameters, argument_types(action, program), strict=True):
        if len(types) > 1:
            message = (
                f"parameter {name!r} of action {action.name!r} is given values of several types: "
                f"{', '.join(sorted(types))}"
            )
            span = list(types.values())[-1].span
            hint = "C++ needs one type: give all calls the same"
            raise GenerationError([report(codes.UNSUPPORTED_BY_TARGET, message, span, hint)])
        found.append(next(iter(types), "float"))
    return found


def _argument(value: Scalar, kind: str) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return cpp_string(value)
    return cpp_double(value) if kind == "float" else cpp_int64(int(value))
