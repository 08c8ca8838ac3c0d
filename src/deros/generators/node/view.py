"""The view of a node for the templates of every language."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Generic, TypeVar

from deros.generators.node.parameter_maps import (
    emitted_fields,
    emitted_members,
    map_of,
    parameter_maps,
)
from deros.generators.text.identifiers import Emitted, check_collisions
from deros.generators.text.prose import sentence
from deros.generators.user_files.classes import LIFECYCLE_HOOKS, NODE_HOOKS
from deros.interfaces.durations import greatest_unit
from deros.models.node import NodeType, Parameter, Port, PortKind, Timer

MAX_GOALS = 8
"""The number of goals that a node executes at the same time, unless its class sets another."""

_METHODS = {
    PortKind.PUBLISHER: ("publish_{}",),
    PortKind.SUBSCRIPTION: ("on_{}",),
    PortKind.SERVICE: ("handle_{}",),
    PortKind.CLIENT: ("call_{}",),
    PortKind.ACTION: ("accept_{}", "execute_{}", "cancel_{}"),
    PortKind.ACTION_CLIENT: ("send_{}",),
}
_HANDLES = (PortKind.CLIENT, PortKind.ACTION_CLIENT)

PortT = TypeVar("PortT")
TimerT = TypeVar("TimerT")


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeBase(Generic[PortT, TimerT]):
    """The parts of a node's view that all languages have.

    Attributes:
        name: the name of the node type.
        class_name: the user's class.
        lifecycle: whether it is a managed node.
        source: file name of the node description.
        summary: its purpose, as a sentence.
        of_kind: its ports, by their kind.
        timers: its timers.
    """

    name: str
    class_name: str
    lifecycle: bool
    source: str
    summary: str
    of_kind: Mapping[PortKind, tuple[PortT, ...]]
    timers: tuple[TimerT, ...]

    @property
    def publishers(self) -> tuple[PortT, ...]:
        """The publishers."""
        return self.of_kind[PortKind.PUBLISHER]

    @property
    def subscriptions(self) -> tuple[PortT, ...]:
        """The subscriptions."""
        return self.of_kind[PortKind.SUBSCRIPTION]

    @property
    def services(self) -> tuple[PortT, ...]:
        """The services."""
        return self.of_kind[PortKind.SERVICE]

    @property
    def clients(self) -> tuple[PortT, ...]:
        """The clients of services."""
        return self.of_kind[PortKind.CLIENT]

    @property
    def actions(self) -> tuple[PortT, ...]:
        """The action servers."""
        return self.of_kind[PortKind.ACTION]

    @property
    def action_clients(self) -> tuple[PortT, ...]:
        """The action clients."""
        return self.of_kind[PortKind.ACTION_CLIENT]

    @property
    def ports(self) -> tuple[PortT, ...]:
        """All ports, kind by kind."""
        return tuple(port for ports in self.of_kind.values() for port in ports)

    @property
    def base_class(self) -> str:
        """The class that the generator owns."""
        return f"{self.class_name}Base"

    @property
    def has_handlers(self) -> bool:
        """Whether the user's class has methods to fill in."""
        return bool(self.subscriptions or self.timers or self.services or self.actions)

    @property
    def gated(self) -> bool:
        """Whether callbacks are ignored while a managed node is not active."""
        return self.lifecycle and bool(self.subscriptions or self.timers)


def ports_by_kind(
    model: NodeType, view: Callable[[Port], PortT]
) -> dict[PortKind, tuple[PortT, ...]]:
    """Return the views of a node's ports, by their kind."""
    return {kind: tuple(map(view, model.ports_of(kind))) for kind in PortKind}


# Names --------------------------------------------------------------------------------------------


