"""
The monitor of small: what its safety rules say of messages and of time.

It is pure: whoever owns it hands in messages and the time, in nanoseconds of one clock, and takes
out events. Unknown numbers are NaN, with which every comparison is false ('a != b' is written as
'a < b or a > b'); all else that is unknown is None. An interval ('for') is held as the instant at
which it is long enough.
"""

from collections.abc import Callable, Collection
import enum
import math
from typing import NamedTuple

NAN = math.nan
NEVER = 1 << 63  # later than any time in nanoseconds

# The rules that the condition of each behaviour names.
RULES_OF = {
    'behaviour_1': ('e.r',),
}


class EventKind(str, enum.Enum):
    """The kind of an event."""

    TRIGGER = 'trigger'
    RESET = 'reset'
    REFUSED = 'refused'
    CLOCK_STEP = 'clock_step'


class Event(NamedTuple):
    """An event: something that the monitor did, or a step of the clock."""

    t: int
    kind: EventKind
    action: str
    behaviour: str
    arguments: tuple[bool | float | str, ...]
    line: int  # in the rules
    holding: tuple[str, ...] = ()  # the behaviours that refuse a reset, as their conditions hold
    unknown: tuple[str, ...] = ()  # those that refuse it, as their conditions are unknown
    coming: tuple[str, ...] = ()  # those that refuse it, as their conditions are on their way


class Reading(NamedTuple):
    """A term that a rule reads, and its value."""

    term: str
    value: bool | float | str | None  # None is unknown; an age is in seconds


class RuleState(NamedTuple):
    """The verdict of a rule since the last event, and the values behind it."""

    name: str
    line: int  # in the rules
    text: str
    value: bool | None  # None: it is not true, and something that it reads is unknown
    since: int  # when it last became true or ceased to be; else the start or the last clock step
    reads: tuple[Reading, ...]
    causes: tuple[str, ...]  # while it is true: the parts that make it so, with their values


class Explanation(NamedTuple):
    """The verdict of each rule, and why behaviours hold, are on their way, or are unknown."""

    rules: tuple[RuleState, ...]
    causes: dict[str, tuple[str, ...]]


def explained(
    name: str, line: int, text: str, verdict: bool | None, since: int,
    why: Callable[[], tuple[str, ...]], *reads: tuple,
) -> RuleState:
    """Return the state of a rule, with all that is unknown as None."""
    reads = tuple(Reading(term, None if value != value else value) for term, value in reads)
    unknown = any(value is None for _, value in reads)
    value = bool(verdict) or (None if unknown else False)
    return RuleState(name, line, text, value, since, reads, why() if verdict else ())


def shown(value: bool | float | str) -> str:
    """Return a value as causes show it; a text in quotes, on one line of bounded length."""
    if isinstance(value, str):
        line = ''.join(each if each.isprintable() else '?' for each in value[:60])
        return f'"{line}{"…" if len(value) > 60 else ""}"'
    if isinstance(value, float):
        return str(value + 0.0)  # which makes 0.0 of -0.0
    return str(value).lower() if isinstance(value, bool) else str(value)


def because(head: str, causes: tuple[str, ...]) -> str:
    """Return a cause that is a rule, with its own causes."""
    return head + '; '.join(causes)


