"""A table of the programs in place of their output: state, process, load, memory, restarts."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
import contextlib
import os
from pathlib import Path
import re
import shutil
import time

from ..output import Output
from ..process import Process, State
from .display import Display
from .logs import Logs

PERIOD = 1.0  # seconds from one drawing to the next
LAST_LINES = 8  # of the output, below the table
_CONTROLS = re.compile(rb'\x1b\[[0-9;?]*[ -/]*[@-~]|[\x00-\x1f\x7f]')


class Usage:
    """Processor time and memory of process groups, out of /proc."""

    def __init__(self) -> None:
        """Begin to measure."""
        self._ticks: dict[int, tuple[float, int]] = {}  # when, and used since the start

    def measured(self, groups: Sequence[int], now: float) -> dict[int, tuple[float | None, int]]:
        """
        Return for each group the share of a processor since the last call, and bytes of memory.

        The share is None at the first call for a group; what has ended is left out.
        """
        ticks, pages = _used(frozenset(groups))
        found: dict[int, tuple[float | None, int]] = {}
        for group, used in ticks.items():
            share = None
            if group in self._ticks:
                before, had = self._ticks[group]
                seconds = (used - had) / os.sysconf('SC_CLK_TCK')
                share = max(0.0, seconds / (now - before)) if now > before else None
            found[group] = share, pages[group] * os.sysconf('SC_PAGE_SIZE')
        self._ticks = {group: (now, used) for group, used in ticks.items()}
        return found


def _used(groups: frozenset[int]) -> tuple[dict[int, int], dict[int, int]]:
    """Return the clock ticks and resident pages of process groups, as proc(5) has them."""
    ticks: dict[int, int] = {}
    pages: dict[int, int] = {}
    for entry in Path('/proc').glob('[0-9]*/stat'):
        text = b''
        with contextlib.suppress(OSError):  # it has ended
            text = entry.read_bytes()
        # The name of the program, in parentheses, may have blanks and parentheses in it.
        fields = text.rpartition(b')')[2].split()
        group = int(fields[2]) if fields else 0
        if group in groups:
            ticks[group] = ticks.get(group, 0) + int(fields[11]) + int(fields[12])
            pages[group] = pages.get(group, 0) + int(fields[21])
    return ticks, pages


class Table(Display):
    """A table that is drawn again and again, with the last lines of the output below."""

    def __init__(
        self,
        system: str,
        labels: Sequence[str],
        output: Output,
        in_colour: bool = False,
        logs: Logs | None = None,
    ) -> None:
        """Show the programs of these labels."""
        super().__init__(system, labels, output, in_colour, logs)
        self.due = 0.0
        self._last: deque[bytes] = deque(maxlen=LAST_LINES)
        self._usage = Usage()
        self._in_colour = in_colour

    def draw(self, processes: Sequence[Process]) -> None:
        """Draw the table, if it is time, in place of the last one."""
        now = time.monotonic()
        if now < (self.due or 0.0):
            return
        self._draw(processes, now)

    def _draw(self, processes: Sequence[Process], now: float) -> None:
        self.due = now + PERIOD
        if self.output.is_empty:  # else nobody looks at the last one yet
            usage = self._usage.measured([each.group for each in processes if each.group], now)
            size = shutil.get_terminal_size()
            lines = self._lines(processes, usage, now, size.lines - LAST_LINES - 2)
            text = [line.encode() for line in lines] + [b'', *self._last]
            shown = b''.join(b'%s\033[K\n' % _cut(line, size.columns) for line in text)
            self.output.write(b'\033[H' + shown + b'\033[J')

    def close(self, processes: Sequence[Process]) -> None:
        """Leave the last state on the screen."""
        self._draw(processes, time.monotonic())
        super().close(processes)

    def _lines(
        self,
        processes: Sequence[Process],
        usage: Mapping[int, tuple[float | None, int]],
        now: float,
        most: int,
    ) -> list[str]:
        width = max([len(self._system), *(len(each.label) for each in processes)])
        head = f'{self._system:{width}}  {"pid":>7}  {"cpu":>5}  {"memory":>8}  restarts  state'
        lines = [f'\033[1m{head}\033[0m' if self._in_colour else head]
        for each in processes:
            share, memory = usage.get(each.group, (None, None))
            restarts = '' if each.node.respawn_delay is None else str(each.restarts)
            lines.append(
                f'{each.label:{width}}  {each.group or "":>7}'
                f'  {"" if share is None else f"{100 * share:.0f} %":>5}'
                f'  {"" if memory is None else f"{memory / 1e6:.1f} MB":>8}'
                f'  {restarts:>8}  {_state(each, now)}'
            )
        most = max(2, most)
        if len(lines) > most:
            lines = [*lines[: most - 1], f'and {len(lines) - most + 1} more']
        return lines

    def _show(self, prefix: bytes, lines: Sequence[bytes]) -> None:
        self._last.extend(prefix + _CONTROLS.sub(b' ', line) for line in lines[-LAST_LINES:])


def _state(process: Process, now: float) -> str:
    if process.state is State.RUNNING:
        return f'running for {now - process.since:.0f} s'
    if process.state is State.WAITING and process.awaited is not None and process.due is None:
        return f'waits for the exit of {process.awaited.label}'
    ready = process.node.ready
    if process.state is State.WAITING and ready is not None and process.due is None:
        return f'waits for {ready}'
    if process.state is State.ENDED:
        return process.end
    return str(process.state.value)


def _cut(line: bytes, width: int) -> bytes:
    """Return a line without what is right of the screen; colours take no room."""
    room, found = width, b''
    for piece in re.split(rb'(\x1b\[[0-9;]*m)', line):
        if piece.startswith(b'\x1b'):
            found += piece
            continue
        text = piece.decode(errors='replace')[:room]
        found, room = found + text.encode(), room - len(text)
    return found
