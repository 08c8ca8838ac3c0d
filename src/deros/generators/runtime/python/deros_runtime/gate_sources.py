"""Whose commands pass, of several sources of a gate."""

from __future__ import annotations

from collections.abc import Sequence

from .gate_table import Source

NEVER = 1 << 63  # later than any time in nanoseconds

Command = tuple[tuple[float | None, ...], bool]  # the table's fields, and whether it is zero


class Sources:
    """
    Chooses the first source that has spoken within its time.

    A source whose last command was refused has spoken, but has no command: none passes then, not
    even of a later source. chosen is the number of the source whose commands pass, None without
    one; has_changed, whether it is another one than at the last choice.
    """

    def __init__(self, sources: Sequence[Source]) -> None:
        """Start without a command; a single source may have no time."""
        self._times = [each.silent_ns for each in sources] or [0]
        self.forget()

    def forget(self) -> None:
        """Forget all commands."""
        self._heard = [-NEVER] * len(self._times)
        self._commands: list[Command | None] = [None] * len(self._times)
        self._speaking: int | None = None
        self._arrived: int | None = None
        self.chosen: int | None = None
        self.has_changed = False

    def take(self, t: int, source: int, command: Command | None) -> None:
        """Take a command; None: a refused one."""
        self._heard[source], self._commands[source] = t, command
        self._arrived = source

    def choose(self, t: int) -> Command | None:
        """Choose; return the command that is to be executed from now on, if there is a new one."""
        before, arrived = self.chosen, self._arrived
        speaking = (n for n, ns in enumerate(self._times) if not ns or t < self._heard[n] + ns)
        self._speaking, self._arrived = next(speaking, None), None
        command = None if self._speaking is None else self._commands[self._speaking]
        self.chosen = None if command is None else self._speaking
        self.has_changed = self.chosen != before
        return command if self.has_changed or arrived == self.chosen else None

    @property
    def lost_from(self) -> int:
        """Return when the input is lost without another command, but for the time of a line."""
        return (
            -NEVER if self.chosen is None else self._heard[self.chosen] + self._times[self.chosen]
        )

    @property
    def due(self) -> int:
        """Return when to choose again at the latest."""
        number = self._speaking
        if number is None or not self._times[number]:
            return NEVER
        return self._heard[number] + self._times[number]
