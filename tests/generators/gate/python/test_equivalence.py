"""The generated gate behaves like the reference gate, for any gate and any events."""

from __future__ import annotations

from hypothesis import HealthCheck, given, note, settings
from hypothesis import strategies as st

from deros.rules.gates.gate_engine import GateEngine
from tests.support.gates import ACTIONS, STORE, GeneratedGate, gates, happenings, play

START_NS = 100


@settings(suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(st.data())
def test_commands_match_the_reference(data: st.DataObject) -> None:
    """Both publish the same messages at the same nanosecond, with late timers and clock steps."""
    gate = data.draw(gates())
    engine = GateEngine(gate, ACTIONS, STORE, START_NS)
    generated = GeneratedGate(gate, START_NS)
    note(generated.text)
    t_ns = START_NS
    for each in data.draw(happenings(gate)):
        t_ns = max(0, t_ns + each.wait_ns)
        note(f"{each.call} at {t_ns} {each.topic} {each.message} {each.counter} {each.is_trusted}")
        expected, answer = (play(one, t_ns, each) for one in (engine, generated))
        assert answer == expected
        assert generated.outputs == engine.outputs
        if engine.outputs:  # before the first call there is no status
            assert generated.applying == engine.applying
        assert generated.next_deadline is None or generated.next_deadline > t_ns
