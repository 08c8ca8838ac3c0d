"""A function of the table reaches every target, or is rejected by name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from deros import codes
from deros.generators.api.protocol import GenerationError
from deros.generators.monitor.c.interface import render_monitor as render_c
from deros.generators.monitor.python.interface import render_monitor as render_python
from deros.monitor import functions, walk
from deros.monitor.engine import Engine
from deros.monitor.functions import Argument, Function, Result, UnitRule
from deros.monitor.ir import Apply, Program
from tests.support import c_pairs
from tests.support.c_library import Loaded, needs_c
from tests.support.rules import program

SPEED = "input v = topic /speed.data"
HIGH = "entity e { r: v.highest() > 1; } if e.r then { a; };"

SQUARE = Function(
    "square",
    Argument.NUMBER,
    Result.FLOAT,
    UnitRule.NONE,
    evaluate=lambda value: float(value) * float(value),
    bounds=(0.0, float("inf")),
    python_call="square",
    python='''\
def square(value: float) -> float:
    """Return the square of a number."""
    return float(value) * float(value)
''',
    c_call="square",
    c="""\
static double square(double value)
{
  return value * value;
}
""",
)


class Highest:
    """The largest number so far."""

    result: float | None = None

    def follow(self, t_ns: int, *arguments: float | None) -> None:
        """Process a number."""
        del t_ns
        known = [each for each in (*arguments, self.result) if each is not None]
        self.result = max(known, default=None)


HIGHEST = Function("highest", Argument.NUMBER, Result.FLOAT, UnitRule.SAME, memory=Highest)


@pytest.fixture
def add(monkeypatch: pytest.MonkeyPatch) -> Callable[[Function], None]:
    """Return a function that adds a row to the table."""

    def add_row(row: Function) -> None:
        for table in (functions.FUNCTIONS, functions.WRITTEN):
            monkeypatch.setitem(table, row.name, row)

    return add_row


def calls(rules: Program, name: str) -> bool:
    """Return whether rules call a function."""
    values = walk.values(walk.conditions(rules))
    return any(isinstance(value, Apply) and value.function == name for value in values)


@needs_c
def test_stateless_row_reaches_every_target(add: Any, tmp_path: Path) -> None:
    """One row defines rules, reference, both monitors and random programs, which agree."""
    add(SQUARE)
    assert calls(program(f"{SPEED} entity e {{ r: v.square() > 4; }}"), "square")
    cases = c_pairs.cases(("number", "integer"), 150, 1)
    drawn = [case for case in cases if calls(case.pairs[0].program, "square")]
    assert len(drawn) >= 3
    for case in drawn:
        for pair in case.pairs:
            pair.compare()
    library = Loaded([case.unit for case in drawn], tmp_path)
    assert list(c_pairs.differences(library, drawn)) == []


@pytest.mark.parametrize(
    ("render", "language"), [(render_python, "Python"), (render_c, "C")], ids=["python", "c"]
)
def test_stateful_row_missing_in_a_target_is_rejected(
    add: Any, render: Callable[[Program], object], language: str
) -> None:
    """The reference computes it; targets without it raise instead of emitting another function."""
    add(HIGHEST)
    rules = program(f"{SPEED} action a; {HIGH}")
    engine = Engine(rules)
    for number, value in enumerate((0.5, 2.0, 0.5)):
        engine.message(number, "/speed", {0: value})
    assert [event.t_ns for event in engine.events] == [1]
    with pytest.raises(GenerationError) as refused:
        render(rules)
    (finding,) = refused.value.diagnostics
    assert finding.code == codes.UNSUPPORTED_BY_TARGET
    assert finding.message == f"highest() does not exist in {language}"
    assert finding.span.text.startswith("r: v.highest() > 1")
