"""Simulated time in lock step: the next step comes when everybody has taken in the last one.

Ten minutes pass as fast as the machine allows, yet no timeout fires that would not fire in real
time. A message reaches the safety node and the player at different moments, and so does the clock
itself. Either can be late by a step, for nobody sends his next message before he is through with
the last one. So between two messages of one kind, the safety node's clock shows three steps at
most, which is less than the shortest timeout of the rules, even if one message is lost.
"""

from __future__ import annotations

from collections.abc import Callable

STEP = 0.12
"""Seconds of simulated time in one step: less than a quarter of the shortest timeout."""

WITNESSES = frozenset({"speed", "roll", "nearest", "plc_keep_alive", "controller_keep_alive"})
"""The values in which the share of everybody who feeds the safety node shows."""


class Pace:
    """Counts the simulated time and asks for its steps.

    A step has begun when the simulator's clock shows it. What comes before belongs to an earlier
    step, however late: a node that was reminded in vain sends more than one message for a step.

    Args:
        advance: asks the simulator to advance by so many seconds; zero asks for a repeat.
        ask: asks the safety node for any answer, which shows that it has caught up; the answer
            is to be told by :meth:`answered`.
    """

    def __init__(self, advance: Callable[[float], None], ask: Callable[[], None]) -> None:
        """Begin at zero, with everybody still to be heard."""
        self.now = 0
        self._advance = advance
        self._ask = ask
        self._clock = -1
        self._has_begun = False
        self._awaited = set(WITNESSES)
        self._asked = False
        self._progress = False

    def ticked(self, clock: int) -> None:
        """Note what the simulator's clock shows, in nanoseconds of its own."""
        if clock > self._clock:
            self._clock = clock
            self._has_begun = True

    def seen(self, name: str) -> None:
        """Note a message; after the last one that was awaited it is the safety node's turn."""
        if not self._has_begun:
            return
        self._awaited.discard(name)
        if not self._awaited and not self._asked:
            self._asked = True
            self._ask()

    def answered(self) -> None:
        """Go on to the next step."""
        if not self._asked:
            return  # the answer to a question that was put twice
        self._asked = False
        self._has_begun = False
        self._awaited = set(WITNESSES)
        self._progress = True
        self.now += round(STEP * 1e9)
        self._advance(STEP)

    def remind(self) -> None:
        """Repeat what was last asked for if nothing has moved since the last reminder."""
        if not self._progress:
            if self._asked:
                self._ask()
            else:
                self._advance(0.0)
        self._progress = False
