"""How many messages a second the generated monitor takes, and how long each keeps it busy.

The same drive goes through the generated monitor, a monitor written by hand and, if they are
installed (``pip install deros[bench]``), those of reelay and rtamt: in turns, the median of many
counts, in processor time. Ratios are of what a message costs above the call of a function that does
nothing. What is to hold at the fourteen rules of the paper's robot: 1.05 times the speed of
the monitor written by hand, and 15 times that of reelay, each of whose rules sees each message. If
there is a C compiler, the generated C monitor stands beside one written by hand in C, in a program
of their own; it may take 1.25 times as long.
"""

from __future__ import annotations

import argparse
import functools
import json
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from support.compiling import c_compiler
from support.progress import Line
from support.throughput_by_hand import Event
from support.throughput_c import Bench, missing_rows
from support.throughput_report import as_json, bars, show
from support.throughput_rivals import (
    Contender,
    by_hand,
    generated,
    is_installed,
    nothing,
    reelay,
    rtamt,
)
from support.throughput_rules import RULES_OF_A_ROBOT, Message, disturbed, messages, program
from support.throughput_timing import Row, measure

RIVALS: dict[str, tuple[str, Callable[[int], Contender]]] = {
    "reelay": ("reelay", reelay),
    "reelay, own topics": ("reelay", functools.partial(reelay, own_topics=True)),
    "rtamt, own topics": ("rtamt", rtamt),
}
"""By the name of the row: the package, and what makes the monitors for a number of rules."""

MOST_RULES = {"rtamt, own topics": 100}
"""How many rules a rival is asked to read: it takes tens of milliseconds for each."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; return 1 if a bar has to hold and does not, 2 if two monitors differ."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rules", type=int, nargs="+", default=[1, RULES_OF_A_ROBOT, 100, 1000])
    parser.add_argument("--repeat", type=int, default=15, help="the median of so many runs counts")
    parser.add_argument("--seconds", type=float, default=60.0, help="how long the drive is")
    parser.add_argument("--json", type=Path, help="write the results to this file too")
    parser.add_argument(
        "--assert", action="store_true", dest="strict", help="exit with 1 if a bar does not hold"
    )
    options = parser.parse_args(arguments)

    drive = messages(options.seconds)
    rows: list[Row] = []
    with tempfile.TemporaryDirectory(prefix="deros-benchmark-") as folder:
        difference = _difference(drive, Path(folder))
        if difference:
            print(difference, file=sys.stderr)
            return 2
        with Line(sys.stderr) as line:
            for rules in options.rules:
                line.show(f"{rules} rules")
                watched = program(rules, Path(folder)).topics
                watching = [message for message in drive if message[1] in watched]
                found = measure(_contenders(rules, Path(folder)), watching, options.repeat)
                rows += [Row(rules, name, found.get(name)) for name in ("nothing", *_names())]
                if c_compiler() is None:
                    rows += missing_rows(rules)
                else:
                    rows += _bench(rules, Path(folder)).measure(watching, options.repeat)
    console = Console(width=None if sys.stdout.isatty() else 120)
    show(rows, console)
    if options.json is not None:
        text = json.dumps(as_json(rows), indent=1) + "\n"
        options.json.write_text(text, encoding="utf-8")
    return 1 if options.strict and not all(bar.held for bar in bars(rows)) else 0


def _names() -> tuple[str, ...]:
    return ("generated", "by hand", *RIVALS)


def _contenders(rules: int, folder: Path) -> dict[str, Contender]:
    found = {"nothing": nothing, "generated": generated(program(rules, folder))}
    hand = by_hand(rules)
    if hand is not None:
        found["by hand"] = hand
    for name, (package, make) in RIVALS.items():
        if is_installed(package) and rules <= MOST_RULES.get(name, rules):
            found[name] = make(rules)
    return found


def _bench(rules: int, folder: Path) -> Bench:
    return Bench(rules, program(rules, folder), Path(tempfile.mkdtemp(dir=folder)))


def _difference(drive: Sequence[Message], folder: Path) -> str:
    """Return in which event two monitors differ, if in any: on the drive, and on a rough one."""
    for rules in (1, RULES_OF_A_ROBOT):
        bench = None if c_compiler() is None else _bench(rules, folder)
        for each in (drive, disturbed(drive)):
            said = _said(rules, each, folder) | ({} if bench is None else bench.events(each))
            ours = said["generated"]
            for name, theirs in said.items():
                for mine, other in zip(ours, theirs, strict=False):
                    if mine != other:
                        return f"{rules} rules: generated {mine}, {name} {other}"
                if len(ours) != len(theirs) or not ours:
                    return f"{rules} rules: {len(ours)} events generated, {len(theirs)} {name}"
    return ""


def _said(rules: int, drive: Sequence[Message], folder: Path) -> dict[str, list[Event]]:
    """Return what the monitors in Python say about a drive."""
    ours: list[tuple[Any, ...]] = []
    theirs: list[Event] = []
    hand = by_hand(rules, theirs)
    assert hand is not None
    for contender in (generated(program(rules, folder), ours), hand):
        for function, values in contender(drive):
            function(*values)
    return {"generated": [event[:4] for event in ours], "by hand": theirs}


if __name__ == "__main__":
    sys.exit(main())
