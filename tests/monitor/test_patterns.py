"""The patterns of the documentation act as their timelines say."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.diagnostics import SourceFile
from deros.generators.monitor.python.run import GeneratedMonitor
from deros.monitor.engine import Engine
from deros.monitor.trace import read_trace
from tests.support import timelines
from tests.support.rules import embedded_store, program
from tests.support.timelines import Timeline

PATTERNS = timelines.read(Path(__file__).parents[2] / "docs/patterns.md")


def test_there_are_twenty_one() -> None:
    """The page says how many there are, and each has a timeline in which something happens."""
    assert len(PATTERNS) == 21
    assert all(each.expect for each in PATTERNS)


@pytest.mark.parametrize("pattern", PATTERNS, ids=lambda each: each.name)
def test_pattern_acts_as_its_timeline_says(pattern: Timeline) -> None:
    """It triggers the named actions at the named times and no others."""
    actions = "action stop; action calm;" if "calm;" in pattern.rules else "action stop;"
    rules = program(f"{actions}\n{pattern.rules}")
    trace = read_trace(SourceFile("trace", "\n".join(pattern.trace)), rules, embedded_store())
    assert not trace.diagnostics
    for monitor in (Engine, GeneratedMonitor):
        runner = monitor(rules, 0)
        for message in trace.messages:
            runner.message(message.t_ns, message.topic, message.leaves)
        runner.advance(pattern.until_ns)
        assert timelines.happenings(runner.events) == pattern.expect, monitor
