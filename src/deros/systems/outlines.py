"""The properties of rules that determine the nodes which they become."""

from __future__ import annotations

from dataclasses import dataclass, field

from deros.diagnostics import Span
from deros.interfaces.types import InterfaceType
from deros.systems.tunables import TunableConstant


@dataclass(frozen=True, slots=True)
class StateOutline:
    """A bound action: its name, and the topic that its state is published on."""

    name: str
    topic: str
    type: InterfaceType
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class ServiceOutline:
    """A bound action: its name, and the service that it calls."""

    name: str
    service: str
    type: InterfaceType
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class InputOutline:
    """A topic that the rules read."""

    topic: str
    type: InterfaceType
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class LineOutline:
    """The subscriptions of one line of a gate: an action's state, the heartbeat, or inputs."""

    state: StateOutline | None
    heartbeat: bool
    span: Span = field(compare=False, repr=False)
    inputs: tuple[InputOutline, ...] = ()


@dataclass(frozen=True, slots=True)
class GateOutline:
    """A gate, topics by their graph names; ``is_latching`` if a zero of it lasts until a reset.

    ``tunables`` are the constants that its limits name: parameters of its node, too.
    """

    sources: tuple[str, ...]
    target: str
    type: InterfaceType
    lines: tuple[LineOutline, ...]
    span: Span = field(compare=False, repr=False)
    description: str = ""
    is_latching: bool = False
    tunables: tuple[TunableConstant, ...] = ()


@dataclass(frozen=True, slots=True)
class Outline:
    """The properties of rules that determine their nodes.

    Attributes:
        name: of the rules.
        start: the first character of their text.
        states: the actions whose states are published, in the order declared.
        services: the actions that call services, in the order declared.
        latched: whether an action is latched.
        inputs: the topics that rules read, each once.
        optional: the names of the optional behaviours.
        tunables: the constants that are parameters.
    """

    name: str
    start: Span = field(compare=False, repr=False)
    states: tuple[StateOutline, ...] = ()
    services: tuple[ServiceOutline, ...] = ()
    latched: bool = False
    inputs: tuple[InputOutline, ...] = ()
    optional: tuple[str, ...] = ()
    gates: tuple[GateOutline, ...] = ()
    tunables: tuple[TunableConstant, ...] = ()
