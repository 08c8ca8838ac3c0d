"""
What a gate does: it plays the table of its lines.

The lines of a gate mean the following:

* A line applies while its action is active *as far as the gate knows*, or while what it names is
  lost. What the gate does not know counts against the command: an action counts as active before
  the first message about its state, and from a loss of the heartbeat until the next such message.
* The heartbeat, or the input, is lost from the start until it first arrives, and again at the
  instant when it has been silent for the line's time (inclusive). A refused command makes the
  input lost at once, until the next good one.
* Of several sources, the first one whose last command is younger than its time is *chosen*: its
  commands pass, and no others. If its last command was refused, or there is no such source, the
  input is lost. At the instant at which another one is chosen, its last command passes.
* A heartbeat is a sign of life if its counter is greater than that of the one before. A heartbeat
  whose counter is not makes the heartbeat lost at once; like the first one, it is what the next
  one is compared with. Where more than one node publishes the heartbeat, nothing is known.
* A state that may come from another node than the safety node makes an action active, never
  inactive.
* For each number of the command, the first line that applies and names it decides; a line that
  *stops* names all of them. The limits of an action do not apply while the heartbeat or the input
  is lost. Limits that stand (``always``) hold beside those, whatever else applies.
* A line that stops ``until reset`` and has applied is *latched* until the gate is reset: the gate
  stops, whether or not the line still applies. A reset is refused, and not remembered, while a
  line that stops applies or anything is lost.
* With ``resume on zero command``, the gate *waits* from the start, and after each line that stops
  and applies or is latched: it stops. The wait ends with a good command that is zero, or what a
  line would send, and arrives while nothing is latched and no line that stops applies. It waits as
  well each time a source is chosen that passes ``from zero``, until that one has commanded zero
  so, or another one is chosen.
* How the gate stops is said by the first line that stops and applies or is latched; while the gate
  waits, by the one that was in force last, and at the start by the first of all.
* A good command is published at once, within the limits. While the gate stops, it is not: what the
  line says is, at once and then with the gate's period. That is ``zero``; or the fields that it
  ``send``s, all other numbers zero; or, with ``hold``, the command being executed; or, with
  ``silence``, nothing. Once something else has been published, or after a silence, there is
  nothing to hold.
* A line that *waits* before moving concerns a good command that is not zero (nor what a line
  sends) and comes while the gate neither stops nor waits for zero, if what was published last does
  not move. It is held back, and the gate stops at zero, or as it did last where no line commands
  zero, until the action has been known to be active for the line's time since the first such
  command. The next one passes then. A zero command, a stop or the loss of the input ends the wait.
* A field with a *ramp* goes to zero from its value in the command being executed, by no more than
  its rate, from the instant at which the line begins to decide. A line with another ramp that
  begins to decide meanwhile goes on from there; one without it makes the field zero at once, and
  so does a clock that steps back. A field that a limit has left to the command until then falls
  from what was published last: with a lost input, from zero. So does one of a gate that stops
  again before a command has passed.
* A limit that starts to apply between two commands is applied to the one being executed: if that
  exceeds it, it is published again within the limits. When a line ends, nothing is published.
* An end of a limit that stands may be the number of an input, that of its last message: unknown
  before the first one, at the instant when the input has been silent for its time (inclusive), and
  when it is NaN; or it is a parameter. An unknown end is zero. A limit that becomes narrower is
  applied at once: to the command being executed, to the one that is held, and to fields that have
  not fallen to zero yet, which then go on falling from their limits.

It uses nothing of ROS 2: the caller passes each event with its time in nanoseconds of one clock,
and a function that publishes. ``deros simulate`` runs this very class.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Literal

from .gate_limits import kept, limit_of, Limits, StandingLimits
from .gate_limits import Values as Values
from .gate_ramps import filled, Ramps
from .gate_sources import NEVER as NEVER
from .gate_sources import Sources
from .gate_table import Line, Stop, Table, ZERO

Output = Literal['pass', 'limited', 'zero', 'send', 'hold']


class Gate:
    """
    Finds which lines of a table apply, and publishes at once.

    While a command is being published, now is its instant, deciding the number of the line by
    which the gate stops, source that of the source whose command is executed, and renews says
    whether it is the one that was published last, which a new limit narrows. applying holds,
    for each of the table's reports, whether it applies, but never for limits that stand; since is
    when that changed last.
    """

    def __init__(
        self,
        table: Table,
        start: int,
        publish: Callable[[Output, Values], None],
        parameters: Mapping[str, float] | None = None,
    ) -> None:
        """
        Start at start; the first call publishes. parameters are those that bounds name.

        publish(what, values) is called with 'pass' for the last good command as it arrived,
        'limited' for it with those values in the table's fields, 'zero' for zeros with those that
        are not None, 'send' for what the line sends, or 'hold' for what was published last, with
        those values if there are any.
        """
        self.table = table
        self._publish = publish
        self._no_limits: Limits = (None,) * len(table.fields)
        self._standing = StandingLimits(table, parameters or {})
        commands_zero = any(line.stop and line.stop.what == 'zero' for line in table.lines)
        self._waiting = table.waiting
        self._rest = ZERO if commands_zero else None  # how the gate waits before moving
        self.deciding = next((n for n, line in enumerate(table.lines) if line.stop), -1)
        self._sources = Sources(table.sources)
        self.source = 0
        self.renews = False
        self._command: Values | None = None  # the last good one of that source
        self._executed: Values | None = None  # the command being executed
        self._zeros_before: Values = (None,) * len(table.fields)  # the fields of the last one
        self._is_falling = False  # what was published last are such zeros
        self._latched: set[int] = set()  # numbers of lines
        self.applying = (False,) * len(table.reports)
        self.since = start
        self._begin(start)

    def _begin(self, t: int) -> None:
        """Forget all but latches: actions count as active, and all that can be lost is lost."""
        self.now = self._called = t
        self._active = dict.fromkeys(self.table.actions, True)
        self._sources.forget()
        self._standing.forget()
        self._ramps = Ramps(self.table.fields, t)
        self._is_falling = False
        self._heartbeat = -NEVER  # time of the last sign of life
        self._counter: int | None = None  # of the last heartbeat
        self._heartbeat_was_lost = True
        self._waits = self.table.resume_on_zero  # for a command that is zero
        self._takes_over = False  # the chosen source has to command zero first
        self._active_since: dict[str, int] = {}  # of actions known to be active
        self._moves = False  # whether what was published last does
        self._wished_since: int | None = None  # to move, which waits
        self._decision: tuple[Stop | None, Limits] = (None, self._no_limits)
        self._decided = self.deciding
        self._zero_due = t
        self._lost_due = NEVER

    # Events

    def on_command(
        self, t: int, values: Values = (), is_zero: bool = False, source: int = 0
    ) -> None:
        """
        Take a command whose numbers are finite.

        values are those of the table's fields; is_zero: all of its numbers are zero, or it is what
        a line sends; source is the number of its source in the table.
        """
        self.advance(t)
        self._sources.take(t, source, (values, is_zero))
        if source == self.source:
            self._command = values  # zeros have its form, even while it is not chosen
        self._settle(t)

    def on_refused(self, t: int, source: int = 0) -> None:
        """Take a refused command."""
        self.advance(t)
        self._sources.take(t, source, None)
        self._settle(t)

    def on_state(self, t: int, active: Mapping[str, bool], is_trusted: bool) -> bool:
        """
        Take the states of actions that one message holds; True for unknown ones.

        An untrusted message, perhaps not from the safety node, makes nothing inactive, and nothing
        that a line waits for known to be active. Return whether it would say no more if trusted.
        """
        self.advance(t)
        for action, is_active in active.items():
            if is_active or is_trusted:
                self._active[action] = is_active
                if not is_active:
                    self._active_since.pop(action, None)
                elif is_trusted:
                    self._active_since.setdefault(action, t)
        self._settle(t)
        unknown = self.table.awaited - self._active_since.keys()
        return all(
            self._active[action] == is_active and not (is_active and action in unknown)
            for action, is_active in active.items()
        )

    def on_inputs(self, t: int, numbers: Mapping[int, float | None]) -> None:
        """Take the numbers that one message holds for inputs of the table; None: unknown."""
        self.advance(t)
        self._standing.take(t, numbers)
        self._settle(t)

    def on_heartbeat(self, t: int, counter: int) -> None:
        """Take a heartbeat of the safety node: a sign of life if its counter has advanced."""
        self.advance(t)
        is_alive = self._counter is not None and counter > self._counter
        self._counter = counter
        self._heartbeat = t if is_alive else -NEVER
        self._settle(t)

    def on_no_safety_node(self, t: int) -> None:
        """Note that no node, or more than one, can be the safety node."""
        self.advance(t)
        self._forget_actions()
        self._counter = None
        self._heartbeat = -NEVER
        self._settle(t)

    def on_reset(self, t: int) -> tuple[int, ...]:
        """Decide a reset; return the numbers of lines that refuse it: with none, it is done."""
        self.advance(t)
        against = tuple(
            number
            for number, line in enumerate(self.table.lines)
            if (line.stop or line.lost) and self.applying[number]
        )
        if not against:
            self._latched.clear()
            self._settle(t)
        return against

    # Time

    @property
    def source_name(self) -> str:
        """Return the topic whose commands may pass, if there is one among several."""
        sources, chosen = self.table.sources, self._sources.chosen
        return sources[chosen].topic if sources and chosen is not None else ''

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

    def _settle(self, t: int) -> None:
        """Find the lines that apply at t, and publish."""
        self.now = t
        self._standing.settle(t)
        is_new, is_zero = self._choose()
        lines = self.table.lines
        lost = {line.lost for line in lines if line.lost and t >= self._loss(line)}
        if 'heartbeat' in lost and not self._heartbeat_was_lost:
            self._forget_actions()  # until their next message
        self._heartbeat_was_lost = 'heartbeat' in lost
        applies = [self._applies(line, bool(lost)) for line in lines]
        self._latched.update(number for number in self.table.latching if applies[number])
        stopping = [
            number
            for number, line in enumerate(lines)
            if line.stop and (applies[number] or number in self._latched)
        ]
        self.deciding = next(iter(stopping), self.deciding)
        # After a stop, nothing passes until a zero command arrives while no line stops.
        is_zero = is_zero and not stopping
        self._waits = self.table.resume_on_zero and (bool(stopping) or self._waits) and not is_zero
        self._takes_over = self._takes_over and not is_zero
        waits = self._waits or self._takes_over
        stop = self._stop() if stopping or waits else None
        is_held = self._is_held(stop, is_new, is_zero, 'input' in lost)
        if is_held:
            stop = self._rest or self._stop()
        applying = [line for number, line in enumerate(lines) if applies[number]]
        limits = self._no_limits if is_held or waits else self._limits(applying, stop)
        self._follow(stop, limits, is_new, 'input' in lost)
        for number in self._waiting:
            applies[number] = is_held
        self._report(applies, waits and not stopping)
        losses = [
            self._sources.due,
            self._standing.due,
            *(self._loss(line) for line in lines if line.lost),
        ]
        self._lost_due = min((each for each in losses if each > t), default=NEVER)

    def _choose(self) -> tuple[bool, bool]:
        """Choose a source; return whether a command is new, and whether it is zero."""
        command = self._sources.choose(self.now)
        chosen = self._sources.chosen
        if self._sources.has_changed:
            sources = self.table.sources
            self._takes_over = bool(sources) and chosen is not None and sources[chosen].from_zero
        if command is None or chosen is None:
            return False, False
        self.source = chosen
        self._command, is_zero = command
        return True, is_zero

    def _stop(self) -> Stop:
        """Return how the gate stops; a gate of which no line stops can still wait, at zero."""
        deciding = self.table.lines[self.deciding] if self.deciding >= 0 else None
        return deciding.stop if deciding is not None and deciding.stop else ZERO

    def _loss(self, line: Line) -> int:
        """Return the instant from which a line about a loss applies."""
        last = self._heartbeat if line.lost == 'heartbeat' else self._sources.lost_from
        return last + line.lost_ns

    def _is_held(
        self, stop: Stop | None, is_new: bool, is_zero: bool, is_input_lost: bool
    ) -> bool:
        """Return whether a command that moves waits; is_new: one has just come."""
        if not self._waiting:
            return False
        if stop is not None or is_input_lost or (is_new and is_zero):
            self._wished_since = None
            # What is held may move; after a silence, nobody knows.
            self._moves = self._moves and stop is not None and stop.what == 'hold'
            return False
        if not is_new:
            return self._wished_since is not None
        if not self._moves and self._wished_since is None:
            self._wished_since = self.now
        self._moves = self._moves or self._has_waited()
        if self._moves:
            self._wished_since = None
        return not self._moves

    def _has_waited(self) -> bool:
        """Return whether each action has been active for long enough since the wish to move."""
        wished = self.now if self._wished_since is None else self._wished_since
        since = self._active_since
        return all(
            line.action in since and self.now >= max(since[line.action], wished) + line.wait_ns
            for line in (self.table.lines[number] for number in self._waiting)
        )

    def _forget_actions(self) -> None:
        """Count actions as active, though not as known to be."""
        self._active = dict.fromkeys(self.table.actions, True)
        self._active_since.clear()

    def _applies(self, line: Line, is_lost: bool) -> bool:
        """Return whether a line applies; is_lost: so does one about a loss."""
        if line.lost:
            return self.now >= self._loss(line)
        if line.is_standing or line.wait_ns:
            return False  # it stands, or waits, beside the lines that apply
        return self._active[line.action] and (line.stop is not None or not is_lost)

    def _limits(self, applying: Sequence[Line], stop: Stop | None) -> Limits:
        """Return the limits in force beside the standing ones: none where the stop is whole."""
        if self._latched or (stop and stop.what != 'zero'):
            return self._no_limits
        return tuple(limit_of(name, applying) for name in self.table.fields)

    def _report(self, applies: Sequence[bool], waits: bool) -> None:
        applying = (
            *applies,
            *(number in self._latched and not applies[number] for number in self.table.latching),
            *((waits,) if self.table.waits_for_zero else ()),
            *self._standing.unknown,
        )
        if applying != self.applying:
            self.applying, self.since = applying, self.now

    # Publishing

    def _follow(
        self, stop: Stop | None, limits: Limits, is_new: bool, is_input_lost: bool
    ) -> None:
        """Publish what the lines that apply decide."""
        before, decided = self._decision, self._decided
        self._decision, self._decided = (stop, limits), self.deciding
        if stop is not None:
            is_sent_by_other = stop.what == 'send' and decided != self.deciding
            if stop != before[0] or is_sent_by_other:
                self._ramps.begin(self.now, before[0], self._in_effect(before[0]))
            is_new_stop = self._decision != before or is_sent_by_other
            if is_new_stop or self.now >= self._zero_due or self._exceeds_limits(stop):
                self._publish_stop(stop, None if is_input_lost else self._command, limits)
            return
        self._zero_due = NEVER
        if is_new and self._command is not None:
            self._is_falling = False
            self._executed = self._within(self._command, limits)
            what: Output = 'pass' if self._executed == self._command else 'limited'
            self._publish(what, self._executed)
        elif self._executed is not None:
            within = self._within(self._executed, limits)
            if within != self._executed:
                self._executed, self.renews = within, True
                self._publish('limited', within)
                self.renews = False

    def _within(self, values: Values, limits: Limits) -> Values:
        return kept(kept(values, limits), self._standing.limits)

    def _exceeds_limits(self, stop: Stop) -> bool:
        """Return whether what the gate stops with was published before the limits narrowed."""
        values = {'hold': self._executed, 'zero': self._zeros_before}.get(stop.what)
        return values is not None and kept(values, self._standing.limits) != values

    def _publish_stop(self, stop: Stop, command: Values | None, limits: Limits) -> None:
        """Publish what the gate stops with; one message replaces all overdue in a late call."""
        period = self.table.period_ns
        self._zero_due = self.now + period * ((self._called - self.now) // period + 1)
        if stop.what == 'hold':
            if self._executed is not None:
                within = kept(self._executed, self._standing.limits)
                self._publish('hold', () if within == self._executed else within)
                self._executed = within
            return
        self._executed = None
        self._is_falling = stop.what == 'zero'
        if stop.what == 'silence':
            self._zero_due = NEVER
        elif stop.what == 'send':
            self._publish('send', ())
        else:
            zeros = self._zeros(stop, command, limits)
            self._zeros_before = filled(zeros, self._command)
            self._publish('zero', zeros)

    def _in_effect(self, before: Stop | None) -> Values | None:
        """Return the command from which fields begin to fall; None: they go on from before."""
        goes_on = self._executed is None and before is None and self._is_falling
        return self._zeros_before if goes_on else self._executed  # where a stop has ended

    def _zeros(self, stop: Stop, command: Values | None, limits: Limits) -> Values:
        """
        Return the fields that are not zero yet, or not at all.

        Those with a limit in force are left to the command, if there is one.
        """
        nothing: Values = (None,) * len(limits)
        left = nothing if command is None else self._within(command, limits)
        falling = self._standing.rounded(self._ramps.falling(stop, self._called))
        # Zeros have the form of the last good command: a field that it lacks cannot fall.
        form = nothing if self._command is None else self._command
        values = [
            left[i] if limit is not None else None if form[i] is None else falling[i]
            for i, limit in enumerate(limits)
        ]
        within = kept(tuple(values), self._standing.limits)
        for i, (value, limit) in enumerate(zip(within, limits, strict=True)):
            if limit is not None or value != values[i]:
                self._ramps.go_on(self._called, i, value)
        return within
