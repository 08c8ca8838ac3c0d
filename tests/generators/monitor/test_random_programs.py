"""The random programs and traces contain all that monitors are to be compared on."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

from tests.support.counterexamples import Pair, pairs
from tests.support.drawn_features import FEATURES, TRACE_FEATURES, features_of, features_of_trace
from tests.support.strategies import programs

BATCH = 100
BATCHES = 20
"""At most so many are drawn. The least frequent of the features is in one of a hundred pairs."""

RATES = {each for each in (*FEATURES, *TRACE_FEATURES) if "stamp" in each}
EXACT = {each for each in (*FEATURES, *TRACE_FEATURES) if "64-bit" in each}
ORDINARY = {*FEATURES, *TRACE_FEATURES} - RATES - EXACT


@pytest.mark.parametrize(
    ("drawn", "expected"),
    [
        pytest.param(programs(), ORDINARY, id="all kinds"),
        pytest.param(programs(writable=True), ORDINARY - {*TRACE_FEATURES}, id="written as text"),
        pytest.param(programs(kinds=("stamped", "number", "quaternion")), RATES, id="rates"),
        pytest.param(programs(kinds=("long", "wide", "third")), EXACT, id="integers"),
    ],
)
@pytest.mark.slow(seconds=15)
def test_nothing_is_missed(drawn: st.SearchStrategy[object], expected: set[str]) -> None:
    """Each feature occurs soon: the comparison with the reference depends on it."""
    missing = set(expected)

    @settings(
        max_examples=BATCH,
        database=None,
        deadline=None,
        phases=(Phase.generate,),
        suppress_health_check=list(HealthCheck),
    )
    @given(drawn.flatmap(pairs))  # type: ignore[arg-type]
    def draw(pair: Pair) -> None:
        missing.difference_update(features_of(pair.program))
        missing.difference_update(features_of_trace(pair.program, pair.steps))

    for number in range(BATCHES):
        seed(number)(draw)()
        if not missing:
            break
    assert not missing, f"not drawn in {BATCHES * BATCH} pairs"
