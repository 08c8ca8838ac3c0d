"""Parts of a gate, common to the templates of all languages."""

from __future__ import annotations

from deros.generators.gate.view import ActionView, ActionWords, action_views, table_of
from deros.interfaces.types import FieldType
from deros.rules.gates.gate_table import Line, Table, state_topics
from deros.rules.gates.gate_table import Stop as TableStop
from deros.rules.program.ir import Gate, GateLine, Limit, Program, Source, Stop
from tests.support.gates import ACTIONS, STORE, message_type, span

SLOW = Limit(("linear", "x"), FieldType("float64"), -0.5, 0.5)
LINES = (
    GateLine(2, None, None, (), span(2), until_reset=True, stop=Stop()),
    GateLine(None, "input", 500, (SLOW,), span(3)),
    GateLine(1, None, None, (), span(4), stop=Stop()),
    GateLine(3, None, None, (SLOW,), span(5)),
    GateLine(2, None, None, (), span(6), stop=Stop()),
    GateLine(None, "heartbeat", 5, (), span(7), stop=Stop()),
)
GATE = Gate(
    0, (Source("/wish"),), "/command", message_type("geometry_msgs.Twist"), 10, LINES, span(1)
)
ZERO = TableStop("zero")
PROGRAM = Program("robot", (), (), (), (), ACTIONS, (GATE,))


def test_table_has_a_row_for_each_line() -> None:
    """Actions are named once, by the topics of their states; a lost heartbeat is severe."""
    limits = {"linear.x": (-0.5, 0.5)}
    assert table_of(GATE, PROGRAM) == Table(
        (
            Line("line 2 (random.deros:2)", "slow", stop=ZERO, until_reset=True),
            Line("line 3 (random.deros:3)", lost="input", lost_ns=500, limits=limits),
            Line("line 4 (random.deros:4)", "go", stop=ZERO),
            Line("line 5 (random.deros:5)", "slower", limits=limits),
            Line("line 6 (random.deros:6)", "slow", stop=ZERO),
            Line("line 7 (random.deros:7)", lost="heartbeat", lost_ns=5, stop=ZERO, is_severe=True),
        ),
        actions=("slow", "slower", "go"),
        fields=("linear.x",),
        period_ns=10,
    )


def test_reports_are_lines_latches_and_waits() -> None:
    """Everything that can hold commands back has a text."""
    table = Table((Line("a", "x", stop=ZERO, until_reset=True), Line("b", "y")), (), (), 1, True)
    assert table.reports == ("a", "b", "waits for a reset, after a", "waits for a zero command")


def test_actions_are_tested_by_their_bindings() -> None:
    """Each topic has the tests of its actions."""
    words = ActionWords("message.", "not ", lambda _, value: f"<{value}>")
    states = state_topics(GATE, ACTIONS)
    assert [(state.topic, action_views(state, PROGRAM, STORE, words)) for state in states] == [
        (
            "/mode",
            (
                ActionView("slow", "message.data == <1>"),
                ActionView("slower", "message.data == <2>"),
            ),
        ),
        ("/go", (ActionView("go", "not message.data"),)),
    ]
