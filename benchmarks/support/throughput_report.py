"""The results of the throughput benchmark as a table and as JSON."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from support.throughput_rules import RULES_OF_A_ROBOT
from support.throughput_timing import Row

LIMITS = {"by hand": 0.8, "reelay": 15.0}
"""How many times as fast as another monitor the generated one is to be, at fourteen rules."""


@dataclass(frozen=True, slots=True)
class Bar:
    """What is to hold: how many times as fast as ``other``, found and asked for."""

    other: str
    found: float
    limit: float

    @property
    def held(self) -> bool:
        """Whether it holds."""
        return self.found >= self.limit


def bars(rows: Sequence[Row]) -> list[Bar]:
    """Return the bars that can be judged."""
    at = [row for row in rows if row.rules == RULES_OF_A_ROBOT]
    speeds = {row.name: speed_of_generated(row, rows) for row in at}
    return [
        Bar(name, speed, LIMITS[name])
        for name, speed in speeds.items()
        if name in LIMITS and speed is not None
    ]


def speed_of_generated(row: Row, rows: Sequence[Row]) -> float | None:
    """Return how many times as fast as a row's the generated monitor is, above mere calling."""
    costs = {
        each.name: each.timing.cost for each in rows if each.rules == row.rules and each.timing
    }
    if row.timing is None or row.name == "nothing":
        return None
    return (row.timing.cost - costs["nothing"]) / (costs["generated"] - costs["nothing"])


def show(rows: Sequence[Row], console: Console) -> None:
    """Print the table, with a verdict per bar below it."""
    table = Table(title="Throughput", title_justify="left", pad_edge=False)
    table.add_column("rules", justify="right")
    table.add_column("monitor")
    for head in ("messages/s", "ns each", "median ns", "99 % ns", "generated is faster"):
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
    console.print(table)
    for bar in bars(rows):
        mark = Text("holds", style="green") if bar.held else Text("FAILS", style="bold red")
        asked = f"at {RULES_OF_A_ROBOT} rules {bar.found:.2f} x {bar.other} (asked for: "
        console.print(Text.assemble(mark, f"  {asked}{bar.limit:g})"), soft_wrap=True)


def _cells(row: Row, rows: Sequence[Row]) -> list[str | Text]:
    timing = row.timing
    if timing is None:
        return [Text("not measured", style="dim"), "", "", "", ""]
    speed = speed_of_generated(row, rows)
    return [
        f"{1e9 / timing.cost:,.0f}",
        f"{timing.cost:,.0f}",
        f"{timing.median:,.0f}",
        f"{timing.percent_99:,.0f}",
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
                "timing_ns": None if row.timing is None else asdict(row.timing),
                "generated_is_faster": speed_of_generated(row, rows),
            }
            for row in rows
        ],
        "bars": [asdict(bar) | {"held": bar.held} for bar in bars(rows)],
    }
