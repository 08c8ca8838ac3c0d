"""The results of the cost benchmark as tables and as JSON."""

from __future__ import annotations

import os
import platform
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from support.cost_results import FASTEST, NODES, SAFETY, USUAL, Results, Verdict


def show(results: Results, verdicts: Sequence[Verdict], console: Console) -> None:
    """Print both tables, with the verdicts below them."""
    console.print(_processor(results))
    console.print(_memory(results))
    for node, share in results.received.items():
        if share < 0.99:
            console.print(f"Only {share:.1%} of the messages have come to the {NODES[node]}.")
    if not results.stopped:
        console.print(Text("The safety node did not stop the robot at the end.", style="bold red"))
    for each in verdicts:
        mark = Text("holds", style="green") if each.held else Text("FAILS", style="bold red")
        limit = f"{each.limit:g} {each.unit}"
        found = f"  {each.what}: {each.found:+.2f} {each.unit} (asked for: less than {limit})"
        console.print(Text.assemble(mark, found), soft_wrap=True)


def _processor(results: Results) -> Table:
    table = Table(
        title=f"Processor time in % of one core, mean ± SD, {results.seconds:g} s each",
        title_justify="left",
        pad_edge=False,
    )
    table.add_column("load")
    for head in ("messages/s", *NODES.values(), "above typed", "above raw", "us/message"):
        table.add_column(head, justify="right")
    for load, rate in results.loads.items():
        uses = [results.use(load, node) for node in NODES]
        table.add_row(
            load,
            f"{rate:g}",
            *(f"{each.mean:.2f} ± {each.deviation:.2f}" for each in uses),
            f"{results.above(load, USUAL):+.2f}",
            f"{results.above(load, FASTEST):+.2f}",
            f"{1e4 * results.use(load, SAFETY).mean / rate:.0f}" if rate else "",
        )
    return table


def _memory(results: Results) -> Table:
    table = Table(title="Resident memory in MiB", title_justify="left", pad_edge=False)
    table.add_column("")
    for head in ("start", "end", "growth"):
        table.add_column(head, justify="right")
    for each in results.memory:
        growth = each.end - each.start
        table.add_row(NODES[each.node], f"{each.start:.1f}", f"{each.end:.1f}", f"{growth:+.2f}")
    return table


def as_json(results: Results, verdicts: Sequence[Verdict]) -> dict[str, Any]:
    """Return everything that was found."""
    return {
        "benchmark": "cost",
        "machine": {
            "processors": os.cpu_count(),
            "system": platform.platform(),
            "python": platform.python_version(),
        },
        "seconds": results.seconds,
        "loads": [
            {
                "name": load,
                "messages_per_second": rate,
                "percent_of_one_core": {
                    node: {
                        "mean": results.use(load, node).mean,
                        "deviation": results.use(load, node).deviation,
                        "turns": results.use(load, node).percents,
                    }
                    for node in NODES
                },
            }
            for load, rate in results.loads.items()
        ],
        "memory_mib": [asdict(each) for each in results.memory],
        "received": results.received,
        "stopped": results.stopped,
        "verdicts": [{**asdict(each), "held": each.held} for each in verdicts],
    }
