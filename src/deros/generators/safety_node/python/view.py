"""The view of the safety node: the program in terms of rclpy."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deros.generators.decoder.python.interface import Topic
from deros.generators.monitor.python.interface import monitor_view
from deros.generators.node.python.interface import NodeView, interface_imports, node_view
from deros.generators.runtime.python.interface import PythonRuntime
from deros.generators.safety_node.messages import is_stamped
from deros.generators.safety_node.node import bound_actions
from deros.generators.safety_node.view import (
    BehaviourView,
    ChannelView,
    FieldView,
    action_notes,
    argument_types,
    behaviour_views,
    calls,
    lasts,
    needs_code,
    only_resets,
    origin_file,
    states_by_path,
)
from deros.generators.text.identifiers import Emitted, check_collisions, python_identifier
from deros.generators.text.prose import printable_line
from deros.generators.text.python import Call, import_lines, wrapped
from deros.generators.text.python_fields import literal
from deros.interfaces.fields import format_path
from deros.interfaces.message_fields import field_type, request_field
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.models.node import NodeType, PortKind
from deros.models.rules import Rules
from deros.rules.compiler.actions import LOG_STATE
from deros.rules.program import walk
from deros.rules.program.ir import PUBLISHER, RECEIPT, Action, Binding, Program, Scalar
from deros.systems.safety_nodes import HEARTBEAT, RESET, enabled_parameter

RUNTIME = (
    "clock_choice",
    "diagnostics",
    "duplicate_instance",
    "endpoints",
    "event_reporter",
    "instance",
    "latches",
    "look_ahead",
    "monitor_runner",
    "one_shot_timer",
    "process",
    "publishers",
    "realtime",
    "regular_file",
    "report_queue",
    "report_types",
    "safety_node_core",
    "start_order",
    "states",
    "waker",
)
"""The modules of the runtime that every safety node needs."""

_SERVICE_CALL = "service_call"
"""The module of the runtime that actions with services need, too."""


@dataclass(frozen=True, slots=True)
class HandlerView:
    """The handler of the messages of one topic.

    Attributes:
        identifier: of the port: the node's method is ``on_<identifier>``.
        method: the monitor's method.
        fields: what the decoder returns: one ``value``, or a tuple ``fields``.
        decoded: the fields that are decoded.
        is_stamped: whether the monitor compares the message's stamp with the time of receipt.
        needs_one_publisher: whether it asks if the topic has one publisher only.
    """

    identifier: str
    topic: str
    method: str
    fields: str
    decoded: Topic
    is_stamped: bool
    needs_one_publisher: bool

    @property
    def arguments(self) -> str:
        """The arguments of the monitor's method."""
        received = ["received"] if self.is_stamped else []
        publisher = ["publisher"] if self.needs_one_publisher else []
        fields = "value" if self.fields == "value" else "*fields"
        return ", ".join(["now", *received, *publisher, fields])


@dataclass(frozen=True, slots=True)
class ActionView:
    """An action whose code the user writes; if it is ``optional``, it may do nothing."""

    name: str
    method: str
    signature: str
    notes: tuple[tuple[str, ...], ...]
    optional: bool


@dataclass(frozen=True, slots=True)
class ActionMetadata:
    """An action, for the reports of a node.

    Attributes:
        lasts: whether it has a state, and is not just run.
        is_release: whether all that it is for is to reset others.
        is_latched: whether it is; only then, the rest is set.
        triggered_by: the behaviours that trigger it.
        arguments: those that the rules call it with first.
    """

    name: str
    lasts: bool
    is_release: bool
    is_latched: bool
    triggered_by: tuple[str, ...]
    arguments: tuple[Scalar, ...]


@dataclass(frozen=True, slots=True)
class ServiceView:
    """An action that calls a service: ``handle`` holds the client, ``request`` makes a request."""

    action: str
    handle: str
    request: Call


