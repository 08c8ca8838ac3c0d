"""The generated monitor does what the reference engine does, whatever the rules and the trace."""

from __future__ import annotations

import os

from hypothesis import HealthCheck, given, note, settings
from hypothesis import strategies as st

from deros.generators.monitor_python import render_monitor
from tests.support.monitors import compare
from tests.support.strategies import programs, traces

EXAMPLES = int(os.environ.get("DEROS_EXAMPLES", "600"))
"""Examples per property; set, they are drawn anew in every run, else they are always the same."""

thorough = settings(
    max_examples=EXAMPLES,
    deadline=None,
    derandomize="DEROS_EXAMPLES" not in os.environ,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)


@thorough
@given(st.data())
def test_same_events(data: st.DataObject) -> None:
    """Both give the same events, at the same nanosecond, in the same order."""
    program = data.draw(programs())
    text = render_monitor(program)
    note(text)
    compare(program, data.draw(traces(program)), text)
