"""A function of the table reaches every target through its row, or is rejected by name."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from deros import codes
from deros.generators.api.protocol import GenerationError
from deros.generators.decoder.python.interface import Topic, render_decoders
from deros.generators.monitor.c.interface import render_monitor as render_c
from deros.generators.monitor.python.interface import monitor_view
from deros.generators.monitor.python.interface import render_monitor as render_python
from deros.interfaces.store import InterfaceStore
from deros.rules.engine.engine import Engine
from deros.rules.functions import functions
from deros.rules.functions.function_forms import Remembered, loop, step
from deros.rules.functions.functions import Argument, Function, Result, UnitRule, usage_table
from deros.rules.program import walk
from deros.rules.program.formulas import parse
from deros.rules.program.ir import Apply, Program
from tests.support import c_pairs, c_proof
from tests.support.c_library import Loaded
from tests.support.needs import needs
from tests.support.profiles import scaled, slow
from tests.support.rules import program

SPEED = "input v = topic /speed.data timeout 1 sec"
JOINTS = "input j = topic /joints.position"

SQUARE = Function(
    "square",
    Argument.NUMBER,
    Result.FLOAT,
    UnitRule.NONE,
    usage="x.square()",
    gives="its square",
    formula=parse("value * value"),
    bounds=(0.0, math.inf),
)
EXCESS = Function(
    "excess",
    Argument.NUMBER,
    Result.FLOAT,
    UnitRule.SAME,
    usage="x.excess(0.5)",
    gives="how far it is above a limit",
    parameters=(("limit", "1"),),
    formula=parse("value - limit if value > limit else 0.0"),
)
HEADING = Function(
    "heading",
    Argument.QUATERNION,
    Result.FLOAT,
    UnitRule.FIXED,
    unit="rad",
    usage="q.heading()",
    gives="its angle to the north",
    leaves=("x", "y", "z", "w"),
    formula=parse(
        """
north = 1.0 - 2.0 * (uy * uy + uz * uz)
east = 2.0 * (uw * uz + ux * uy)
atan2(east, north) / (north + east)
"""
    ),
)
PLANAR = Function(
    "planar",
    Argument.VECTOR,
    Result.FLOAT,
    UnitRule.SAME,
    usage="v.planar()",
    gives="its length in the plane",
    leaves=("x", "y"),
    formula=parse("sqrt(x * x + y * y)"),
)
HIGHEST = Function(
    "highest",
    Argument.NUMBER,
    Result.FLOAT,
    UnitRule.SAME,
    usage="x.highest()",
    gives="its greatest value so far",
    step=step(
        """
top = value if not known(top) or value > top else top
top
""",
        Remembered("top", "the greatest value so far"),
    ),
)
TOTAL = Function(
    "total",
    Argument.NUMBER,
    Result.FLOAT,
    UnitRule.NONE,
    usage="x.total()",
    gives="its sum over time",
    step=step(
        """
part = value * elapsed
total = total + part if known(part) else total
total
""",
        Remembered("total", "the sum over time", 0.0),
    ),
)
MEAN = Function(
    "mean",
    Argument.NUMBERS,
    Result.FLOAT,
    UnitRule.SAME,
    usage="a.mean()",
    gives="the mean of its elements",
    leaves=("",),
    loop=loop("total", 0.0, "total + element", "total / count"),
)
LEAST_ABOVE = Function(
    "least_above",
    Argument.NUMBERS,
    Result.FLOAT,
    UnitRule.SAME,
    usage="a.least_above(0.5)",
    gives="its least element above a limit",
    leaves=("",),
    parameters=(("limit", "1"),),
    loop=loop(
        "found",
        math.nan,
        "element if element > limit and (not known(found) or element < found) else found",
    ),
)
ROWS = (SQUARE, EXCESS, HEADING, PLANAR, HIGHEST, TOTAL, MEAN, LEAST_ABOVE)
"""Rows of each form, with and without parameters."""

PROGRAMS = scaled(120)
"""Least number of random programs that call new rows."""

BATCH, BATCHES = 8, 40
"""Programs drawn with one seed, and the most seeds until every row is in two programs."""

KINDS = ("number", "integer", "quaternion", "vector", "array", "floats", "ints")
"""The kinds of inputs that some row applies to."""


class Highest:
    """The largest number so far, as state without a form."""

    result: float | None = None

    def follow(self, t_ns: int, *arguments: float | None) -> None:
        """Process a number."""
        del t_ns
        known = [each for each in (*arguments, self.result) if each is not None]
        self.result = max(known, default=None)


@pytest.fixture
def add(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Return a function that adds rows to the table."""

    def add_rows(*rows: Function) -> None:
        for row in rows:
            for table in (functions.FUNCTIONS, functions.WRITTEN):
                monkeypatch.setitem(table, row.name, row)

    return add_rows