def check_names(
    model: NodeType,
    class_name: str,
    parameters: str,
    identifier: Callable[[str], str],
    hooks: Iterable[str] = (),
) -> None:
    """Reject a node whose class would have two methods, or two parameter fields, of the same name.

    Args:
        model: the node.
        class_name: the class that it becomes.
        parameters: the structure of its parameters: ``class Parameters``.
        identifier: turns names of ROS 2 into those of the language.
        hooks: methods that the class has only in this language.

    Raises:
        GenerationError: at the second of two ports, timers or parameters.
    """
    check_collisions(_methods(model, identifier, hooks), f"the methods of class {class_name}")
    check_collisions(emitted_fields(model, identifier), f"the {parameters}")
    maps = parameter_maps(model)
    for each in maps:
        check_collisions(emitted_members(each, identifier), f"the values of {each.shown!r}")
    structs = [
        Emitted(each.struct, f"the map {each.shown!r}", each.parameters[0].name_span)
        for each in maps
        if each.struct is not None
    ]
    if structs:
        taken = [Emitted("Parameters", "the structure of all parameters", model.name_span)]
        check_collisions([*taken, *structs], f"the types of class {class_name}")


def _methods(
    model: NodeType, identifier: Callable[[str], str], hooks: Iterable[str]
) -> Iterator[Emitted]:
    """Yield every method of the base class, the hooks first."""
    for hook in (*NODE_HOOKS, *hooks, *(LIFECYCLE_HOOKS if model.lifecycle else ())):
        yield Emitted(hook, f"the hook {hook!r}", model.name_span)
    for port in model.ports:
        origin = f"{port.kind.word} {port.name!r}"
        for method in _METHODS[port.kind]:
            name = method.format(identifier(port.name))
            yield Emitted(name, origin, port.name_span)
        if port.kind in _HANDLES:
            yield Emitted(f"{handle(port, model, identifier)}", origin, port.name_span)
    for timer in model.timers:
        name = f"on_{identifier(timer.name)}"
        yield Emitted(name, f"timer {timer.name!r}", timer.name_span)


def handle(port: Port, model: NodeType, identifier: Callable[[str], str]) -> str:
    """Return the name of the attribute that holds the client of a service or action.

    Both are ``client_<name>``; the client of an action is ``action_client_<name>`` where the node
    has a client of a service whose name becomes the same.
    """
    name = identifier(port.name)
    services = {identifier(each.name) for each in model.ports_of(PortKind.CLIENT)}
    is_second = port.kind is PortKind.ACTION_CLIENT and name in services
    return f"{'action_' if is_second else ''}client_{name}"


# Text ---------------------------------------------------------------------------------------------


def topic_parameter(port: Port, model: NodeType) -> Parameter | None:
    """Return the parameter that sets a port's topic at start, if there is one."""
    return None if port.via is None else model.parameter(port.via)


def mapped_topic(
    port: Port, model: NodeType, identifier: Callable[[str], str]
) -> tuple[str, str] | None:
    """Return the field that maps entries to a port's topics, and the topic in terms of a ``value``.

    ``None`` for a port that does not take its topics from a map.
    """
    parameter = topic_parameter(port, model)
    if parameter is None or not parameter.keys:
        return None
    names = map_of(parameter, model)
    if names.struct is None:
        return identifier(names.name), "value"
    return identifier(names.name), f"value.{identifier(names.member(parameter) or 'value')}"


def port_notes(port: Port, model: NodeType) -> tuple[str, ...]:
    """Return the notes on a port: its description, units and the source of its name."""
    notes = [sentence(port.description)]
    if port.units:
        listed = ", ".join(f"{unit.path} [{unit.unit}]" for unit in port.units)
        notes.append(f"Units: {listed}.")
    if parameter := topic_parameter(port, model):
        if parameter.keys:
            notes.append(
                f"The parameters {parameter.name} name the topics at start; an entry with an empty"
                " name has none."
            )
        else:
            gives = "lists the topics" if model.is_listed(port) else "gives the topic's name"
            notes.append(f"The parameter {parameter.name} {gives} at start.")
    if port.stops_after_ns is not None:
        silence = period_text(port.stops_after_ns)
        notes.append(f"The node has to stop where no message comes for {silence}.")
    return tuple(filter(None, notes))


def timer_notes(timer: Timer) -> tuple[str, ...]:
    """Return the notes on a timer: its description, if there is one."""
    return tuple(filter(None, [sentence(timer.description)]))


def period_text(nanoseconds: int) -> str:
    """Return the period of a timer in SI units: ``20 ms``."""
    count, unit = greatest_unit(nanoseconds, "sec")
    return f"{count} {'s' if unit == 'sec' else unit}"
