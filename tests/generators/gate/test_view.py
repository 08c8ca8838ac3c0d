"""The lines of a gate, as the templates of all languages see them."""

from __future__ import annotations

from deros.generators.gate.view import (
    ActionView,
    LineView,
    deciding_lines,
    heeded_actions,
    line_views,
)
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.types import FieldType
from deros.monitor.ir import Gate, GateLine, Limit, Program
from tests.support.gates import ACTIONS, message_type, span

SLOW = Limit(("linear", "x"), FieldType("float64"), -0.5, 0.5)
STRAIGHT = Limit(("angular", "z"), FieldType("float64"), 0.0, 0.0)


def made(*lines: GateLine) -> tuple[Gate, Program]:
    """Return a gate of some lines, and its program."""
    kind = message_type("geometry_msgs.Twist")
    gate = Gate(0, "/wish", "/command", kind, 10, lines, span(1))
    return gate, Program("robot", (), (), (), (), ACTIONS, (gate,))


def views(*lines: GateLine) -> tuple[LineView, ...]:
    """Return the views of some lines."""
    actions = (ActionView(action.name, f"{action.name}_active", "") for action in ACTIONS)
    return line_views(*made(*lines), actions, UniqueNames(frozenset({"stop"})))


def test_a_line_tells_what_it_is_about() -> None:
    """An action has a state, a loss a time; no variable has a name that is taken."""
    stop, loss = views(
        GateLine(0, None, None, (), span(2)), GateLine(None, "input", 500, (SLOW,), span(3))
    )
    assert (stop.name, stop.title, stop.state, stop.zero) == (
        "stop_2",
        "Action stop",
        "stop_active",
        True,
    )
    assert (loss.name, loss.title, loss.lost_ns, loss.zero) == (
        "lost_input",
        "Lost input",
        500,
        False,
    )
    assert loss.shown == "line 3 (random.deros:3)"


def test_actions_come_by_the_topics_of_their_states() -> None:
    """Each once, topics and actions as first named; those that no line names stay out."""
    gate, program = made(*(GateLine(index, None, None, (), span(2)) for index in (3, 0, 2, 3)))
    heeded = heeded_actions(gate, program)
    assert {topic: [action.name for action, _ in bound] for topic, bound in heeded.items()} == {
        "/mode": ["slower", "slow"],
        "/stop": ["stop"],
    }
    assert list(heeded) == ["/mode", "/stop"]


def test_zero_decides_only_before_a_limit() -> None:
    """What follows the last limit of a field changes nothing for it."""
    lines = views(
        GateLine(0, None, None, (), span(2)),
        GateLine(1, None, None, (SLOW, STRAIGHT), span(3)),
        GateLine(2, None, None, (), span(4)),
        GateLine(3, None, None, (SLOW,), span(5)),
        GateLine(None, "heartbeat", 5, (), span(6)),
    )
    zero, first, second_zero, last, _ = lines
    assert deciding_lines(lines, "linear.x") == [
        (zero, None),
        (first, SLOW),
        (second_zero, None),
        (last, SLOW),
    ]
    assert deciding_lines(lines, "angular.z") == [(zero, None), (first, STRAIGHT)]
