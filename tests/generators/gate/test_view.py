"""Names of the parts of a gate, common to the templates of all languages."""

from __future__ import annotations

from deros.generators.gate.view import ActionWords, named_parts
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.types import FieldType
from deros.monitor.ir import Gate, GateLine, Limit, Program
from tests.support.gates import ACTIONS, STORE, message_type, span

SLOW = Limit(("linear", "x"), FieldType("float64"), -0.5, 0.5)
WORDS = ActionWords("message.", "not ", lambda _, value: f"<{value}>")


def test_lines_and_actions_get_unique_names() -> None:
    """An action has a state and a test, a line a title; no variable has a reserved name."""
    lines = (
        GateLine(0, None, None, (), span(2), until_reset=True),
        GateLine(None, "input", 500, (SLOW,), span(3)),
        GateLine(1, None, None, (), span(4)),
        GateLine(2, None, None, (), span(5)),
    )
    gate = Gate(0, "/wish", "/command", message_type("geometry_msgs.Twist"), 10, lines, span(1))
    program = Program("robot", (), (), (), (), ACTIONS, (gate,))
    names = UniqueNames(frozenset({"stop"}))
    _, actions, (stop, loss, *_) = named_parts(gate, program, STORE, WORDS, names)
    assert (stop.name, stop.title, stop.latch) == ("stop_2", "Action stop", "stop_2_latched")
    assert (loss.name, loss.title, loss.latch) == ("lost_input", "Lost input", "")
    assert loss.shown == "line 3 (random.deros:3)"
    assert {index: (view.state, view.test) for index, view in actions.items()} == {
        0: ("stop_active", "message.data"),
        1: ("go_active", "not message.data"),
        2: ("slow_active", "message.data == <1>"),
    }
