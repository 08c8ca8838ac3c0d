"""What the templates of a gate see in every language: its lines, and the actions they heed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from deros.diagnostics import Span
from deros.generators.gate.command import TypeBase
from deros.generators.text.prose import printable_line
from deros.generators.text.provenance import origin
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.fields import format_path
from deros.monitor.gate_engine import applying_texts
from deros.monitor.ir import Action, Binding, Gate, GateLine, Limit, Program


@dataclass(frozen=True, slots=True)
class ActionView:
    """An action that the gate heeds: the name of its state, and when a message says active."""

    name: str
    state: str
    test: str


@dataclass(frozen=True, slots=True)
class LineView:
    """One line of the gate.

    Attributes:
        name: the local variable that tells whether the line applies.
        title: what it is about, and ``span`` where it stands.
        shown: what it says, in one line, for the diagnostics.
        lost: ``heartbeat`` or ``input``, of a line about a loss; ``lost_ns`` is how long it may be
            silent; 0 of any other line.
        state: the name of the action's state, of a line about an action.
        limits: what it keeps fields within; none: it commands zero.
        latch: the name of what tells that it has applied since the last reset, if it commands zero
            until a reset; else empty.
    """

    name: str
    title: str
    span: Span
    shown: str
    lost: str | None
    lost_ns: int
    state: str
    limits: tuple[Limit, ...]
    latch: str

    @property
    def zero(self) -> bool:
        """Whether it commands zero; else it limits."""
        return not self.limits


@dataclass(frozen=True, slots=True, kw_only=True)
class GateBase:
    """What the views of a gate have in common.

    Attributes:
        origin: its place in the rules.
        type: the command's type in ROS 2.
        period_ns: between two zeros.
        types: what is done to messages of each type in the command, which is the last.
        actions: those that it heeds.
        waits: whether commands pass again only after one that is zero.
    """

    origin: str
    type: str
    period_ns: int
    types: tuple[TypeBase, ...]
    actions: tuple[ActionView, ...]
    lines: tuple[LineView, ...]
    waits: bool

    @property
    def has_floats(self) -> bool:
        """Whether a command can hold a NaN."""
        return bool(self.types and self.types[-1].finite)

    @property
    def stamped(self) -> bool:
        """Whether a command carries the time."""
        return bool(self.types and self.types[-1].stamped)

    @property
    def heeds_safety_node(self) -> bool:
        """Whether a line is about an action, or about the heartbeat."""
        return bool(self.actions) or "heartbeat" in self.lost

    @property
    def losses(self) -> tuple[LineView, ...]:
        """The lines about a loss."""
        return tuple(line for line in self.lines if line.lost)

    @property
    def latching(self) -> tuple[LineView, ...]:
        """The lines that command zero until a reset."""
        return tuple(line for line in self.lines if line.latch)

    @property
    def releasing(self) -> tuple[LineView, ...]:
        """The lines that command zero for as long as they apply, and let go by themselves."""
        return tuple(line for line in self.lines if line.zero and not line.latch)

    @property
    def has_gaps(self) -> bool:
        """Whether a zero can have numbers in it that a limit leaves to the controller."""
        limiting = any(line.limits for line in self.lines)
        return limiting and bool(self.releasing) and not self.waits

    @property
    def minds_input(self) -> bool:
        """Whether what a zero holds depends on a lost input."""
        return self.has_gaps and "input" in self.lost

    @property
    def asks_for_input(self) -> bool:
        """Whether anything but a line of its own depends on a lost input."""
        limits_of_actions = any(line.limits and not line.lost for line in self.lines)
        return self.minds_input or (limits_of_actions and "input" in self.lost)

    @property
    def refusing(self) -> tuple[int, ...]:
        """The numbers of the lines that refuse a reset while they apply."""
        return tuple(n for n, line in enumerate(self.lines) if line.lost or line.zero)

    @property
    def shown(self) -> tuple[str, ...]:
        """What can hold commands back, one text each: lines, latches, and the wait for a zero."""
        return applying_texts([(line.shown, bool(line.latch)) for line in self.lines], self.waits)

    @property
    def lost(self) -> tuple[str, ...]:
        """What the lines about a loss are about."""
        return tuple(dict.fromkeys(line.lost for line in self.losses if line.lost))


def heeded_actions(gate: Gate, program: Program) -> dict[str, list[tuple[Action, Binding]]]:
    """Return the actions that the lines of a gate speak of, by the topics of their states."""
    heeded = dict.fromkeys(line.action for line in gate.lines if line.action is not None)
    by_topic: dict[str, list[tuple[Action, Binding]]] = {}
    for index in heeded:
        action = program.actions[index]
        assert action.binding is not None, action.name
        by_topic.setdefault(action.binding.topic, []).append((action, action.binding))
    return by_topic


def line_views(
    gate: Gate, program: Program, actions: Iterable[ActionView], names: UniqueNames
) -> tuple[LineView, ...]:
    """Return the views of a gate's lines.

    Args:
        gate: the gate.
        program: the rules that it is of.
        actions: those that its lines speak of.
        names: hands out the names of the local variables.
    """
    states = {action.name: action.state for action in actions}
    return tuple(_line(line, program, states, names) for line in gate.lines)


def _line(
    line: GateLine, program: Program, states: Mapping[str, str], names: UniqueNames
) -> LineView:
    if line.action is not None:
        action = program.actions[line.action].name
        name, title, state = names.new(action), f"Action {action}", states[action]
    else:
        assert line.lost is not None
        name, title, state = names.new("lost", line.lost), f"Lost {line.lost}", ""
    return LineView(
        name=name,
        title=title,
        span=line.span,
        shown=f"{printable_line(line.span.text).rstrip('; ')} ({origin(line.span)})",
        lost=line.lost,
        lost_ns=line.lost_ns or 0,
        state=state,
        limits=line.limits,
        latch=names.new(name, "latched") if line.until_reset else "",
    )


def limiting_lines(gate: Gate, lines: Sequence[LineView]) -> tuple[LineView, ...]:
    """Return the lines among which the first that applies and speaks of a field decides on it.

    What holds all fields at zero whenever it applies is left out: it is decided before.
    """
    return tuple(line for line in lines if not (line.zero and (line.latch or gate.resume_on_zero)))


def deciding_lines(lines: Sequence[LineView], path: str) -> list[tuple[LineView, Limit | None]]:
    """Return the lines that speak of a field, of which the first that applies decides on it.

    Each comes with its limit, or without one where it commands zero. Those that command zero after
    the last limit are left out: there is no limit where they apply, and none where they do not.

    Args:
        lines: the lines of a gate, one of which limits the field.
        path: the field's spelling in the rules.
    """
    found: list[tuple[LineView, Limit | None]] = []
    for line in lines:
        found += [(line, limit) for limit in line.limits if format_path(limit.path) == path]
        if line.zero:
            found.append((line, None))
    while found[-1][1] is None:
        found.pop()
    return found
