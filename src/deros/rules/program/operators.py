"""The temporal operators of rules: a row each, of which follows what they mean.

An operator has one memory. At every event that memory is updated, whatever else the rule reads, and
then the operator has a verdict: true, false or unknown. Rows say both in the syntax of Python, with
these names:

* ``p`` and ``q``, the verdicts of the operands: ``True``, ``False`` or ``None``, which is unknown;
* ``now``, the time of the event, and ``T``, the duration, in nanoseconds; ``NEVER`` is after every
  time; ``N``, a number of times;
* the memory by its own name: in ``update`` its value before, in ``verdict`` after the update;
  ``before`` is there the value before it;
* ``came``: whether each input that ``q`` reads has had a message that counts;
* ``either`` and ``both``, Kleene's disjunction and conjunction.

A time that is remembered is a deadline: at it the verdict may change without a message.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import CodeType
from typing import Literal

Verdict = bool | None
"""What a condition is at an event: true, false or, as ``None``, unknown."""

NEVER = 1 << 63
"""A time after all others, in nanoseconds."""

LONG_AGO = -NEVER
"""A time before all others, in nanoseconds."""

Turns = tuple[bool, tuple[int, ...]]
"""Whether a condition is true, and until when each of its last turns counts, in order."""

Remembered = int | Verdict | Turns
"""What a memory holds: a time in nanoseconds, a verdict, or turns."""


def conjunction(*verdicts: Verdict) -> Verdict:
    """Return Kleene's ``and`` of verdicts."""
    if False in verdicts:
        return False
    return None if None in verdicts else True


def disjunction(*verdicts: Verdict) -> Verdict:
    """Return Kleene's ``or`` of verdicts."""
    if True in verdicts:
        return True
    return None if None in verdicts else False


@dataclass(frozen=True)
class Memory:
    """What an operator remembers from one event to the next.

    Attributes:
        name: as the row's texts name it.
        type: what it is.
        initial: its value at the start, and after a backward step of the clock.
        meaning: what it says, for people.
    """

    name: str
    type: Literal["time", "verdict", "turns"]
    initial: Remembered
    meaning: str


@dataclass(frozen=True)
class TemporalOperator:
    """A row: one temporal operator.

    Attributes:
        word: its keyword in rules.
        memory: what it remembers.
        update: the memory's next value.
        verdict: what the operator is at this event.
    """

    word: str
    memory: Memory
    update: str
    verdict: str
    _update: CodeType = field(init=False, repr=False, compare=False)
    _verdict: CodeType = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Compile the texts."""
        for name in ("update", "verdict"):
            code = compile(getattr(self, name), f"<{self.word}: {name}>", "eval")
            object.__setattr__(self, f"_{name}", code)

    def step(
        self, before: Remembered, names: Mapping[str, Remembered]
    ) -> tuple[Remembered, Verdict]:
        """Return the memory after an event, and the verdict at it.

        Args:
            before: the memory as of the last event.
            names: the values of ``p``, ``q``, ``now``, ``T``, ``N`` and ``came``, those there are.
        """
        known = {**names, self.memory.name: before}
        after: Remembered = eval(self._update, _NAMES, known)  # a constant of this module
        known |= {self.memory.name: after, "before": before}
        verdict: Verdict = eval(self._verdict, _NAMES, known)
        return after, verdict

    def deadline(self, remembered: Remembered) -> int | None:
        """Return when the verdict may change without a message, in nanoseconds; may be past."""
        if isinstance(remembered, tuple):
            return next(iter(remembered[1]), None)
        if self.memory.type != "time" or remembered is None or remembered == NEVER:
            return None
        return remembered


_NAMES: dict[str, int | Callable[..., Verdict]] = {
    "NEVER": NEVER,
    "LONG_AGO": LONG_AGO,
    "both": conjunction,
    "either": disjunction,
}

FOR = TemporalOperator(
    "for",
    Memory("due", "time", NEVER, "when the operand will have been true for long enough"),
    update="NEVER if p is not True else now + T if due == NEVER else due",
    verdict="p if p is not True else now >= due",
)
"""True once the operand has been true for the duration, without a break."""

WITHIN = TemporalOperator(
    "within",
    Memory(
        "until", "time", LONG_AGO, "until when it stays true; never ends while the operand is true"
    ),
    update="NEVER if p is True else now + T if until == NEVER else until",
    verdict="True if now < until else p",
)
"""True while the operand is, and for the duration from the event at which it ceased to be."""

TIMES = TemporalOperator(
    "times",
    Memory("turns", "turns", (False, ()), "its operand's last turns, and until when each counts"),
    update="(p is True, turns[1]) if p is not True or turns[0]"
    " else (True, ((LONG_AGO,) * N + turns[1] + (now + T,))[-N:])",
    verdict="True if turns[1] and now < turns[1][0] else None if p is None else False",
)
"""True while so many turns of the operand, to true, lie less than the duration back."""

SINCE = TemporalOperator(
    "since",
    Memory("kept", "verdict", False, "its verdict as the next event remembers it"),
    update="either(q if came else q is True, both(p, kept))",
    verdict="either(q, both(p, before))",
)
"""True at the cause ``q``, and from then on while the operand ``p`` is."""

OPERATORS: Mapping[str, TemporalOperator] = {
    each.word: each for each in (FOR, WITHIN, TIMES, SINCE)
}
"""Every row, by its keyword."""
