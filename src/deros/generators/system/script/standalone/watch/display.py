"""What a script shows of its programs: their output, each line with its program."""

from __future__ import annotations

from collections.abc import Sequence
import itertools

from ..output import Output
from ..process import Process
from .logs import Logs

COLOURS = (36, 33, 32, 35, 34, 96, 93, 92, 95, 94)  # of ANSI terminals, for the nodes in turn
BOLD = 1


class Display:
    """Passes the lines of the programs on, in the order in which they come."""

    due: float | None = None  # monotonic time at which it wants to be drawn again

    def __init__(
        self,
        system: str,
        labels: Sequence[str],
        output: Output,
        in_colour: bool = False,
        logs: Logs | None = None,
    ) -> None:
        """Show what the programs of these labels say, and what is said of them."""
        self.output = output
        self.logs = logs
        self._system = system
        self._prefix = _prefix(system, BOLD if in_colour else None)
        self._prefixes = {
            label: _prefix(label, colour if in_colour else None)
            for label, colour in zip(labels, itertools.cycle(COLOURS), strict=False)
        }

    def pass_on(self, label: str, lines: Sequence[bytes], dropped: bool = False) -> None:
        """Show lines of a program; those that are dropped are in its log file alone."""
        if not lines:
            return
        faults = [] if self.logs is None else self.logs.write(label, lines)
        if not dropped:
            self._show(self._prefixes[label], lines)
        for fault in faults:
            self.say(fault)

    def say(self, text: str) -> None:
        """Show a line of the script itself."""
        line = text.encode(errors='surrogateescape')
        self._show(self._prefix, [line])
        if self.logs is not None:
            for fault in self.logs.write(self._system, [line], program=False):
                self._show(self._prefix, [fault.encode(errors='surrogateescape')])

    def draw(self, processes: Sequence[Process]) -> None:
        """Draw what is not a line, if there is such and it is due."""

    def close(self, processes: Sequence[Process]) -> None:  # noqa: ARG002
        """Show the end."""
        if self.logs is not None:
            self.logs.close()

    def _show(self, prefix: bytes, lines: Sequence[bytes]) -> None:
        self.output.write(b''.join(b'%s%s\n' % (prefix, line) for line in lines))


def _prefix(label: str, colour: int | None) -> bytes:
    text = f'[{label}]' if colour is None else f'\033[{colour}m[{label}]\033[0m'
    return f'{text} '.encode()