@dataclass(frozen=True, slots=True)
class SafetyView:
    """The view of a safety node.

    Attributes:
        runtime: the package that the modules of the runtime are imported from.
        rules: the file name of the rules.
        inputs: each with its topic.
        imports: the statements that import the interfaces.
        shared: the watched topics that may have several publishers.
        metadata: the actions, for the reports.
        optional: the behaviours that can be disabled, with the field of their parameter.
        tunables: the constants that are parameters, with the fields of these.
        trigger: the service class of ``~/reset`` as the module names it; empty without latches.
    """

    package: str
    runtime: str
    node: NodeView
    rules: str
    inputs: tuple[tuple[str, str], ...]
    name: str
    imports: tuple[str, ...]
    handlers: tuple[HandlerView, ...]
    shared: tuple[str, ...]
    channels: tuple[ChannelView, ...]
    services: tuple[ServiceView, ...]
    actions: tuple[ActionView, ...]
    metadata: tuple[ActionMetadata, ...]
    optional: tuple[tuple[str, str], ...]
    tunables: tuple[tuple[str, str], ...]
    behaviours: tuple[BehaviourView, ...]
    heartbeat: str
    trigger: str
    rule_count: int

    @property
    def metadata_types(self) -> list[str]:
        """The types that the metadata of the rules needs."""
        needed = {"Action": self.metadata, "Behaviour": self.behaviours}
        return [*(name for name, items in needed.items() if items), "RuleMetadata"]

    @property
    def runtime_modules(self) -> tuple[str, ...]:
        """The modules of the runtime that the node needs."""
        return (*RUNTIME, _SERVICE_CALL) if self.services else RUNTIME

    @property
    def latched(self) -> bool:
        """Whether there are latched actions."""
        return any(action.is_latched for action in self.metadata)

    @property
    def actions_module(self) -> str:
        """Module of the user's action bodies."""
        return f"{self.node.module}_actions"

    @property
    def actions_class(self) -> str:
        """Class of the user's action bodies."""
        return f"{self.node.class_name}Actions"

    @property
    def actions_imports(self) -> list[str]:
        """The import statement of the user's module."""
        module = f"{self.package}.{self.actions_module}_base"
        names = {f"{self.actions_class}Base"}
        if not all(action.optional for action in self.actions):
            names.add("not_filled_in")
        return import_lines({module: names})


def safety_view(
    model: Rules,
    program: Program,
    node: NodeType,
    store: InterfaceStore,
    shared: frozenset[str],
    runtime: PythonRuntime,
) -> SafetyView:
    """Return the view of the safety node ``node`` that runs ``program``.

    Args:
        model: the rules as written.
        program: the same with all names resolved.
        node: the node type.
        store: for the fields of the messages.
        shared: the watched topics that may have several publishers.
        runtime: where the package takes the runtime from.

    Raises:
        GenerationError: if two topics, actions or modules would get one name.
    """
    base = node_view(node, raw=True)
    handlers = tuple(_handlers(program, base))
    channels = tuple(_channels(program, base, node, store))
    services = tuple(_services(program, base, store))
    described = {action.name.text: action.description for action in model.actions}
    actions = tuple(
        _action(each, program, described.get(each.name, ""))
        for each in program.actions
        if needs_code(each)
    )
    view = SafetyView(
        package=node.package,
        runtime=runtime.module,
        node=base,
        rules=origin_file(model),
        inputs=tuple((each.name, each.topic) for each in program.inputs),
        name=printable_line(program.name),
        imports=tuple(_imports(program, base, node, channels, bool(actions), runtime.module)),
        handlers=handlers,
        shared=tuple(sorted(shared)),
        channels=channels,
        services=services,
        actions=actions,
        metadata=tuple(_metadata(program)),
        optional=tuple(_optional(program)),
        tunables=tuple((each.name, python_identifier(each.name)) for each in program.tunables),
        behaviours=tuple(behaviour_views(program)),
        heartbeat=_alias(base, node, HEARTBEAT),
        trigger=_alias(base, node, RESET),
        rule_count=len(program.rules),
    )
    _check_names(view, program, node)
    return view


def _check_names(view: SafetyView, program: Program, node: NodeType) -> None:
    spans = {action.name: action.span or node.name_span for action in program.actions}
    reserved = [
        Emitted(name, f"{name!r} of the class itself", node.name_span)
        for name in ("node", "unfilled")
    ]
    methods = [Emitted(a.method, f"action {a.name!r}", spans[a.name]) for a in view.actions]
    check_collisions([*reserved, *methods], f"the class {view.actions_class}")
    modules = [
        "explanation",
        "monitor",
        "rule_metadata",
        *view.runtime_modules,
        view.node.module,
        view.node.base_module,
    ]
    if view.handlers:
        modules.append("decoding")
    if view.actions:
        modules += [view.actions_module, f"{view.actions_module}_base"]
    emitted = (Emitted(name, f"module {name!r}", node.name_span) for name in modules)
    check_collisions(emitted, f"package {view.package}", files=True)


def _imports(
    program: Program,
    base: NodeView,
    node: NodeType,
    channels: tuple[ChannelView, ...],
    has_actions: bool,
    runtime: str,
) -> list[str]:
    named = {channel.topic for channel in channels} | {HEARTBEAT, RESET}
    used = [p.type for p in node.ports if p.name in named or p.kind is PortKind.CLIENT]
    imports = interface_imports(dict(base.interfaces), used)
    package = node.package
    imports |= {
        f"{package}.explanation": {"ExplainedMonitor"},
        f"{package}.monitor": {"Event"},
        f"{package}.rule_metadata": {"METADATA"},
        f"{package}.{base.base_module}": {base.base_class},
        f"{runtime}.process": {"run"},
        f"{runtime}.safety_node_core": {"SafetyNodeCore", "SafetyNodePorts"},
    }
    if base.subscriptions:
        imports[package] = {"decoding"}
    if channels:
        imports[f"{runtime}.states"] = {"StateTopic"}
    if base.clients:
        imports[f"{runtime}.{_SERVICE_CALL}"] = {"ServiceCall"}
    if any(behaviour.optional for behaviour in walk.behaviours(program)):
        imports[f"{package}.{base.base_module}"].add("Parameters")
    if has_actions:
        imports[f"{package}.{base.module}_actions"] = {f"{base.class_name}Actions"}
    return import_lines(imports)


