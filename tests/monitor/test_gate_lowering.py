"""Lowering of the lines of a gate to steps."""

from __future__ import annotations

from deros.interfaces.types import FieldType
from deros.monitor import gate_program as form
from deros.monitor.gate_lowering import gate_program
from deros.monitor.ir import Gate, GateLine, Limit
from tests.support.gates import ACTIONS, STORE, message_type, span

SLOW = Limit(("linear", "x"), FieldType("float64"), -0.5, 0.5)
STRAIGHT = Limit(("angular", "z"), FieldType("float64"), 0.0, 0.0)


def lowered(*lines: GateLine, resume_on_zero: bool = False) -> form.GateProgram:
    """Return the program of a gate with some lines."""
    kind = message_type("geometry_msgs.Twist")
    gate = Gate(0, "/wish", "/command", kind, 10, lines, span(1), resume_on_zero=resume_on_zero)
    return gate_program(gate, ACTIONS, STORE)


def line(action: int, *limits: Limit, until_reset: bool = False) -> GateLine:
    """Return a line about an action."""
    return GateLine(action, None, None, limits, span(2), until_reset)


def loss(source: form.Source, ns: int, *limits: Limit) -> GateLine:
    """Return a line about a loss."""
    return GateLine(None, source, ns, limits, span(3))


def choices(program: form.GateProgram) -> dict[str, list[tuple[form.Condition, Limit | None]]]:
    """Return the possible limits of each field, with their conditions."""
    steps = (step for step in program.settle if isinstance(step, form.ChooseLimits))
    return {
        ".".join(map(str, field.path)): [
            (choice.condition, choice.limit) for choice in field.choices
        ]
        for step in steps
        for field in step.fields
    }


def test_actions_are_grouped_by_state_topic() -> None:
    """Topics and actions are listed once, in the order of the lines; unused actions are not."""
    program = lowered(*(line(index) for index in (3, 0, 2, 3)))
    states = [(state.topic, state.actions) for state in program.states]
    assert states == [("/mode", (3, 2)), ("/stop", (0,))]
    assert program.actions == (3, 2, 0)


def test_zero_line_has_an_effect_only_before_a_limit() -> None:
    """A zero line after the last limit of a field does not change that field."""
    program = lowered(
        line(0), line(1, SLOW, STRAIGHT), line(2), line(3, SLOW), loss("heartbeat", 5)
    )
    applies = [form.Applies(index) for index in range(5)]
    assert choices(program) == {
        "linear.x": [
            (applies[0], None),
            (applies[1], SLOW),
            (applies[2], None),
            (applies[3], SLOW),
        ],
        "angular.z": [(applies[0], None), (applies[1], STRAIGHT)],
    }


def test_latched_and_waiting_zeros_have_no_limits() -> None:
    """A latch or a wait makes every field zero, so their lines select no limits."""
    latching = lowered(line(0, until_reset=True), line(1, SLOW))
    assert choices(latching) == {"linear.x": [(form.IsAnyLatched(), None), (form.Applies(1), SLOW)]}
    waiting = lowered(line(0), line(1, SLOW), resume_on_zero=True)
    assert choices(waiting) == {"linear.x": [(form.IsWaiting(), None), (form.Applies(1), SLOW)]}


def test_limits_of_actions_do_not_apply_during_a_loss() -> None:
    """Only losses with a line in the gate count."""
    program = lowered(line(0, SLOW), line(1), loss("input", 7))
    conditions = {
        step.line: step.condition for step in program.settle if isinstance(step, form.FindLine)
    }
    assert conditions == {
        0: form.AllOf((form.IsActive(0), form.Not(form.IsLost(("input",))))),
        1: form.IsActive(1),
        2: form.Silent("input", 7),
    }


def test_events_without_effect_have_no_steps() -> None:
    """A gate with only an input line does not depend on the safety node."""
    program = lowered(loss("input", 7))
    assert program.on_refused == (form.Forget("input"), form.Settle())
    assert not program.states
    assert not program.on_heartbeat
    assert not program.on_no_safety_node


def test_zeros_keep_limited_fields_unless_the_input_is_lost() -> None:
    """A limit before a zero line exempts its fields from the zeros, except while the gate waits."""
    lines = (line(2, SLOW), line(0), loss("input", 7))
    publication = lowered(*lines).publication
    assert publication == form.Publish(form.IsZero(), True, True, form.IsLost(("input",)))
    assert lowered(*lines[:2]).publication == form.Publish(form.IsZero(), True, True)
    waiting = lowered(*lines, resume_on_zero=True).publication
    assert waiting == form.Publish(form.IsWaiting(), True)
    assert lowered(line(0)).publication == form.Publish(form.IsZero(), False)


def test_reset_is_refused_by_zero_lines_and_losses() -> None:
    """Limits of actions do not refuse it."""
    program = lowered(line(0, until_reset=True), line(1, SLOW), loss("heartbeat", 5, SLOW))
    assert program.on_reset == (form.Reset((0, 2), (0,)),)


def test_actions_are_forgotten_when_the_heartbeat_becomes_lost() -> None:
    """The loss is found first, and the lines of the actions after that."""
    program = lowered(line(0), loss("heartbeat", 5), line(1))
    steps = [type(step).__name__ for step in program.settle]
    assert steps[:5] == ["FindLine", "FindLoss", "ForgetActions", "FindLine", "FindLine"]
    assert program.settle[1:3] == (
        form.FindLoss("heartbeat", (1,)),
        form.ForgetActions((0, 1)),
    )
    assert form.HeartbeatWasLost() in program.memory
    without = lowered(loss("heartbeat", 5))
    assert form.HeartbeatWasLost() not in without.memory
    assert not any(isinstance(step, form.ForgetActions) for step in without.settle)
