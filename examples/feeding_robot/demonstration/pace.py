"""Simulated time in lock step: the next step comes when everybody has taken in the last one.

Ten minutes pass as fast as the machine allows, yet no node ever lags behind by more than a step, so
no timeout fires that would not fire in real time.
"""

from __future__ import annotations

from collections.abc import Callable

STEP = 0.2
"""Seconds of simulated time in one step: less than half of the shortest timeout of the rules."""

WITNESSES = frozenset({"speed", "roll", "nearest", "plc_keep_alive", "controller_keep_alive"})
"""The values in which the share of everybody who feeds the safety node shows."""


class Pace:
    """Counts the simulated time and asks for its steps.

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
        self._awaited = set(WITNESSES)
        self._asked = False
        self._progress = False

    def seen(self, name: str) -> None:
        """Note a message; after the last one that was awaited it is the safety node's turn."""
        self._awaited.discard(name)
        if not self._awaited and not self._asked:
            self._asked = True
            self._ask()

    def answered(self) -> None:
        """Go on to the next step."""
        if not self._asked:
            return  # the answer to a question that was put twice
        self._asked = False
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
