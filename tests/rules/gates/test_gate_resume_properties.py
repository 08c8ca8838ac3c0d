"""Properties of a gate that waits, under any sequence of events."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.rules.gates.gate_engine import Output
from deros.rules.program.ir import Gate, Program
from tests.rules.gates.test_gate_properties import (
    Happening,
    Run,
    calls,
    compare_late_calls,
    gates,
    is_zero,
    waits_and_steps,
)
from tests.support.gate_driver import HEARTBEAT, INPUT, LOW, STOP, twist, zero_twist

pytestmark = pytest.mark.essential

LATCHED_HEARTBEAT = HEARTBEAT.replace("zero", "zero until reset")
LATCHED_INPUT = INPUT.replace("zero", "zero until reset")
RESUME = "resume on zero command;"

LATCHING = (
    (STOP, LATCHED_HEARTBEAT, INPUT, LOW),
    (LOW, STOP, INPUT, LATCHED_HEARTBEAT),
    (LOW, LATCHED_INPUT, LATCHED_HEARTBEAT, STOP),
)
LATCHED_WAITING = tuple((*lines, RESUME) for lines in LATCHING)
WAITING = (*LATCHED_WAITING, (STOP, HEARTBEAT, INPUT, LOW, RESUME))

more_calls = st.one_of(
    calls,
    calls,
    st.just(("command", zero_twist())),
    st.just(("reset", None)),
    st.sampled_from((("/stop", False), ("beat", 1))),
)
histories = st.lists(
    st.builds(lambda w, call: (w, *call), waits_and_steps, more_calls), max_size=50
)


class Waiting(Run):
    """A running gate that may be reset.

    Attributes:
        granted: whether the checked call was a successful reset.
    """

    def __init__(self, gate: tuple[Gate, Program]) -> None:
        """Start at 0."""
        super().__init__(gate)
        self.granted = False

    def happen(self, call: str, value: Any) -> list[Output]:
        """Handle one event now, and record it."""
        self.granted = False
        if call != "reset":
            return super().happen(call, value)
        published = self.engine.advance(self.now)
        before = len(self.engine.outputs)
        self.granted = not self.engine.reset(self.now)
        return published + self.engine.outputs[before:]


@given(gates(*WAITING), histories)
def test_zero_command_precedes_motion(gate: tuple[Gate, Program], history: list[Happening]) -> None:
    """Between a zero of the gate and motion, a zero of the controller has passed."""
    run = Waiting(gate)
    run.live(history)
    waits = True
    for output in run.engine.outputs:
        if output.kind == "zero":
            waits = True
            assert is_zero(output.message)
        elif is_zero(output.message):
            waits = False
        else:
            assert not waits


@given(gates(*LATCHING, *LATCHED_WAITING), histories)
def test_loss_lasts_until_the_reset(gate: tuple[Gate, Program], history: list[Happening]) -> None:
    """After the start and after a loss, all is zero until a successful reset."""
    run = Waiting(gate)
    latched = [True]
    watched = [line.lost for line in gate[0].lines if line.until_reset]

    def check(published: list[Output]) -> None:
        for each in published:
            # Commands published by a call before it resets belong to the time before.
            assert each.kind == "zero" or not latched[0]
        for lost in watched:
            latched[0] = latched[0] or run.is_silent(str(lost), run.now)
        if run.granted:
            latched[0] = False

    run.live(history, check)


@given(gates(*LATCHING, *WAITING), histories)
def test_reset_is_refused_while_anything_is_lost_or_active(
    gate: tuple[Gate, Program], history: list[Happening]
) -> None:
    """No reset makes the gate publish motion by itself."""
    run = Waiting(gate)

    def check(published: list[Output]) -> None:
        if run.granted:
            assert not any(run.is_silent(lost, run.now) for lost in ("heartbeat", "input"))
            assert not run.said.get("/stop", True)
        if run.call == "reset":
            assert {each.kind for each in published} <= {"zero", "limited"}

    run.live(history, check)


@given(gates(*LATCHING, *WAITING), histories, st.floats(-9, 9))
def test_waiting_gate_can_always_be_opened(
    gate: tuple[Gate, Program], history: list[Happening], speed: float
) -> None:
    """With everything present and inactive: after a reset and a zero, the next command passes."""
    run = Waiting(gate)
    opening = [
        *((0, "beat", 1), (0, "beat", 1), (0, "/stop", False), (0, "/low_speed", False)),
        *((0, "command", twist(1.0)), (0, "reset", None), (0, "command", zero_twist())),
    ]
    run.live([*history, *opening])
    command = twist(speed)
    published = run.engine.command(run.now, command)
    assert [(each.t_ns, each.kind) for each in published] == [(run.now, "pass")]
    assert published[0].message is command
    assert not any(run.engine.applying)


@given(gates(*WAITING), histories)
def test_late_calls_give_the_same_commands(
    gate: tuple[Gate, Program], history: list[Happening]
) -> None:
    """A gate without a timer publishes the same for each message; only zeros are missing."""
    compare_late_calls(Waiting(gate), Waiting(gate), history)
