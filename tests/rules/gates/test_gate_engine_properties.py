"""The engine, which runs steps, agrees with an interpretation of the lines one by one."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from deros.rules.gates.gate_engine import GateEngine
from deros.rules.program.ir import Gate
from tests.support.gate_by_lines import GateByLines
from tests.support.gate_traces import lives
from tests.support.gates import ACTIONS, STORE, gates, gates_with_bounds, play
from tests.support.profiles import scaled

START_NS = 100


_CHECKS = [HealthCheck.too_slow, HealthCheck.data_too_large]


@settings(max_examples=scaled(2500), suppress_health_check=_CHECKS)
@given(st.data())
@pytest.mark.essential
def test_steps_agree_with_the_lines(data: st.DataObject) -> None:
    """Both publish the same messages at the same nanosecond, and report the same reasons."""
    compare(data, data.draw(gates()))


@settings(max_examples=scaled(2500), suppress_health_check=_CHECKS)
@given(st.data())
def test_steps_agree_where_messages_give_limits(data: st.DataObject) -> None:
    """The same, for gates with ends of limits that messages and parameters give."""
    compare(data, data.draw(gates_with_bounds()))


def compare(data: st.DataObject, gate: Gate) -> None:
    """Let the same happen to a gate that takes steps, and to one that reads the lines."""
    constants = {"most": data.draw(st.sampled_from((0.0, 0.3, 1.0, 2.0)))}
    engine = GateEngine(gate, ACTIONS, STORE, START_NS, constants)
    by_lines = GateByLines(gate, ACTIONS, STORE, START_NS, constants)
    t_ns = START_NS
    for happening in data.draw(lives(gate)):
        t_ns = max(0, t_ns + happening.wait_ns)
        answers = [play(one, t_ns, happening) for one in (engine, by_lines)]
        assert answers[0] == answers[1]
        assert engine.outputs == by_lines.outputs
        assert engine.applying == by_lines.applying
        assert engine.next_deadline is None or engine.next_deadline > t_ns
