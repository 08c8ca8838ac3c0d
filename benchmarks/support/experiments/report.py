"""The results of the experiments as text, as a page, and as Parquet."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..bars import show_bars
from .analysis import Analysis
from .results import Results, Row
from .robots import Times

SOURCE = (
    "Adam, Larsen, Jensen, Schultz: Rule-based dynamic safety monitoring for mobile robots, Table 1"
)
"""Where the paper's figures come from."""

EARLIER = (
    "Of the Frobit and the Kobuki the paper has the range of an earlier version's averages, which "
    "polled: delays of 7 to 700 ms, most beyond 20 ms, standard deviations of 0.02 to 0.40 s"
)
"""What the paper says in its sections 7.2.3 and 7.4."""

HEADS = (
    *("n", "Ideal", "Avg", "SD", "Min", "Max"),
    *("paper: Avg", "SD", "Min", "Max"),
    *("beyond, ms: avg", "max", "%: avg", "paper: ms", "%"),
)
"""The heads of the table of delays, but for the first."""

OF_PAPER = (6, 7, 8, 9, 13, 14)
"""Which of them are the paper's."""


def show(results: Results, console: Console) -> None:
    """Print the tables, with a verdict per bar below them."""
    console.print(_delays(results))
    console.print(f"{EARLIER}.", soft_wrap=True)
    console.print(_machine(results))
    for each in results.left_out:
        console.print(f"Not played: {each}", soft_wrap=True)
    for run in results.runs:
        for difference in run.analysis.differences:
            console.print(Text(f"{run.title}: {difference}", style="bold red"), soft_wrap=True)
    show_bars(results.bars(), console)


def _delays(results: Results) -> Table:
    table = Table(title="From the fulfilled condition to the action, in s", title_justify="left")
    table.add_column("")
    for head in HEADS:
        table.add_column(head, justify="right")
    title = ""
    for row in results.rows:
        if row.run.robot.title != title:
            title = row.run.robot.title
            table.add_section()
            table.add_row(Text(title, style="bold"))
        table.add_row(_name(row), *_row_cells(row))
    table.caption = f"R: by the machine's clock; S: by a simulator's. Paper: {SOURCE}."
    return table


def _name(row: Row) -> str:
    return f"{row.label} {row.run.target}: {row.series.experiment.name}"


def _row_cells(row: Row) -> list[str]:
    """Return the cells below :data:`HEADS`."""
    beyond = row.beyond_ms
    own = [f"{sum(beyond) / len(beyond):.2f}", f"{max(beyond):.2f}"] if beyond else ["", ""]
    percent = _percent(sum(beyond) / len(beyond), row.ideal) if beyond else ""
    paper = ["", row.run.robot.earlier]
    if row.paper is not None:
        late = 1e3 * (row.paper.average - row.ideal)
        paper = [f"{late:.2f}", _percent(late, row.ideal)]
    count, ideal = str(len(row.series.times)), f"{row.ideal:.1f}"
    return [count, ideal, *_cells(row.times), *_cells(row.paper), *own, percent, *paper]


def _percent(beyond_ms: float, ideal: float) -> str:
    return f"{beyond_ms / 10 / ideal:.2f}" if ideal else ""


def _cells(times: Times | None) -> list[str]:
    if times is None:
        return [""] * 4
    values = (times.average, times.deviation, times.least, times.greatest)
    return [f"{each:.5f}" for each in values]


MACHINE_HEADS = (
    "run",
    "a plain sleep is late, ms: median",
    "max",
    "% of a core, by the second: mean",
    "max",
    "a node that only receives",
    "memory in MiB",
    "in %",
    "events as played",
)


def _machine(results: Results) -> Table:
    table = Table(title="The machine and the safety node", title_justify="left")
    for number, head in enumerate(MACHINE_HEADS):
        table.add_column(head, justify="right" if number else "left")
    for cells in machine_cells(results):
        table.add_row(*cells)
    return table