def calls(rules: Program, name: str) -> bool:
    """Return whether rules call a function."""
    values = walk.values(walk.conditions(rules))
    return any(isinstance(value, Apply) and value.function == name for value in values)


@needs("gcc")
def test_rows_are_drawn_and_agree_everywhere(add: Callable[..., None], tmp_path: Path) -> None:
    """A row defines random programs, reference and both monitors, which agree on traces."""
    add(*ROWS)

    def calls_a_row(rules: Program) -> bool:
        return any(calls(rules, row.name) for row in ROWS)

    drawn: list[c_pairs.Case] = []
    rare = list(ROWS)
    for chosen_seed in range(BATCHES):
        drawn += c_pairs.cases(
            KINDS, BATCH, chosen_seed, traces=3, first=len(drawn), accept=calls_a_row
        )
        rare = [
            row for row in ROWS if sum(calls(each.unit.program, row.name) for each in drawn) < 2
        ]
        if len(drawn) >= PROGRAMS and not rare:
            break
    assert not rare, "programs do not call some rows"
    for case in drawn:
        for pair in case.pairs:
            pair.compare()
    library = Loaded([case.unit for case in drawn], tmp_path)
    assert list(c_pairs.differences(library, drawn)) == []


def events(rules: Program, topic: str, *messages: tuple[int, object]) -> list[int]:
    """Return the times in seconds of messages at which the reference acts."""
    engine = Engine(rules)
    for t, value in messages:
        engine.message(t * 10**9, topic, {0: value})  # type: ignore[dict-item]
    return [event.t_ns // 10**9 for event in engine.events if event.kind == "trigger"]


def acting(condition: str, declared: str) -> Program:
    """Return rules that act when a condition becomes true."""
    return program(f"{declared} action a; entity e {{ r: {condition}; }} if e.r then {{ a; }};")


def test_reference_interprets_rows(add: Callable[..., None]) -> None:
    """The engine evaluates forms of a message, of state, and of an array."""
    add(*ROWS)
    speed = "input v = topic /speed.data"
    assert events(acting("v.square() > 3", speed), "/speed", (0, -1.0), (1, -2.0)) == [1]
    assert events(acting("v.excess(1) > 1", speed), "/speed", (0, 2.0), (1, 2.5)) == [1]
    highest = acting("v.highest() > 1", speed)
    assert events(highest, "/speed", (0, 0.5), (1, 2.0), (2, 0.5)) == [1]
    total = acting("v.total() > 3", speed)
    assert events(total, "/speed", (0, 9.0), (1, 2.0), (2, 1.0), (3, 0.5)) == [3]
    mean = acting("j.mean() > 2", JOINTS)
    assert events(mean, "/joints", (0, []), (1, [9.0, -9.0]), (2, [1.0, 4.0])) == [2]


def test_unknown_input_resets_the_state(add: Callable[..., None]) -> None:
    """After a NaN a sum over time restarts, without the time before the NaN."""
    add(TOTAL)
    rules = acting("v.total() > 3", "input v = topic /speed.data")
    messages = ((0, 1.0), (3, 1.0), (4, math.nan), (5, 9.0), (6, 3.5))
    assert events(rules, "/speed", *messages) == [6]


def test_decoders_read_only_the_leaves_of_a_row(add: Callable[..., None]) -> None:
    """Only the fields of a message that the row names are decoded."""
    add(PLANAR)
    rules = acting("w.planar() > 1", "input w = topic /imu.angular_velocity")
    (handler,) = monitor_view(rules).handlers
    paths = [parameter.path for parameter in handler.parameters]
    assert paths == [("angular_velocity", "x"), ("angular_velocity", "y")]
    store = InterfaceStore(())
    text = render_decoders([Topic("imu", rules.topics["/imu"], paths)], store)
    assert "Return angular_velocity.x, angular_velocity.y of a sensor_msgs/msg/Imu." in text


def test_rows_are_in_the_documented_table(add: Callable[..., None]) -> None:
    """The documentation contains the table of all rows, and a new row adds a line."""
    docs = Path(__file__).parents[3] / "docs/languages/rules.md"
    assert usage_table() in docs.read_text(encoding="utf-8"), f"it must hold\n{usage_table()}"
    add(SQUARE, HIGHEST, MEAN)
    lines = usage_table().splitlines()
    assert "| `x.square()` | a number | its square |" in lines
    assert "| `x.highest()` | a number | its greatest value so far |" in lines
    assert "| `a.mean()` | an array of numbers | the mean of its elements |" in lines


RULES = f"""{SPEED} {JOINTS}
input w = topic /imu.angular_velocity
entity e {{
  square: v.square() > 4;
  excess: v.excess(0.5) > 1;
  highest: v.highest() > 1;
  total: v.total() > 3;
  planar: w.planar() > 1;
  mean: j.mean() > 1;
  least: j.least_above(0.5) < 2;
}}
"""

PROVED = {
    "square_of": ("value * value", "value + value"),
    "excess_of": ("value > limit", "value >= limit"),
    "planar_of": ("y * y", "y * x"),
    "highest_of": ("value > *top", "value < *top"),
    "total_of": ("*total + part", "part"),
    "mean_of_float64": ("total / (double)count", "total"),
    "least_above_of_float64": ("element < found", "element > found"),
    "forget_v": ("m->v_last_t = -1;", ""),
}
"""The functions of new rows, and a slip in each."""

QUICK = ("square_of", "highest_of")
"""Functions that are proved quickly: one without state, one with."""


@pytest.fixture
def monitor(add: Callable[..., None], tmp_path: Path) -> Path:
    """Return the source of a monitor that calls functions of new rows."""
    add(*ROWS)
    return c_proof.write(program(RULES), tmp_path)


@needs("frama-c", "why3", "z3", "cvc4")
@pytest.mark.parametrize("functions", [QUICK, slow(tuple(PROVED))], ids=["quick", "all"])
def test_contracts_follow_from_rows(functions: tuple[str, ...], monitor: Path) -> None:
    """The contract of each function is derived from its row, and proved for the printed C."""
    proof = c_proof.prove(monitor, functions)
    assert proof.left == ()
    assert proof.complaints == ()
    assert proof.is_complete


@needs("frama-c", "why3", "z3", "cvc4")
@pytest.mark.parametrize("function", [*map(slow, PROVED)])
def test_mutation_of_a_printed_function_fails_the_proof(function: str, monitor: Path) -> None:
    """A function that differs from its row cannot be proved."""
    right, wrong = PROVED[function]
    text = monitor.read_text(encoding="utf-8")
    start = text.index("{", text.index(f" {function}("))
    end = text.index("\n}\n", start)
    assert right in text[start:end]
    slipped = text[start:end].replace(right, wrong)
    monitor.write_text(text[:start] + slipped + text[end:], encoding="utf-8")
    assert c_proof.prove(monitor, (function,), timeout_s=3).left != ()


@pytest.mark.parametrize(
    ("render", "language"), [(render_python, "Python"), (render_c, "C")], ids=["python", "c"]
)
def test_row_without_a_form_is_rejected(
    add: Callable[..., None], render: Callable[[Program], object], language: str
) -> None:
    """A target that can neither print a function nor has a text for it names the function."""
    memory = Function("highest", Argument.NUMBER, Result.FLOAT, UnitRule.SAME, memory=Highest)
    add(memory)
    rules = acting("v.highest() > 1", SPEED)
    assert events(rules, "/speed", (0, 0.5), (1, 2.0), (2, 0.5)) == [1]
    with pytest.raises(GenerationError) as refused:
        render(rules)
    (finding,) = refused.value.diagnostics
    assert finding.code == codes.UNSUPPORTED_BY_TARGET
    assert finding.message == f"highest() does not exist in {language}"
    assert finding.span.text.startswith("r: v.highest() > 1")


@pytest.mark.parametrize(
    "text", ["value ** 2", "value.real", "sqrt(value, 2)", "sinh(value)", "a = 1", "'a'"]
)
def test_text_that_is_not_a_formula_is_rejected(text: str) -> None:
    """Expressions that targets cannot print are rejected with the row, not during generation."""
    with pytest.raises(ValueError, match=r"formula|expression"):
        parse(text)
