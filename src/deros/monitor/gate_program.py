"""What a gate does, step by step: the one form that the engine runs and every language prints.

A :class:`GateProgram` holds the variables of a gate and, for each kind of event, the steps to take.
Lines, actions and fields are referred to by index or path, never by name; limits are numbers in the
unit of the message, times are nanoseconds. :mod:`deros.monitor.gate_lowering` makes it of the lines
of a gate, :mod:`deros.monitor.gate_engine` runs it, and the generators print it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

from deros.interfaces.fields import FieldPath
from deros.monitor.command_types import CommandType
from deros.monitor.ir import Binding, Gate, Limit

Source = Literal["heartbeat", "input"]
"""What a gate can lose."""

# Conditions ---------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Silent:
    """The last sign of life of ``source`` is at least ``ns`` old, or there has been none."""

    source: Source
    ns: int


@dataclass(frozen=True, slots=True)
class IsActive:
    """An action is active, as far as the gate knows."""

    action: int


@dataclass(frozen=True, slots=True)
class Applies:
    """A line applies, as the last :class:`FindLine` found."""

    line: int


@dataclass(frozen=True, slots=True)
class IsLost:
    """A line about the loss of one of ``sources`` applies, as the last :class:`FindLoss` found."""

    sources: tuple[Source, ...]


@dataclass(frozen=True, slots=True)
class IsLatched:
    """A line has applied since the last reset."""

    line: int


@dataclass(frozen=True, slots=True)
class IsAnyLatched:
    """A line is latched, as the last :class:`LatchLines` found."""


@dataclass(frozen=True, slots=True)
class IsZero:
    """A line commands zero, as the last :class:`FindZero` found."""


@dataclass(frozen=True, slots=True)
class IsWaiting:
    """The gate waits for a command that is zero."""


@dataclass(frozen=True, slots=True)
class Not:
    """The operand does not hold."""

    operand: Condition


@dataclass(frozen=True, slots=True)
class AllOf:
    """All operands hold."""

    operands: tuple[Condition, ...]


@dataclass(frozen=True, slots=True)
class AnyOf:
    """One of the operands holds; without operands, never."""

    operands: tuple[Condition, ...]


Condition = (
    Silent
    | IsActive
    | Applies
    | IsLost
    | IsLatched
    | IsAnyLatched
    | IsZero
    | IsWaiting
    | Not
    | AllOf
    | AnyOf
)

# Variables ----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class ActionStates:
    """Active flag of each action: true at first."""

    actions: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class LastSign:
    """Time of the last sign of life of ``source``: none at first.

    The heartbeat's last counter belongs to it.
    """

    source: Source


@dataclass(frozen=True, slots=True)
class HeartbeatWasLost:
    """Whether the heartbeat was lost at the last decision: true at first."""


@dataclass(frozen=True, slots=True)
class Latches:
    """Latch of each line: false at the start; a step of the clock does not change it."""

    lines: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Wait:
    """Whether the gate waits for a command that is zero: true at first."""


@dataclass(frozen=True, slots=True)
class Decision:
    """Last decision, and when zeros are due: at first neither zero nor limits, and at once."""


@dataclass(frozen=True, slots=True)
class NextLoss:
    """When the next line about a loss will apply, as :class:`ScheduleLosses` found: never."""


Variable = ActionStates | LastSign | HeartbeatWasLost | Latches | Wait | Decision | NextLoss

# Steps that take an event -------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class NoteInput:
    """Store when a good command arrived."""


@dataclass(frozen=True, slots=True)
class AssumeActive:
    """Count actions as active, because nothing is known of them."""

    actions: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class StoreCommand:
    """Store the command as the last good one."""


@dataclass(frozen=True, slots=True)
class Forget:
    """Forget the last sign of life of ``source``."""

    source: Source


@dataclass(frozen=True, slots=True)
class TakeState:
    """Store whether an action is active, as a message says.

    An unreadable message makes it active; an untrusted one never makes it inactive.
    """

    action: int


@dataclass(frozen=True, slots=True)
class TakeHeartbeat:
    """Store a heartbeat: a sign of life if its counter is greater than the last one."""


@dataclass(frozen=True, slots=True)
class Settle:
    """Run :attr:`GateProgram.settle`; ``with_command``: a good command has just arrived."""

    with_command: bool = False


@dataclass(frozen=True, slots=True)
class Reset:
    """Clear the latches of ``latches`` and settle, unless one of the lines ``refusing`` applies."""

    refusing: tuple[int, ...]
    latches: tuple[int, ...]


# Steps that decide --------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class FindLine:
    """Find whether a line applies."""

    line: int
    condition: Condition


@dataclass(frozen=True, slots=True)
class FindLoss:
    """Find whether one of ``lines``, which are all those about ``source``, applies."""

    source: Source
    lines: tuple[int, ...]

    @property
    def condition(self) -> Condition:
        """Whether one of the lines applies."""
        return AnyOf(tuple(map(Applies, self.lines)))


@dataclass(frozen=True, slots=True)
class ForgetActions:
    """Count actions as active if the heartbeat has become lost."""

    actions: tuple[int, ...]

    @property
    def loss(self) -> IsLost:
        """Whether the heartbeat is lost."""
        return IsLost(("heartbeat",))


@dataclass(frozen=True, slots=True)
class LatchLines:
    """Latch each of ``lines`` that applies, and find whether any is latched."""

    lines: tuple[int, ...]

    @property
    def condition(self) -> Condition:
        """Whether a line is latched."""
        return AnyOf(tuple(map(IsLatched, self.lines)))


@dataclass(frozen=True, slots=True)
class FindZero:
    """Find whether a line commands zero."""

    condition: Condition


@dataclass(frozen=True, slots=True)
class UpdateWait:
    """Wait if a line commands zero; else stop waiting if a command that is zero has arrived."""


@dataclass(frozen=True, slots=True)
class Choice:
    """A limit, or ``None`` for no limit, that is chosen if a condition holds."""

    condition: Condition
    limit: Limit | None


@dataclass(frozen=True, slots=True)
class FieldChoice:
    """The limit of a field: of the first of ``choices`` that holds; if none does, no limit."""

    path: FieldPath
    choices: tuple[Choice, ...]


@dataclass(frozen=True, slots=True)
class ChooseLimits:
    """Choose the limits that are in force."""

    fields: tuple[FieldChoice, ...]


@dataclass(frozen=True, slots=True)
class Publish:
    """Publish what follows from the decision.

    While ``zero`` holds, zeros: at once if the decision has changed, then with the gate's period.
    Else a command that has just arrived, within the limits; or, if the command being executed
    exceeds them, that one again within the limits.

    Attributes:
        zero: whether zeros are published.
        is_limiting: whether there are limits at all.
        has_gaps: whether zeros leave the fields with a limit in force to the last good command.
        unless: the loss during which they do not.
    """

    zero: Condition
    is_limiting: bool
    has_gaps: bool = False
    unless: IsLost | None = None


@dataclass(frozen=True, slots=True)
class ReportApplying:
    """Report everything that holds commands back; see :func:`applying_texts`."""

    conditions: tuple[Condition, ...]


@dataclass(frozen=True, slots=True)
class Deadline:
    """The instant at which ``source`` will have been silent for ``ns``, and a line will apply."""

    line: int
    source: Source
    ns: int


@dataclass(frozen=True, slots=True)
class ScheduleLosses:
    """Find the earliest of the deadlines whose lines do not apply yet."""

    deadlines: tuple[Deadline, ...]


Step = (
    AssumeActive
    | Forget
    | NoteInput
    | StoreCommand
    | TakeState
    | TakeHeartbeat
    | Settle
    | Reset
    | FindLine
    | FindLoss
    | ForgetActions
    | LatchLines
    | FindZero
    | UpdateWait
    | ChooseLimits
    | Publish
    | ReportApplying
    | ScheduleLosses
)

# Programs -----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class StateTopic:
    """A topic with the states of actions, and the steps that take a message of it."""

    topic: str
    bindings: tuple[tuple[int, Binding], ...]
    steps: tuple[Step, ...]

    @property
    def actions(self) -> tuple[int, ...]:
        """The indices of the actions."""
        return tuple(action for action, _ in self.bindings)


@dataclass(frozen=True, slots=True)
class GateProgram:
    """All that a gate does.

    Events that a gate does not depend on have no steps; the time that comes with them counts.

    Attributes:
        gate: where it comes from.
        types: the message types in a command, innermost first.
        fields: the paths of the fields with limits, as first named.
        states: the topics with states of actions, as first named.
        memory: the variables.
        on_command: the steps for a good command; ``on_refused`` for any other.
        on_heartbeat: the steps for a heartbeat of the safety node.
        on_no_safety_node: the steps when no node, or more than one, can be the safety node.
        on_reset: the steps for a reset, which only a gate with latches is asked for.
        settle: the steps that decide, at an instant, what is published.
    """

    gate: Gate
    types: tuple[CommandType, ...]
    fields: tuple[FieldPath, ...]
    states: tuple[StateTopic, ...]
    memory: tuple[Variable, ...] = field(default=())
    on_command: tuple[Step, ...] = field(default=())
    on_refused: tuple[Step, ...] = field(default=())
    on_heartbeat: tuple[Step, ...] = field(default=())
    on_no_safety_node: tuple[Step, ...] = field(default=())
    on_reset: tuple[Step, ...] = field(default=())
    settle: tuple[Step, ...] = field(default=())

    @property
    def actions(self) -> tuple[int, ...]:
        """The indices of the actions that lines name, by the topics of their states."""
        return tuple(action for state in self.states for action in state.actions)

    @property
    def restarted(self) -> tuple[Variable, ...]:
        """The variables that start over when the clock steps back."""
        return tuple(each for each in self.memory if not isinstance(each, Latches))

    @property
    def publication(self) -> Publish:
        """The step that publishes."""
        return next(step for step in self.settle if isinstance(step, Publish))


def applying_texts(lines: Sequence[tuple[str, bool]], resume_on_zero: bool) -> tuple[str, ...]:
    """Return the texts that people read for the conditions of :class:`ReportApplying`.

    Args:
        lines: the text of each line of the gate, and whether it holds zero until a reset.
        resume_on_zero: whether the gate waits for a zero command.
    """
    texts = tuple(text for text, _ in lines)
    latched = tuple(f"waits for a reset, after {text}" for text, latches in lines if latches)
    waits = ("waits for a zero command",) if resume_on_zero else ()
    return (*texts, *latched, *waits)
