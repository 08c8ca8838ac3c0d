"""The results of the reaction benchmark as a table and as JSON."""

from __future__ import annotations

import os
import platform
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from support.bars import show_bars
from support.rclcpp_programs import rclcpp_environment
from support.reaction_results import RCLCPP, RCLPY, Results, Row
from support.summary import Summary

NO_RCLCPP = "no rclcpp in AMENT_PREFIX_PATH"
"""Why there may be no rows of rclcpp."""

SOURCE = (
    "Adam, Larsen, Jensen, Schultz: Rule-based dynamic safety monitoring for mobile robots, Table 1"
)
"""Where the rows of the paper come from."""

_PAPER = (
    ("R_S: Intelligent One, robot, speed", 2.0, 2.00271, 0.00461, 2.00006, 2.01374),
    ("S_S: Intelligent One, simulated, speed", 2.0, 2.01150, 0.00741, 2.00200, 2.02500),
    ("R_T: Intelligent One, robot, tilt", 0.4, 0.40635, 0.00916, 0.40002, 0.42600),
    ("S_T: Intelligent One, simulated, tilt", 0.4, 0.40825, 0.00526, 0.40000, 0.42300),
    ("R_S: FIX-Robo, robot, speed", 4.0, 4.00509, 0.00400, 4.00127, 4.01705),
    ("S_S: FIX-Robo, simulated, speed", 4.0, 4.00462, 0.00747, 4.00000, 4.02000),
)
"""Name, ideal, average, standard deviation, least and greatest, in seconds."""


def paper_rows() -> list[tuple[str, float, Summary]]:
    """Return name, ideal in seconds, and lateness of each experiment of the paper."""
    return [
        (
            name,
            ideal,
            Summary(
                None,
                1e3 * (mean - ideal),
                1e3 * deviation,
                1e3 * (least - ideal),
                None,
                None,
                1e3 * (greatest - ideal),
            ),
        )
        for name, ideal, mean, deviation, least, greatest in _PAPER
    ]


def show(results: Sequence[Results], console: Console) -> None:
    """Print the table, with a verdict per bar below it."""
    machine = "under load" if any(each.run.loaded for each in results) else "idle machine"
    for each in results:
        if each.run.priority:
            client = each.run.client.section.rstrip(", ")
            machine += f"; {client}'s deadlines at real-time priority {each.run.priority}"
    table = Table(title=f"Reaction in ms, {machine}", title_justify="left", pad_edge=False)
    table.add_column("")
    for head in ("n", "avg", "SD", "min", "median", "99 %", "max", "/ floor: median", "99 %"):
        table.add_column(head, justify="right")
    section = ""
    for row in (row for each in results for row in each.rows):
        if row.section != section:
            section = row.section
            table.add_section()
            table.add_row(Text(_head(section), style="bold"))
        table.add_row(row.name, *_cells(row.summary), *_ratios(row))
    for client in _missing(results):
        table.add_section()
        table.add_row(Text(client, style="bold"))
        table.add_row(Text(_why(client), style="dim"))
    table.add_section()
    table.add_row(Text("the paper, measured - ideal", style="bold"))
    for name, ideal, summary in paper_rows():
        table.add_row(f"{name}, {ideal:g} s", *_cells(summary))
    table.caption = f"{SOURCE}."
    console.print(table)
    for each in results:
        _show_verdicts(each, console)


def _show_verdicts(results: Results, console: Console) -> None:
    if results.run.loaded:
        console.print(f"The load's own messages that arrived: {results.run.traffic:.0f} per second")
    if results.run.stolen:
        console.print(
            f"Of the processors' time the machine's host gave {results.run.stolen:.2f} % to others"
        )
    show_bars(results.bars(), console)


def _why(client: str) -> str:
    """Return why a client library was not measured."""
    absent = client == RCLCPP.name and rclcpp_environment() is None
    return NO_RCLCPP if absent else "not asked for"


def _missing(results: Sequence[Results]) -> list[str]:
    measured = {each.run.client for each in results}
    return [each.name for each in (RCLPY, RCLCPP) if each not in measured]


def _head(section: str) -> str:
    if section.endswith("immediate rule"):
        return f"{section}, tilt published -> state received"
    if section.endswith("all of them"):
        return f"{section.replace('all of them', 'all rules with a for')}, lateness"
    return f"{section.replace('for ', 'rule for ')}, lateness"


def _cells(summary: Summary) -> list[str]:
    times = (
        summary.mean,
        summary.deviation,
        summary.least,
        summary.median,
        summary.percent_99,
        summary.greatest,
    )
    count = "" if summary.count is None else str(summary.count)
    return [count, *("" if time is None else f"{time:.3f}" for time in times)]


def _ratios(row: Row) -> list[str]:
    return [f"{ratio:.2f}" for ratio in row.ratios or ()]


def as_json(results: Sequence[Results]) -> dict[str, Any]:
    """Return everything that was found, every single time included."""
    return {
        "benchmark": "reaction",
        "loaded": any(each.run.loaded for each in results),
        "priority": max((each.run.priority for each in results), default=0),
        "machine": {
            "processors": os.cpu_count(),
            "system": platform.platform(),
            "python": platform.python_version(),
        },
        "series": [_series(row, each) for each in results for row in each.rows],
        "not_measured": {client: _why(client) for client in _missing(results)},
        "paper": {
            "source": SOURCE,
            "rows": [
                {"name": name, "ideal_s": ideal, "ms": asdict(summary)}
                for name, ideal, summary in paper_rows()
            ],
        },
        "load_messages_per_second": {each.run.client.name: each.run.traffic for each in results},
        "stolen_percent": {each.run.client.name: each.run.stolen for each in results},
        "bars": [asdict(bar) for each in results for bar in each.bars()],
    }


def _series(row: Row, results: Results) -> dict[str, Any]:
    return {
        "client": results.run.client.name,
        "section": row.section.removeprefix(results.run.client.section),
        "name": row.name.strip(),
        "ms": asdict(row.summary),
        "ratios_to_floor": dict(zip(("median", "percent_99"), row.ratios or (), strict=False)),
        "times_ns": row.times,
    }
