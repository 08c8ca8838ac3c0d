"""The results of the throughput benchmark as a table and as JSON."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from support.throughput_c import BY_HAND as C_BY_HAND
from support.throughput_c import GENERATED as C_GENERATED
from support.throughput_c import NOTHING as C_NOTHING
from support.throughput_rules import RULES_OF_A_ROBOT
from support.throughput_timing import Row, Timing

FASTER = {"by hand": 1.05, "reelay": 15.0}
"""How many times as fast as another monitor the generated one is to be, at fourteen rules."""

C_TIME = 1.25
"""How many times as long as the one by hand the generated C monitor may take for a message."""


@dataclass(frozen=True, slots=True)
class Bar:
    """What is to hold at fourteen rules: ``found`` times ``what``.

    Attributes:
        at_most: whether the limit is the most that is allowed, not the least.
    """

    what: str
    found: float
    limit: float
    at_most: bool = False

    @property
    def held(self) -> bool:
        """Whether it holds."""
        return self.found <= self.limit if self.at_most else self.found >= self.limit


def bars(rows: Sequence[Row]) -> list[Bar]:
    """Return the bars that can be judged."""
    at = [row for row in rows if row.rules == RULES_OF_A_ROBOT]
    found = []
    for row in at:
        speed = speed_of_generated(row, rows)
        if row.name in FASTER and speed is not None:
            found.append(Bar(f"as fast as {row.name}", speed, FASTER[row.name]))
        if row.name == C_BY_HAND and speed is not None:
            found.append(Bar(f"the time of {row.name}", 1.0 / speed, C_TIME, at_most=True))
    return found


def above_nothing(row: Row, rows: Sequence[Row]) -> float | None:
    """Return what a message costs above mere calling, in ns."""
    nothing = _timing(_REFERENCES[row.language][0], row, rows)
    if row.timing is None or nothing is None or row.name in _FLOORS:
        return None
    return row.timing.cost - nothing.cost


def speed_of_generated(row: Row, rows: Sequence[Row]) -> float | None:
    """Return how many times as fast as a row's the generated monitor is, above mere calling.

    It is the generated one of the same language.
    """
    own = above_nothing(row, rows)
    generated = _timing(_REFERENCES[row.language][1], row, rows)
    nothing = _timing(_REFERENCES[row.language][0], row, rows)
    if own is None or generated is None or nothing is None:
        return None
    return own / (generated.cost - nothing.cost)


_REFERENCES = {"Python": ("nothing", "generated"), "C": (C_NOTHING, C_GENERATED)}
_FLOORS = ("nothing", C_NOTHING)


def _timing(name: str, beside: Row, rows: Sequence[Row]) -> Timing | None:
    found = (row.timing for row in rows if (row.rules, row.name) == (beside.rules, name))
    return next(found, None)


def show(rows: Sequence[Row], console: Console) -> None:
    """Print the tables, with a verdict per bar below them."""
    console.print(_times(rows))
    if any(row.memory for row in rows):
        console.print(_memory(rows))
    for bar in bars(rows):
        mark = Text("holds", style="green") if bar.held else Text("FAILS", style="bold red")
        asked = f"{bar.limit:g} or {'less' if bar.at_most else 'more'}"
        text = f"  at {RULES_OF_A_ROBOT} rules {bar.found:.2f} x {bar.what} (asked for: {asked})"
        console.print(Text.assemble(mark, text), soft_wrap=True)


def _times(rows: Sequence[Row]) -> Table:
    table = Table(title="Throughput", title_justify="left", pad_edge=False)
    table.add_column("rules", justify="right")
    table.add_column("monitor")
    heads = (
        "messages/s",
        "ns each",
        "above nothing",
        "median ns",
        "99 % ns",
        "generated is faster",
    )
    for head in heads:
        table.add_column(head, justify="right")
    before = 0
    for row in rows:
        if row.rules != before:
            table.add_section()
        table.add_row(f"{row.rules:,}" if row.rules != before else "", row.name, *_cells(row, rows))
        before = row.rules
    table.caption = Text(
        "Not measured: packages that are not installed (pip install deros[bench]), what nobody "
        "writes by hand, and what takes minutes to read its rules."
    )
    return table


def _memory(rows: Sequence[Row]) -> Table:
    title = "Memory of a monitor in C, in bytes"
    table = Table(title=title, title_justify="left", pad_edge=False)
    table.add_column("rules", justify="right")
    table.add_column("monitor")
    sections = ("text", "rodata", "data", "bss")
    for head in ("struct", *(f".{section}" for section in sections)):
        table.add_column(head, justify="right")
    for row in rows:
        if row.memory is not None:
            sizes = row.memory.sections
            cells = ["" if sizes is None else f"{sizes[each]:,}" for each in sections]
            table.add_row(f"{row.rules:,}", row.name, f"{row.memory.state:,}", *cells)
    return table


def _cells(row: Row, rows: Sequence[Row]) -> list[str | Text]:
    timing = row.timing
    if timing is None:
        return [Text(row.why, style="dim"), *[""] * 5]
    digits = 1 if row.language == "C" else 0
    speed = speed_of_generated(row, rows)
    above = above_nothing(row, rows)
    times = (timing.cost, above, timing.median, timing.percent_99)
    return [
        f"{1e9 / timing.cost:,.0f}",
        *("" if time is None else f"{time:,.{digits}f}" for time in times),
        "" if speed is None else f"{speed:.2f} x",
    ]


def as_json(rows: Sequence[Row]) -> dict[str, Any]:
    """Return the results in plain types."""
    return {
        "machine": platform.machine(),
        "python": platform.python_version(),
        "rows": [
            {
                "rules": row.rules,
                "monitor": row.name,
                "language": row.language,
                "timing_ns": None if row.timing is None else asdict(row.timing),
                "why": row.why if row.timing is None else "",
                "above_nothing_ns": above_nothing(row, rows),
                "memory_bytes": None if row.memory is None else asdict(row.memory),
                "generated_is_faster": speed_of_generated(row, rows),
            }
            for row in rows
        ],
        "bars": [asdict(bar) | {"held": bar.held} for bar in bars(rows)],
    }
