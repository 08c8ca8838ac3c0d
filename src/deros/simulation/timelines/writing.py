"""Writes what a simulation shows as a timeline, which passes until the rules do something else."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from deros.simulation.gate_simulation import GateAnswer
from deros.simulation.simulate import Explained
from deros.simulation.timelines.cells import BACK
from deros.simulation.timelines.outcomes import EFFECTS, EVENTS, OCCASIONS
from deros.simulation.timelines.sections import COLUMNS, COMMAND
from deros.simulation.timelines.timeline import decimal


@dataclass
class _Row:
    """What happens at one instant."""

    t_ns: int
    is_back: bool = False
    effects: list[str] = field(default_factory=list)
    commands: dict[str, str] = field(default_factory=dict)  # the last one of each gate
    events: list[str] = field(default_factory=list)

    def cells(self) -> list[str]:
        """Return its cells."""
        time = f"{BACK if self.is_back else ''}{decimal(self.t_ns)} s"
        commands = ", ".join([*self.events, *self.commands.values()])
        return [time, "", ", ".join(self.effects), commands]


def timeline_text(
    rules: str,
    trace: str,
    happenings: Iterable[Explained | GateAnswer],
    until_ns: int | None,
    *,
    has_commands: bool,
) -> str:
    """Return the file of a timeline of what happens when a trace is played.

    Args:
        rules: the path of the rules.
        trace: the path of the trace.
        happenings: what happens.
        until_ns: the time up to which the clock runs on; ``None``: the last line.
        has_commands: whether gates take part.
    """
    until = "" if until_ns is None else f" until {decimal(until_ns)} s"
    head = [f"{COLUMNS[0]}{until}", *COLUMNS[1:], COMMAND]
    rows = [head, *(each.cells() for each in _rows(happenings))]
    if not has_commands:
        rows = [each[:-1] for each in rows]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    ruler = "|".join("-" * (width + 2) for width in widths)
    lines = [_line(each, widths) for each in rows]
    links = f"Rules: [{rules}]({rules})\n\n## {trace}\n\nTrace: [{trace}]({trace})\n"
    return "\n".join([f"# {rules}\n", links, lines[0], f"|{ruler}|", *lines[1:], ""])


def _line(cells: list[str], widths: list[int]) -> str:
    padded = (each.ljust(width) for each, width in zip(cells, widths, strict=True))
    return f"| {' | '.join(padded)} |"


def _rows(happenings: Iterable[Explained | GateAnswer]) -> Iterator[_Row]:
    """Yield a row for each instant at which something happens."""
    row: _Row | None = None
    for each in happenings:
        t_ns = each.t_ns if isinstance(each, GateAnswer) else each.event.t_ns
        is_step = isinstance(each, Explained) and each.event.kind == "clock_step"
        if row is None or row.t_ns != t_ns or is_step:
            if row is not None:
                yield row
            row = _Row(t_ns, is_step)
        if isinstance(each, GateAnswer):
            text = f"{each.gate} {EVENTS[each.event]}"
            if each.event not in OCCASIONS:
                row.commands[each.gate] = text
            elif text not in row.events:
                row.events.append(text)
        elif not is_step:
            row.effects.append(f"{each.event.action}{EFFECTS[each.event.kind]}")
    if row is not None:
        yield row
