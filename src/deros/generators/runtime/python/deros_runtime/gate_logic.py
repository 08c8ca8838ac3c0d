"""
What a gate does: it plays the table of its lines.

The lines of a gate mean the following:

* A line applies while its action is active *as far as the gate knows*, or while what it names is
  lost. What the gate does not know counts against the command: an action counts as active before
  the first message about its state, and from a loss of the heartbeat until the next such message.
* The heartbeat, or the input, is lost from the start until it first arrives, and again at the
  instant when it has been silent for the line's time (inclusive). A refused command makes the
  input lost at once, until the next good one.
* A heartbeat is a sign of life if its counter is greater than that of the one before. A heartbeat
  whose counter is not makes the heartbeat lost at once; like the first one, it is what the next
  one is compared with. Where more than one node publishes the heartbeat, nothing is known.
* A state that may come from another node than the safety node makes an action active, never
  inactive.
* For each number of the command, the first line that applies and names it decides; ``zero`` names
  all of them. The limits of an action do not apply while the heartbeat or the input is lost.
* A line with ``zero until reset`` that has applied is *latched* until the gate is reset: every
  number is zero, whether or not the line still applies. A reset is refused, and not remembered,
  while a line with ``zero`` applies or anything is lost.
* With ``resume on zero command``, the gate *waits* from the start, and after each zero line that
  applies or is latched: every number is zero. The wait ends with a good command that is zero and
  arrives while nothing is latched and no zero line applies.
* A good command is published at once, within the limits. While a zero line decides, it is not
  published: zeros are, at once and then with the gate's period, until no zero line decides.
* A limit that starts to apply between two commands is applied to the one being executed: if that
  exceeds it, it is published again within the limits. When a line ends, nothing is published.

It uses nothing of ROS 2: the caller passes each event with its time in nanoseconds of one clock,
and a function that publishes. ``deros simulate`` runs this very class.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

NEVER = 1 << 63  # later than any time in nanoseconds

Limit = tuple[float, float]  # the least and the greatest value
Limits = tuple[Limit | None, ...]  # of the table's fields; None: no limit
Values = tuple[float | None, ...]  # of the same fields; None: not in the message
Output = Literal['pass', 'limited', 'zero']


@dataclass(frozen=True)
class Line:
    """
    One line of a gate: when it applies, and what it does to the command then.

    Either action is the name of an action, or lost says what has to be silent for lost_ns. Either
    the line commands zero, perhaps until_reset, or limits holds intervals by the names of fields.
    text is the line as it is reported, with its place; is_severe makes the report an error.
    """

    text: str
    action: str = ''
    lost: Literal['', 'heartbeat', 'input'] = ''
    lost_ns: int = 0
    zero: bool = False
    until_reset: bool = False
    limits: Mapping[str, Limit] = field(default_factory=dict)
    is_severe: bool = False


@dataclass(frozen=True)
class Table:
    """
    All that distinguishes a gate from others, but for the type of its commands.

    actions are those that the lines name, and fields those that have limits; period_ns is the time
    between two zeros. Earlier lines take precedence.
    """

    lines: tuple[Line, ...]
    actions: tuple[str, ...]
    fields: tuple[str, ...]
    period_ns: int
    resume_on_zero: bool = False

    @property
    def latching(self) -> tuple[int, ...]:
        """Return the numbers of the lines that command zero until a reset."""
        return tuple(number for number, line in enumerate(self.lines) if line.until_reset)

    @property
    def reports(self) -> tuple[str, ...]:
        """Return the texts of Gate.applying."""
        waits = ('waits for a zero command',) if self.resume_on_zero else ()
        return (
            *(line.text for line in self.lines),
            *(f'waits for a reset, after {self.lines[number].text}' for number in self.latching),
            *waits,
        )


def kept(values: Values, limits: Limits) -> Values:
    """Return values within their limits."""
    return tuple(map(_kept, values, limits))


def _kept(value: float | None, limit: Limit | None) -> float | None:
    if value is None or limit is None or limit[0] <= value <= limit[1]:
        return value
    return limit[0] if value < limit[0] else limit[1]


class Gate:
    """
    Finds which lines of a table apply, and publishes at once.

    While a command is being published, now is its instant. applying holds, for each of the table's
    reports, whether it applies; since is when that changed last.
    """

    def __init__(
        self, table: Table, start: int, publish: Callable[[Output, Values], None]
    ) -> None:
        """
        Start at start; the first call publishes.

        publish(what, values) is called with 'pass' for the last good command as it arrived,
        'limited' for it with those values in the limited fields, or 'zero' for zeros with those
        values that are not None.
        """
        self.table = table
        self._publish = publish
        self._no_limits: Limits = (None,) * len(table.fields)
        self._command: Values | None = None  # the last good one
        self._executed: Values | None = None  # what was published last, unless that was zeros
        self._latched: set[int] = set()  # numbers of lines
        self.applying = (False,) * len(table.reports)
        self.since = start
        self._begin(start)

    def _begin(self, t: int) -> None:
        """Forget all but latches: actions count as active, and all that can be lost is lost."""
        self.now = self._called = t
        self._active = dict.fromkeys(self.table.actions, True)
        self._last = {'heartbeat': -NEVER, 'input': -NEVER}  # times of the last signs of life
        self._counter: int | None = None  # of the last heartbeat
        self._heartbeat_was_lost = True
        self._waits = self.table.resume_on_zero  # for a command that is zero
        self._decision: tuple[bool, Limits] = (False, self._no_limits)
        self._zero_due = t
        self._lost_due = NEVER

    # Events

    def on_command(self, t: int, values: Values = (), is_zero: bool = False) -> None:
        """
        Take a command whose numbers are finite.

        values are those of the table's fields; is_zero: all of its numbers are zero.
        """
        self.advance(t)
        self._last['input'] = t
        self._command = values
        self._settle(t, is_new=True, is_zero=is_zero)

    def on_refused(self, t: int) -> None:
        """Take a refused command."""
        self.advance(t)
        self._last['input'] = -NEVER
        self._settle(t)

    def on_state(self, t: int, active: Mapping[str, bool], is_trusted: bool) -> bool:
        """
        Take the states of actions that one message holds; True for unknown ones.

        An untrusted message, perhaps not from the safety node, makes nothing inactive. Return
        whether the stored states equal those of the message.
        """
        self.advance(t)
        for action, is_active in active.items():
            if is_active or is_trusted:
                self._active[action] = is_active
        self._settle(t)
        return all(self._active[action] == is_active for action, is_active in active.items())

    def on_heartbeat(self, t: int, counter: int) -> None:
        """Take a heartbeat of the safety node: a sign of life if its counter has advanced."""
        self.advance(t)
        is_alive = self._counter is not None and counter > self._counter
        self._counter = counter
        self._last['heartbeat'] = t if is_alive else -NEVER
        self._settle(t)

    def on_no_safety_node(self, t: int) -> None:
        """Note that no node, or more than one, can be the safety node."""
        self.advance(t)
        self._active = dict.fromkeys(self.table.actions, True)
        self._counter = None
        self._last['heartbeat'] = -NEVER
        self._settle(t)

    def on_reset(self, t: int) -> tuple[int, ...]:
        """Decide a reset; return the numbers of lines that refuse it: with none, it is done."""
        self.advance(t)
        against = tuple(
            number
            for number, line in enumerate(self.table.lines)
            if (line.zero or line.lost) and self.applying[number]
        )
        if not against:
            self._latched.clear()
            self._settle(t)
        return against

    # Time

    @property
    def next_deadline(self) -> int:
        """Return when to call advance() at the latest."""
        return min(self._zero_due, self._lost_due)

    def advance(self, t: int) -> None:
        """Handle everything due up to and including t."""
        self._called = t
        if t < self.now:
            self._begin(t)  # the clock stepped back
        while self.next_deadline <= t:
            self._settle(self.next_deadline)
        self.now = t

    # Decisions

    def _settle(self, t: int, is_new: bool = False, is_zero: bool = False) -> None:
        """Find the lines that apply at t, and publish; is_new: a command has just arrived."""
        self.now = t
        lines = self.table.lines
        lost = {line.lost for line in lines if line.lost and t >= self._loss(line)}
        self._forget_actions('heartbeat' in lost)
        applies = [self._applies(line, bool(lost)) for line in lines]
        self._latched.update(number for number in self.table.latching if applies[number])
        applying = [line for number, line in enumerate(lines) if applies[number]]
        is_stopped = bool(self._latched) or any(line.zero for line in applying)
        # After zeros, nothing passes until a zero command arrives while no line commands zero.
        self._waits = self.table.resume_on_zero and (is_stopped or (self._waits and not is_zero))
        self._follow(is_stopped or self._waits, self._limits(applying), is_new, 'input' in lost)
        self._report(applies, self._waits and not is_stopped)
        losses = [self._loss(line) for line in lines if line.lost]
        self._lost_due = min((each for each in losses if each > t), default=NEVER)

    def _loss(self, line: Line) -> int:
        """Return the instant from which a line about a loss applies."""
        return self._last[line.lost] + line.lost_ns

    def _forget_actions(self, is_lost: bool) -> None:
        """Count actions as active at a loss of the heartbeat, until their next message."""
        if is_lost and not self._heartbeat_was_lost:
            self._active = dict.fromkeys(self.table.actions, True)
        self._heartbeat_was_lost = is_lost

    def _applies(self, line: Line, is_lost: bool) -> bool:
        """Return whether a line applies; is_lost: so does one about a loss."""
        if line.lost:
            return self.now >= self._loss(line)
        return self._active[line.action] and (line.zero or not is_lost)

    def _limits(self, applying: Sequence[Line]) -> Limits:
        """Return the limits in force: none where every number is zero."""
        if self._latched or self._waits:
            return self._no_limits
        return tuple(_limit(name, applying) for name in self.table.fields)

    def _report(self, applies: Sequence[bool], waits: bool) -> None:
        applying = (
            *applies,
            *(number in self._latched and not applies[number] for number in self.table.latching),
            *((waits,) if self.table.resume_on_zero else ()),
        )
        if applying != self.applying:
            self.applying, self.since = applying, self.now

    # Publishing

    def _follow(self, zero: bool, limits: Limits, is_new: bool, is_input_lost: bool) -> None:
        """Publish what the lines that apply decide."""
        is_changed = (zero, limits) != self._decision
        self._decision = zero, limits
        if zero:
            if is_changed or self.now >= self._zero_due:
                self._publish_zero(None if is_input_lost else self._command, limits)
            return
        self._zero_due = NEVER
        if is_new and self._command is not None:
            self._executed = kept(self._command, limits)
            is_same = self._executed == self._command
            self._publish('pass' if is_same else 'limited', self._executed)
        elif self._executed is not None and kept(self._executed, limits) != self._executed:
            self._executed = kept(self._executed, limits)
            self._publish('limited', self._executed)

    def _publish_zero(self, command: Values | None, limits: Limits) -> None:
        """
        Publish zeros; one message replaces all that are overdue in a late call.

        Fields with a limit in force are left to the command, if there is one.
        """
        period = self.table.period_ns
        self._zero_due = self.now + period * ((self._called - self.now) // period + 1)
        self._executed = None
        values: Values = (None,) * len(limits) if command is None else kept(command, limits)
        free = [None if limit is None else values[i] for i, limit in enumerate(limits)]
        self._publish('zero', tuple(free))


def _limit(name: str, applying: Sequence[Line]) -> Limit | None:
    """Return what the first line that names a field says; a line with zero names all fields."""
    first = next((line for line in applying if line.zero or name in line.limits), None)
    return None if first is None else first.limits.get(name)