def _alias(base: NodeView, node: NodeType, port_name: str) -> str:
    port = node.port(port_name)
    return dict(base.interfaces)[port.type] if port else ""


# Messages in --------------------------------------------------------------------------------------


def _handlers(program: Program, base: NodeView) -> Iterator[HandlerView]:
    ports = {port.name: port for port in base.subscriptions}
    for handler in monitor_view(program).handlers:
        identifier = ports[handler.topic].identifier
        handed = [each.path for each in handler.parameters]
        paths = [each for each in handed if each not in (RECEIPT, PUBLISHER)]
        topic = Topic(identifier, program.topics[handler.topic], paths)
        fields = "value" if len(paths) == 1 else "fields"
        yield HandlerView(
            identifier,
            handler.topic,
            handler.method,
            fields,
            topic,
            is_stamped=RECEIPT in handed,
            needs_one_publisher=PUBLISHER in handed,
        )


# States out ---------------------------------------------------------------------------------------


def _channels(
    program: Program, base: NodeView, node: NodeType, store: InterfaceStore
) -> Iterator[ChannelView]:
    types = {port.name: port.type for port in node.ports_of(PortKind.PUBLISHER)}
    for port in base.publishers:
        actions = tuple(bound_actions(program, port.name))
        if not actions:
            continue
        kind = types[port.name]
        fields = tuple(
            _field(kind, path, states, store)
            for path, states in states_by_path(program, port.name).items()
        )
        yield ChannelView(
            port.identifier, port.type, port.name, actions, is_stamped(store, kind), fields
        )


def _field(
    kind: InterfaceType,
    path: tuple[str, ...],
    bound: list[tuple[Action, Binding]],
    store: InterfaceStore,
) -> FieldView:
    type_ = field_type(store, kind, path)
    states = tuple((action.name, literal(type_, binding.value)) for action, binding in bound)
    action, first = bound[0]
    inactive, single = None, None
    if isinstance(first.value, bool):
        inactive = repr(not first.value)
        active = f"{action.name!r} {'in' if first.value else 'not in'} active"
        single = active if len(bound) == 1 else None
    return FieldView(f"msg.{format_path(path)}", inactive, single, states)


def _services(program: Program, base: NodeView, store: InterfaceStore) -> Iterator[ServiceView]:
    clients = {port.name: port for port in base.clients}
    for action in program.actions:
        call = action.service
        if call is None:
            continue
        values: tuple[str, ...] = ()
        if call.field is not None and call.value is not None:
            type_ = request_field(store, call.type, call.field)
            values = (f"{call.field}={literal(type_, call.value)}",)
        port = clients[call.service]
        yield ServiceView(action.name, port.handle, Call(f"{port.type}.Request", values))


# Actions and behaviours ---------------------------------------------------------------------------


def _action(action: Action, program: Program, description: str) -> ActionView:
    types = (" | ".join(sorted(each)) or "object" for each in argument_types(action, program))
    parameters = zip(action.parameters, types, strict=True)
    arguments = ["self", *(f"{python_identifier(name)}: {kind}" for name, kind in parameters)]
    method = python_identifier(action.name)
    return ActionView(
        action.name,
        method,
        f"def {method}({', '.join(arguments)}) -> None:",
        tuple(
            tuple(wrapped(text, indent=8)) for text in action_notes(action, program, description)
        ),
        only_resets(action, program),
    )


def _metadata(program: Program) -> Iterator[ActionMetadata]:
    names = {behaviour.index: behaviour.name for behaviour in walk.behaviours(program)}
    for action in program.actions:
        if action.name == LOG_STATE:
            continue
        triggered_by: tuple[str, ...] = ()
        arguments: tuple[Scalar, ...] = ()
        if action.latched:
            triggered_by = tuple(names[index] for index in action.triggered_by)
            own = (call.arguments for call in calls(program) if call.action == action.index)
            arguments = next(own, ())
        yield ActionMetadata(
            action.name,
            lasts(action),
            only_resets(action, program),
            action.latched,
            triggered_by,
            arguments,
        )


def _optional(program: Program) -> Iterator[tuple[str, str]]:
    for each in walk.behaviours(program):
        if each.optional:
            yield each.name, python_identifier(enabled_parameter(each.name))
