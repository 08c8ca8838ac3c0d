"""The patterns of the documentation act as their timelines say."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from deros.diagnostics import SourceFile
from deros.generators.monitor.python.run import GeneratedMonitor
from deros.interfaces.durations import NS_PER_S
from deros.monitor.engine import Engine
from deros.monitor.trace import nanoseconds, read_trace
from tests.support.rules import embedded_store, program

PAGE = Path(__file__).parents[2] / "docs/patterns.md"
_ROW = re.compile(r"^\| (?P<time>[\d.]+) s \|(?P<message>[^|]*)\|(?P<effect>[^|]*)\|$", re.M)
_INPUT = re.compile(r"input (\w+) = topic (/\w+)(?:\.([\w.]+))?")
SCAN = {"angle_min": 0.0, "angle_increment": 0.1, "range_min": 0.125, "range_max": 10.0}


@dataclass(frozen=True)
class Pattern:
    """A section of the page: its rules, and the rows of its timeline as time, message, effect."""

    title: str
    rules: str
    rows: tuple[tuple[str, str, str], ...]

    @property
    def lines(self) -> list[str]:
        """The messages as the lines of a trace."""
        return [self._line(time, message) for time, message, _ in self.rows if message]

    def _line(self, time: str, message: str) -> str:
        places = {name: (topic, path) for name, topic, path in _INPUT.findall(self.rules)}
        data: dict[str, Any] = {}
        topic = ""
        for name, rest, value in re.findall(r"(\w+)((?:\.\w+)*) = (\[[^]]*\]|[^,]+)", message):
            topic, path = places[name]
            if topic == "/scan":
                data = {**SCAN, "ranges": json.loads(value)}
                continue
            *steps, last = f"{path}{rest}".strip(".").split(".")
            inner = data
            for step in steps:
                inner = inner.setdefault(step, {})
            inner[last] = json.loads(value)
        if topic == "/odom":
            seconds, fraction = divmod(nanoseconds(time) or 0, NS_PER_S)
            data["header"] = {"stamp": {"sec": seconds, "nanosec": fraction}}
        return json.dumps({"t": time, "topic": topic, "data": data})


def _patterns() -> list[Pattern]:
    found = []
    for section in PAGE.read_text(encoding="utf-8").split("\n## ")[1:]:
        (rules,) = re.findall(r"```deros\n(.*?)```", section, re.DOTALL)
        rows = tuple(
            (row["time"], row["message"].strip(), row["effect"].strip())
            for row in _ROW.finditer(section)
        )
        found.append(Pattern(section.splitlines()[0], rules, rows))
    return found


PATTERNS = _patterns()


def test_there_are_twenty() -> None:
    """The page says how many there are, and each has a timeline in which something happens."""
    assert len(PATTERNS) == 20
    assert all(any(effect for _, _, effect in each.rows) for each in PATTERNS)


@pytest.mark.parametrize("monitor", [Engine, GeneratedMonitor])
@pytest.mark.parametrize("pattern", PATTERNS, ids=lambda each: each.title)
def test_pattern_acts_as_its_timeline_says(
    pattern: Pattern, monitor: type[Engine | GeneratedMonitor]
) -> None:
    """It triggers the named actions at the named times and no others, a second beyond the end."""
    actions = "action stop; action calm;" if "calm;" in pattern.rules else "action stop;"
    rules = program(f"{actions}\n{pattern.rules}")
    trace = read_trace(SourceFile("trace", "\n".join(pattern.lines)), rules, embedded_store())
    assert not trace.diagnostics
    runner = monitor(rules, 0)
    for message in trace.messages:
        runner.message(message.t_ns, message.topic, message.leaves)
    end_ns = nanoseconds(pattern.rows[-1][0])
    assert end_ns is not None
    runner.advance(end_ns)
    expected = [(nanoseconds(time), effect) for time, _, effect in pattern.rows if effect]
    events = [(each.t_ns, each.action) for each in runner.events if each.kind == "trigger"]
    assert events == expected
