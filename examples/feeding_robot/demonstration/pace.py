"""Simulated time in lock step: the next step comes when everybody has shown the last one.

Ten minutes pass as fast as the machine allows, yet no node ever lags behind by more than a step, so
no timeout fires that would not fire in real time.
"""

from __future__ import annotations

from collections.abc import Callable

STEP = 0.2
"""Seconds of simulated time in one step: less than half of the shortest timeout of the rules."""

WITNESSES = frozenset(
    {"speed", "roll", "nearest", "plc_keep_alive", "controller_keep_alive", "heartbeat"}
)
"""The values that everybody's share in a step shows in."""


class Pace:
    """Counts the simulated time and asks for its steps.

    Args:
        advance: asks the simulator to advance by so many seconds; zero asks for a repeat.
    """

    def __init__(self, advance: Callable[[float], None]) -> None:
        """Begin at zero, with everybody still to be heard."""
        self.now = 0
        self._advance = advance
        self._awaited = set(WITNESSES)
        self._progress = False

    def seen(self, name: str) -> None:
        """Note a message; ask for the next step when it was the last one awaited."""
        self._awaited.discard(name)
        if self._awaited:
            return
        self._awaited = set(WITNESSES)
        self._progress = True
        self.now += round(STEP * 1e9)
        self._advance(STEP)

    def remind(self) -> None:
        """Ask for a repeat when nothing has moved since the last reminder: a message was lost."""
        if not self._progress:
            self._advance(0.0)
        self._progress = False
