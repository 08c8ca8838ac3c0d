"""Results of tests of rules for people: few of many differences, and colours on a terminal."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from rich.text import Text

from deros.pipeline.rule_tests import run_rule_tests
from deros.report.rule_tests import print_text
from deros.simulation.timelines.results import RuleTests

PAGE = """\
```rossystem
system Robot
topics
  external topic /speed : std_msgs.Float64
```
```deros
use "robot.system" import Robot
action stop;
input v = topic /speed.data
entity e { r: v > 0.5; }
if e.r then { stop; };
```

| time | message | effect |
|---|---|---|
"""


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture
def results(tmp_path: Path) -> RuleTests:
    """Return the results of a timeline that expects too much."""
    rows = "".join(f"| {second} s | | stop |\n" for second in range(1, 31))
    path = tmp_path / "page.md"
    path.write_text(f"{PAGE}{rows}", encoding="utf-8")
    return run_rule_tests([str(path)])


def test_many_differences_are_counted(results: RuleTests) -> None:
    """The first of them show what is wrong; programs get all."""
    out = io.StringIO()
    print_text(results, out)
    lines = out.getvalue().splitlines()
    assert sum("is expected" in line for line in lines) == 20
    assert "    and 10 more differences" in lines


def test_terminal_has_the_same_words(results: RuleTests, monkeypatch: pytest.MonkeyPatch) -> None:
    """In colours, unless ``NO_COLOR`` is set."""
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm-256color")
    plain, coloured, uncoloured = io.StringIO(), _Terminal(), _Terminal()
    print_text(results, plain)
    print_text(results, coloured)
    assert "\x1b[" in coloured.getvalue()
    assert Text.from_ansi(coloured.getvalue()).plain.split() == plain.getvalue().split()
    monkeypatch.setenv("NO_COLOR", "1")
    print_text(results, uncoloured)
    assert uncoloured.getvalue() == plain.getvalue()
