"""The tables of examples on the page of the meaning hold, to the nanosecond."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

import pytest

from deros.diagnostics import SourceFile
from deros.generators.monitor.python.run import GeneratedMonitor
from deros.rules.engine.engine import Engine
from deros.simulation.trace import read_trace
from tests.support.rules import embedded_store, program

PAGE = Path(__file__).resolve().parents[3] / "docs" / "meaning.md"
INPUTS = """\
input bumper = topic /flag.data timeout 100 sec
input f = topic /flag.data timeout 100 sec
input v = topic /speed.data timeout 100 sec
"""
OBSERVED = """\
  failsafe may_hold: r;
  failsafe may_fail: not r;
}
action held; action not_held; action failed; action not_failed;
if e.may_hold then { held; };
if not e.may_hold then { not_held; };
if e.may_fail then { failed; };
if not e.may_fail then { not_failed; };
"""
"""A failsafe rule is true where the rule is unknown: two of them tell three values apart."""

TOPICS = {"bumper": "/flag", "f": "/flag", "v": "/speed"}
VALUES = {"true": True, "false": False, "NaN": "NaN"}


class Row(NamedTuple):
    """A line of a table: the time, the value that comes then, if one does, and the verdict."""

    t_ns: int
    value: str
    verdict: str


class Example(NamedTuple):
    """An example: its rule, the input in the head of its table, and the lines."""

    rule: str
    input: str
    rows: list[Row]


def _examples() -> Iterator[Example]:
    text = PAGE.read_text(encoding="utf-8")
    for rule, table in re.findall(r"\*\*Example\.\*\* `r: (.*?)`\n\n((?:\|.*\n)+)", text):
        head, _, *lines = (
            [cell.strip() for cell in line.split("|")[1:-1]] for line in table.splitlines()
        )
        if head[1] not in TOPICS:
            continue  # two inputs: tests/rules/compiler/terms/test_arithmetic.py
        rows = [
            Row(int(Decimal(cells[0].split()[0]) * 10**9), cells[1], cells[-1].split(":")[0])
            for cells in lines
        ]
        yield Example(rule, head[1], rows)


EXAMPLES = list(_examples())


def test_there_are_four() -> None:
    """Each kind of memory has its table."""
    assert [each.rule.split()[1] for each in EXAMPLES] == ["within", "3", "begins", ">="]


@pytest.mark.parametrize("monitor", [Engine, GeneratedMonitor])
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda each: each.rule)
def test_table_is_true(example: Example, monitor: type[Engine] | type[GeneratedMonitor]) -> None:
    """The verdict of each line is that of the engine, and of the generated monitor."""
    rules = program(f"{INPUTS}entity e {{\n  r: {example.rule};\n{OBSERVED}")
    runner = monitor(rules, 0)
    known: dict[str, bool] = {}
    for row in example.rows:
        if row.value:
            value = VALUES.get(row.value, row.value)
            data = {"data": float(value) if isinstance(value, str) and value != "NaN" else value}
            line = {
                "t": str(Decimal(row.t_ns) / 10**9),
                "topic": TOPICS[example.input],
                "data": data,
            }
            trace = read_trace(SourceFile("trace", json.dumps(line)), rules, embedded_store())
            assert not trace.diagnostics
            (message,) = trace.messages
            runner.message(message.t_ns, message.topic, message.leaves)
        else:
            runner.advance(row.t_ns)
        for event in runner.events:
            name = str(event.action)
            known[name.removeprefix("not_")] = not name.startswith("not_")
        verdicts = {(True, False): "true", (False, True): "false", (True, True): "unknown"}
        assert verdicts[known["held"], known["failed"]] == row.verdict, row