def machine_cells(results: Results) -> Iterator[list[str]]:
    """Yield a row for each run: lateness of a sleep, processor, memory, events."""
    for run in results.runs:
        median, most = run.lateness_ms
        mean, greatest = run.processor
        differences = len(run.analysis.differences)
        yield [
            run.title,
            f"{median:.3f}",
            f"{most:.3f}",
            f"{mean:.2f}",
            f"{greatest:.2f}",
            f"{run.measured.receiver:.2f}",
            f"{run.measured.memory:.1f}",
            f"{run.measured.memory_share:.2f}",
            _explained(run.analysis, differences),
        ]


def _explained(analysis: Analysis, differences: int) -> str:
    """Return how many events are those of the player, and how near."""
    text = f"{analysis.events}" + (f", but {differences} not" if differences else ", all")
    if analysis.apart is None:
        return f"{text}, to the ns"
    return f"{text}, within {analysis.apart / 1e6:.3f} ms"


# The page ----------------------------------------------------------------------------------------

_LEFT, _WIDTH, _STEP = 330.0, 620.0, 24.0


def page(results: Results) -> str:
    """Return one page of HTML, which needs nothing else: tables, and a picture of every delay."""
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    rows = results.rows
    return environment.get_template("page.html").render(
        rows=[
            {
                "name": _name(row),
                "robot": row.run.robot.title,
                "cells": _row_cells(row),
            }
            for row in rows
        ],
        heads=HEADS,
        of_paper=OF_PAPER,
        picture=_picture(rows),
        machine_heads=MACHINE_HEADS,
        machine=list(machine_cells(results)),
        bars=list(results.bars()),
        left_out=results.left_out,
        source=SOURCE,
        earlier=EARLIER,
    )


def _picture(rows: Sequence[Row]) -> dict[str, Any]:
    """Return the places of a picture: a line for each row, a dot for each time, in ms."""
    papers = [1e3 * (row.paper.greatest - row.ideal) for row in rows if row.paper is not None]
    every = [beyond for row in rows for beyond in row.beyond_ms]
    least, most = min([0.0, *every]), max([1.0, *every, *papers])
    step = next(
        (each for each in (1, 2, 5, 10, 20, 50, 100, 200, 500) if (most - least) / each <= 8), 1000
    )

    def across(beyond: float) -> float:
        return round(_LEFT + _WIDTH * (beyond - least) / (most - least), 1)

    lines = []
    for number, row in enumerate(rows):
        paper = None
        if row.paper is not None:
            values = (row.paper.least, row.paper.average, row.paper.greatest)
            paper = [across(1e3 * (each - row.ideal)) for each in values]
        lines.append(
            {
                "y": (number + 1) * _STEP,
                "name": f"{row.run.robot.title} {row.label} {row.run.target}",
                "dots": [across(each) for each in row.beyond_ms],
                "paper": paper,
            }
        )
    ticks = range(step * int(least // step + (least % step > 0)), int(most) + 1, step)
    return {
        "lines": lines,
        "ticks": [(across(each), each) for each in ticks],
        "zero": across(0.0),
        "bottom": (len(rows) + 1) * _STEP,
        "height": (len(rows) + 3) * _STEP,
        "width": _LEFT + _WIDTH + 30.0,
        "left": _LEFT - 12.0,
    }


# Parquet -----------------------------------------------------------------------------------------


def write_parquet(results: Results, path: Path) -> bool:
    """Write a row for each repetition, if there is a library for that; return whether."""
    with contextlib.suppress(ImportError):
        connection = import_module("duckdb").connect()
        connection.execute(
            "CREATE TABLE times (robot TEXT, experiment TEXT, name TEXT, target TEXT,"
            " ideal_s DOUBLE, repetition INTEGER, time_s DOUBLE, beyond_ms DOUBLE)"
        )
        for row in results.rows:
            for number, (time, beyond) in enumerate(
                zip(row.series.times, row.beyond_ms, strict=True), start=1
            ):
                experiment = row.series.experiment
                values = [row.run.robot.title, row.label, experiment.name, row.run.target]
                connection.execute(
                    "INSERT INTO times VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
                    [*values, row.ideal, number, time, beyond],
                )
        connection.table("times").write_parquet(str(path))
        connection.close()
        return True
    return False
