"""The state of a monitor between two events."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field

from deros.rules.functions.memories import Memory
from deros.rules.program import walk
from deros.rules.program.ir import Frequency, Program, Scalar
from deros.rules.program.operators import Remembered, Verdict

LeafValue = Scalar | Sequence[Scalar] | None
"""A leaf's value as it comes in a message; ``None``: the message has no such array element."""


@dataclass(slots=True)
class InputState:
    """One input.

    Attributes:
        base_ns: from when its timeout counts: the last counted message, the start or a clock step.
        counted_ns: the time of the last message that counted; ``None`` before the first.
        missing: whether the timeout has passed since ``base_ns``.
        known: whether it has a value.
        stamps_ns: when its last messages came that counted, the last one at the end; as many as its
            frequencies look at. Before these have come, the start or a clock step stands for them.
    """

    base_ns: int
    counted_ns: int | None = None
    missing: bool = False
    known: bool = False
    stamps_ns: deque[int] = field(default_factory=deque)

    @property
    def awaited(self) -> bool:
        """Whether it waits for its first message that counts, and is not missing yet."""
        return self.counted_ns is None and not self.missing


class State:
    """The whole state of a monitor, at its start.

    Attributes:
        constants: of each tunable constant.
        values: of each leaf, ``None`` while its input is unknown.
        inputs: of each input.
        memories: of each function with a ``state`` number.
        remembered: of each temporal condition, what its row says; those missing here have the
            initial value.
        verdicts: of each rule, as of the last event.
        turned_ns: of each rule, when it last became true or ceased to be; the start, or the last
            step of the clock, if it did not since.
        holds: of each behaviour, Kleene's ``and`` of its condition and all that enclose it, as of
            the last event; unknown before the first.
        enabled: of each behaviour; those that are not optional always are.
        active: of each action, whether it was triggered and not reset since.
    """

    def __init__(self, program: Program, start_ns: int, behaviours: int, grace_ns: int = 0) -> None:
        """Remember nothing yet; timeouts count from ``grace_ns`` after ``start_ns``."""
        self._program = program
        self._messages = walk.most_messages(walk.conditions(program))
        self.constants = [each.default for each in program.tunables]
        self.verdicts: list[Verdict] = [None] * len(program.rules)
        self.holds: list[Verdict] = [None] * behaviours
        self.enabled = [True] * behaviours
        self.active = [False] * len(program.actions)
        self.forget(start_ns, grace_ns)

    def forget(self, t_ns: int, grace_ns: int = 0) -> None:
        """Drop all that was observed: every interval and every input. Verdicts and actions stay."""
        self.turned_ns = [t_ns] * len(self._program.rules)
        self.values: list[LeafValue] = [None] * len(self._program.leaves)
        base_ns = t_ns + grace_ns
        self.inputs = [
            InputState(base_ns, stamps_ns=deque([base_ns] * most, most))
            for each in self._program.inputs
            for most in (self._messages.get(each.index, 0),)
        ]
        self.memories: dict[int, Memory] = {}
        self.remembered: dict[int, Remembered] = {}

    def first_of(self, frequency: Frequency) -> int:
        """Return when the first of the last messages came that a frequency looks at."""
        return self.inputs[frequency.input].stamps_ns[-frequency.messages]

    def make_unknown(self, index: int) -> None:
        """Make one input unknown; its age and its timeout are not values and continue."""
        self.inputs[index].known = False
        for leaf in self._program.inputs[index].leaves:
            self.values[leaf] = None
