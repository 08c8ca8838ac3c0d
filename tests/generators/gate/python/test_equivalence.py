"""The generated gate behaves like the reference gate, for any gate and any events."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, note, settings
from hypothesis import strategies as st

from deros.rules.gates.gate_engine import GateEngine
from deros.rules.program.ir import Gate
from tests.support.gate_traces import lives
from tests.support.gates import ACTIONS, STORE, GeneratedGate, gates, gates_with_bounds, play

START_NS = 100


_CHECKS = [HealthCheck.too_slow, HealthCheck.data_too_large]


@settings(suppress_health_check=_CHECKS)
@given(st.data())
@pytest.mark.essential
def test_commands_match_the_reference(data: st.DataObject) -> None:
    """Both publish the same messages at the same nanosecond, with late timers and clock steps."""
    compare(data, data.draw(gates()))


@settings(suppress_health_check=_CHECKS)
@given(st.data())
@pytest.mark.essential
def test_commands_match_where_messages_give_limits(data: st.DataObject) -> None:
    """The same, for gates with ends of limits that messages and parameters give."""
    compare(data, data.draw(gates_with_bounds()))


def compare(data: st.DataObject, gate: Gate) -> None:
    """Let the same happen to the reference, and to the generated gate."""
    engine = GateEngine(gate, ACTIONS, STORE, START_NS)
    generated = GeneratedGate(gate, START_NS)
    note(generated.text)
    t_ns = START_NS
    for each in data.draw(lives(gate)):
        t_ns = max(0, t_ns + each.wait_ns)
        note(f"{each.call} at {t_ns} {each.topic} {each.message} {each.counter} {each.is_trusted}")
        expected, answer = (play(one, t_ns, each) for one in (engine, generated))
        assert answer == expected
        assert generated.outputs == engine.outputs
        if engine.outputs:  # before the first call there is no status
            assert generated.applying == engine.applying
        assert generated.next_deadline is None or generated.next_deadline > t_ns
