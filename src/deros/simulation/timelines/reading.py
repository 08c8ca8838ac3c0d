"""Reads the table of a timeline for the program that its rules make."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from decimal import Decimal

from deros.diagnostics import Diagnostic, SourceFile, Span
from deros.interfaces.store import InterfaceStore
from deros.rules.program.ir import Program
from deros.simulation.timelines.cells import (
    BACK,
    MOST,
    Messages,
    commands_of,
    effects_of,
    is_range,
    last_of,
    time_of,
    times_of,
)
from deros.simulation.timelines.document import Case
from deros.simulation.timelines.lines import Cell, Line, lines_of
from deros.simulation.timelines.timeline import Command, Effect, Entry, Moment, Timeline
from deros.simulation.trace import TraceLine, nanoseconds, read_trace


def read_timeline(case: Case, program: Program, recorded: SourceFile | None = None) -> Timeline:
    """Return the timeline of a table.

    Args:
        case: as it is written.
        program: the rules.
        recorded: the trace that it names.

    Raises:
        Fault: a cell cannot be interpreted.
    """
    return _Reader(case, program, recorded).timeline()


def read_entries(
    timeline: Timeline, program: Program, store: InterfaceStore
) -> tuple[tuple[TraceLine, ...], list[Diagnostic]]:
    """Return the lines of a timeline's trace, and what is wrong with them, each fault once.

    A finding is at the cell that the line was made of.
    """
    trace = read_trace(SourceFile("trace", "\n".join(timeline.trace)), program, store)
    found: dict[tuple[str, Span], Diagnostic] = {}
    for each in trace.diagnostics:
        entry = timeline.entries[each.span.line - 1]
        found.setdefault((each.message, entry.span), replace(each, span=entry.span))
    return trace.lines, list(found.values())


class _Reader:
    def __init__(self, case: Case, program: Program, recorded: SourceFile | None) -> None:
        self._case = case
        self._program = program
        self._messages = Messages(program, case.fields)
        self._effects: list[Effect] = []
        self._commands: list[Command] = []
        self._now = self._last = Moment(0, 0)
        head = case.head.cells[0]
        written = head.text.partition(" until ")[2]
        self._until_ns = time_of(written, head) if written else None
        self._recorded = [] if recorded is None else [*_recorded(recorded, self._until_ns)]
        self._entries = [*self._recorded]

    def timeline(self) -> Timeline:
        for row in self._case.rows:
            self._row(row)
        if self._until_ns is None and not self._case.rows and not self._entries:
            hint = "write what comes, or 'time until 3 s' where nothing does"
            raise self._case.head.fault("a table without rows plays nothing", hint)
        last = max([self._last, *(each.moment for each in self._entries)])
        until = last if self._until_ns is None else Moment(last.steps, self._until_ns)
        every: list[Effect | Command] = [*self._effects, *self._commands]
        for expected in every:
            if expected.moment > until:
                hint = "what comes later than the end is not played: write 'time until …' for more"
                raise Cell("", expected.span).fault("an effect after the end", hint)
        return Timeline(
            self._case.name,
            self._case.why,
            self._case.place.span,
            tuple(sorted(self._entries, key=lambda each: each.moment)),
            tuple(self._effects),
            tuple(self._commands),
            until,
        )

    def _end(self) -> int | None:
        """Return where messages end that go on to the end of the table, if it has one."""
        if self._until_ns is not None:
            return self._until_ns
        ends = [max(each.moment for each in self._recorded).t_ns] if self._recorded else []
        for row in self._case.rows:
            times = row.cells[0]
            for text in times.text.split(", "):
                last = last_of(text.removeprefix(BACK), times)
                if text.startswith(BACK):
                    ends.clear()
                if last is not None:
                    ends.append(last)
        return max(ends, default=None)

    def _row(self, row: Line) -> None:
        times, message, effects, *commands = row.cells
        if is_range(times.text) and (effects.text or any(each.text for each in commands)):
            hint = "give it a row of its own, with its time"
            raise row.fault("an effect of several times", hint)
        if not message.text and "every " in times.text:
            raise row.fault("no message", "say which message comes every time")
        for text in times.text.split(", "):
            every = times_of(text.removeprefix(BACK), times, self._end)
            self._advance(every, text.startswith(BACK), bool(message.text), row)
            if message.text:
                for t_ns in every:
                    moment = Moment(self._now.steps, t_ns)
                    line = self._messages.line(t_ns, message)
                    self._entries.append(Entry(moment, line, message.span))
            if len(self._entries) > MOST:
                raise row.fault(f"more than {MOST:,} messages", "shorten the timeline")
        for action, kind in effects_of(effects, self._program):
            self._effects.append(Effect(self._now, action, kind, effects.span))
        for cell in commands:
            for each in commands_of(cell, self._program):
                self._commands.append(Command(self._now, *each, cell.span))

    def _advance(self, every: list[int], is_back: bool, has_message: bool, row: Line) -> None:
        """Go on to the first of the times of a row."""
        is_earlier = every[0] < self._now.t_ns
        is_back = is_back and (has_message or self._case.trace is not None)
        # Where a trace is played, too, its messages show the step, and the rows before may be none.
        if is_earlier != is_back and not (is_back and self._case.trace is not None):
            hint = "rows are in order; a message at which the clock steps back says 'back to 1 s'"
            raise row.fault("not in order of time", hint)
        self._now = Moment(self._now.steps + is_back, every[0])
        self._last = max(self._last, Moment(self._now.steps, every[-1]))


def _recorded(source: SourceFile, until_ns: int | None) -> Iterator[Entry]:
    """Yield the lines of a trace before the first that is later than the end, as a simulation does.

    What is wrong with one is reported where it is played.
    """
    now = Moment(0, 0)
    for line in lines_of(source):
        if not line.text.strip():
            continue
        t_ns = _time(line)
        if t_ns is not None:
            now = Moment(now.steps + (t_ns < now.t_ns), t_ns)
        if until_ns is not None and now.t_ns > until_ns:
            return
        yield Entry(now, line.text, line.span)


def _time(line: Line) -> int | None:
    try:
        record = json.loads(line.text, parse_float=Decimal)
    except (ValueError, RecursionError, ArithmeticError):
        return None
    given = record.get("t") if isinstance(record, dict) else None
    return nanoseconds(given if isinstance(given, str) else f"{given}")