class Monitor:
    """Evaluates the rules at each message and at each deadline, and emits events."""

    rules_of = RULES_OF

    __slots__ = (
        '_emit',
        '_now',
        '_due',
        '_e_r',
        '_behaviour_1',
        '_v',
        '_e_r_since',
    )

    def __init__(
        self, start: int, emit: Callable[[Event], None], grace: int = 0,
        latched: Collection[str] = (),
    ) -> None:
        """
        Begin at start; timeouts begin to count grace nanoseconds later.

        Those actions in latched that are latched ones are active from the start. emit is called
        with each event, and must neither raise nor call back.
        """
        self._emit = emit
        self._now = start
        self._e_r = False
        self._behaviour_1 = False
        self._restart(start, grace)

    @property
    def next_deadline(self) -> int | None:
        """Return when to call advance() at the latest; possibly nothing is due then."""
        return None if self._due == NEVER else self._due

    @property
    def holding(self) -> tuple[str, ...]:
        """Return the names of the behaviours whose conditions hold."""
        holds = (
            ('behaviour_1', self._behaviour_1),
        )
        return tuple(name for name, held in holds if held)

    @property
    def unknown(self) -> tuple[str, ...]:
        """Return the names of the behaviours whose conditions are unknown, so that they refuse."""
        return ()

    @property
    def coming(self) -> tuple[str, ...]:
        """Return the names of the behaviours whose conditions are on their way, and so refuse."""
        return ()

    @property
    def waiting(self) -> bool:
        """Return whether an input has yet to come for the first time, and is not missing yet."""
        return False

    def explain(self) -> Explanation:
        """Return the state of each rule, and why behaviours hold, are on their way or unknown."""
        rules = (
            explained(
                'e.r', 2, 'r: v;', self._e_r, self._e_r_since, self._why_e_r, ('v', self._v),
            ),
        )
        causes = {}
        if self._behaviour_1:
            causes['behaviour_1'] = self._why_behaviour_1()
        return Explanation(rules, causes)

    def _why_e_r(self) -> tuple[str, ...]:
        """Return why e.r is true."""
        return ('v is true',)

    def _why_behaviour_1(self) -> tuple[str, ...]:
        """Return why behaviour_1 holds."""
        return (because('e.r: ', self._why_e_r()),)

    def advance(self, t: int) -> None:
        """Process all deadlines up to and including t."""
        if not self._now <= t < self._due:
            self._catch_up(t)
        self._now = t

    def reset(self, t: int) -> bool:
        """
        Reset the latched actions whose causes are all known to be over; tell whether none is left.

        An action stays active while a condition that triggers it holds, is on its way or is
        unknown. Before the first event all are unknown.
        """
        self.advance(t)
        return True

    def on_flag(self, t: int, data: bool) -> None:
        """Process a message of /flag (std_msgs/msg/Bool)."""
        if not self._now <= t < self._due:
            self._catch_up(t)
        self._now = t
        # Input v (small.deros:2)
        #   input v = topic /flag.data
        if data == self._v:
            return
        self._v = data
        if self._judge_flag(t):
            self._act(t)

    def _judge_flag(self, t: int) -> bool:
        """Evaluate the rules on /flag; return whether a verdict changed."""
        v = self._v
        changed = False

        # Rule e.r (small.deros:2)
        #   r: v;
        if v:
            if not self._e_r:
                self._e_r = True
                self._e_r_since = t
                changed = True
        elif self._e_r:
            self._e_r = False
            self._e_r_since = t
            changed = True
        return changed

    def _act(self, t: int) -> None:
        """Run the actions of the behaviours whose conditions turned true, then the resets."""
        e_r = self._e_r

        # Behaviour behaviour_1 (small.deros:2)
        #   if e.r then { stop; };
        if e_r:
            if not self._behaviour_1:
                self._behaviour_1 = True
                self._emit(Event(t, EventKind.TRIGGER, 'stop', 'behaviour_1', (), 2))
        else:
            self._behaviour_1 = False

    def _evaluate(self, t: int) -> None:
        """Evaluate all rules and behaviours, at a deadline or a step of the clock."""
        self._judge_flag(t)
        self._act(t)

    def _catch_up(self, t: int) -> None:
        """Process a backward step of the clock, then the deadlines up to t in order."""
        if t < self._now:
            self._now = t
            self._restart(t, 0)
            self._emit(Event(t, EventKind.CLOCK_STEP, '', '', (), 0))
            self._evaluate(t)
        due = self._earliest()
        while due <= t:
            self._now = due
            self._evaluate(due)
            due = self._earliest()
        self._due = due

    def _earliest(self) -> int:
        """Return the earliest deadline ahead."""
        due = NEVER
        return due

    def _restart(self, t: int, grace: int) -> None:
        """Forget all inputs and intervals at t; timeouts count from t + grace."""
        self._e_r_since = t
        self._forget_v()
        self._due = self._earliest()

    def _forget_v(self) -> None:
        """Make the values of input v unknown."""
        self._v = None
