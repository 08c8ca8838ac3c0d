"""Types of the rules that a node runs, and of what their monitor reports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
import enum
from typing import Protocol

Value = bool | int | float | str


class EventKind(str, enum.Enum):
    """
    What a monitor did, or saw the clock do.

    A monitor needs no other module, and so has a class of its own with the same values: compare by
    value, not by identity.
    """

    TRIGGER = 'trigger'
    RESET = 'reset'
    REFUSED = 'refused'
    CLOCK_STEP = 'clock_step'


class ActionCall(Protocol):
    """A call of an action that is robot code."""

    @property
    def action(self) -> str:
        """Return the name of the action."""

    @property
    def arguments(self) -> tuple[Value, ...]:
        """Return the arguments of the call."""


class Event(ActionCall, Protocol):
    """Something that happened to a monitor; the class itself is the monitor's."""

    @property
    def t(self) -> int:
        """Return the time, in nanoseconds."""

    @property
    def kind(self) -> EventKind:
        """Return what happened."""

    @property
    def behaviour(self) -> str:
        """Return the behaviour that calls the action; empty for other events."""

    @property
    def line(self) -> int:
        """Return the line of the rules that the event comes from; 0 for none."""

    @property
    def holding(self) -> tuple[str, ...]:
        """Return the behaviours that refused a reset because their conditions hold."""

    @property
    def unknown(self) -> tuple[str, ...]:
        """Return the behaviours that refused a reset because their conditions are unknown."""

    @property
    def coming(self) -> tuple[str, ...]:
        """Return the behaviours that refused a reset because their conditions are on their way."""


class RuleState(Protocol):
    """The verdict of a rule, and the values behind it."""

    @property
    def name(self) -> str:
        """Return the name of the rule."""

    @property
    def line(self) -> int:
        """Return its line in the rules."""

    @property
    def text(self) -> str:
        """Return its condition as written."""

    @property
    def value(self) -> bool | None:
        """Return the verdict; None if it is not true and something that it reads is unknown."""

    @property
    def since(self) -> int:
        """Return when it last became true or ceased to be, in nanoseconds."""

    @property
    def reads(self) -> tuple[tuple[str, Value | None], ...]:
        """Return the terms that it reads, each with its value; None is unknown."""

    @property
    def causes(self) -> tuple[str, ...]:
        """Return the parts that make it true, with their values; none unless it is true."""


class Explanation(Protocol):
    """The verdict of each rule, and why the conditions of behaviours hold."""

    @property
    def rules(self) -> Sequence[RuleState]:
        """Return the states of all rules."""

    @property
    def causes(self) -> Mapping[str, Sequence[str]]:
        """Return why behaviours hold, are on their way, or are unknown, of those that do."""


class Monitor(Protocol):
    """The monitor of some rules, as a node runs it."""

    @property
    def next_deadline(self) -> int | None:
        """Return when to call advance() at the latest."""

    @property
    def waiting(self) -> bool:
        """Return whether an input has yet to come for the first time, and is not missing yet."""

    @property
    def holding(self) -> Sequence[str]:
        """Return the behaviours whose conditions hold."""

    @property
    def unknown(self) -> Sequence[str]:
        """Return the behaviours whose conditions are unknown."""

    @property
    def coming(self) -> Sequence[str]:
        """Return the behaviours whose conditions are on their way."""

    def explain(self) -> Explanation:
        """Return the verdict of each rule since the last event."""

    def verdicts(self) -> Sequence[bool | None]:
        """Return the verdict of each rule, as explain() does."""

    def copy(self, keeps: bool) -> Monitor:
        """
        Return a copy that emits nothing; it may be advanced, but takes no messages.

        If it keeps values, inputs with a timeout do not go missing, as if they went on sending.
        """

    def advance(self, t: int) -> None:
        """Evaluate all that is due up to and including t."""

    def enable(self, t: int, behaviour: str, enabled: bool) -> None:
        """Enable or disable an optional behaviour; there may be none."""

    def reset(self, t: int) -> bool:
        """Reset the latched actions whose causes are over; return whether none is left."""


@dataclass(frozen=True)
class Behaviour:
    """A behaviour of the rules."""

    origin: str  # file and line of the rules
    condition: str
    rules: tuple[str, ...]  # that it depends on, also through the behaviours around it


@dataclass(frozen=True)
class Action:
    """An action of the rules."""

    lasts: bool  # whether it has a state, and is not just run
    is_latched: bool = False
    triggered_by: tuple[str, ...] = ()  # the behaviours that trigger it, if it is latched
    arguments: tuple[Value, ...] = ()  # of its first call in the rules, if it is latched
    is_release: bool = False  # whether all that it is for is to reset others


@dataclass(frozen=True)
class RuleMetadata:
    """The rules of a node, for its reports."""

    rules: str  # the name of their file
    rule_count: int
    actions_file: str  # where the user writes robot code; empty without such actions
    behaviours: Mapping[str, Behaviour]
    actions: Mapping[str, Action]
    inputs: Mapping[str, str] = field(default_factory=dict)  # each with its topic in the rules
