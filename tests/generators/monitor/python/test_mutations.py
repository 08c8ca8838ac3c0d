"""The comparison with the reference engine is sensitive: it finds each mutation of the code."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Mapping

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from deros.generators.monitor.python.interface import render_monitor
from deros.rules.program.ir import Program
from tests.support.counterexamples import Pair
from tests.support.killing_pairs import KillingPairs
from tests.support.monitors import compare
from tests.support.python_mutants import planted
from tests.support.slips import listed
from tests.support.strategies import programs, starts, traces

SLIPS = listed("Monitor in Python")
"""Mutations by name: structural changes of the generated code that are made together."""


@pytest.mark.parametrize("slip", SLIPS)
@pytest.mark.essential
def test_mutation_is_detected(slip: str, killing_pairs: KillingPairs) -> None:
    """A stored program and trace distinguish the mutated monitor from the reference."""
    killing_pairs.check(
        slip, functools.partial(_kills, slip), lambda shrink: _search(slip, shrink=shrink)
    )


@pytest.mark.slow(seconds=30)
@pytest.mark.parametrize("slip", SLIPS)
def test_random_pairs_detect_mutation(slip: str) -> None:
    """Some random program and trace distinguishes the mutated monitor from the reference."""
    assert _search(slip, shrink=False) is not None


def _differs(pair: Pair, texts: Mapping[str, str]) -> bool:
    try:
        compare(pair.program, pair.steps, texts, pair.start)
    except (AssertionError, ArithmeticError, LookupError, TypeError):
        return True
    return False


def _mutant(program: Program, slip: str) -> dict[str, str] | None:
    """Return the monitor with a slip in the module that has a place for it, if one has."""
    texts = render_monitor(program)
    for name, text in texts.items():
        mutant = planted(text, SLIPS[slip])
        if mutant is not None:
            return {**texts, name: mutant}
    return None


def _kills(slip: str, pair: Pair) -> bool:
    """Return whether the mutated monitor differs from the reference, and the sound one does not."""
    pair.compare()
    mutant = _mutant(pair.program, slip)
    return mutant is not None and _differs(pair, mutant)


def _search(slip: str, *, shrink: bool) -> Pair | None:
    """Draw pairs until one detects a mutation; return the smallest one if it is to ``shrink``."""
    found: list[Pair] = []
    made: list[bool] = []

    @settings(
        max_examples=10_000,
        database=None,
        derandomize=True,
        phases=[Phase.generate, Phase.shrink] if shrink else [Phase.generate],
        suppress_health_check=list(HealthCheck),
        report_multiple_bugs=False,
    )
    @given(st.data())
    def draw(data: st.DataObject) -> None:
        program = data.draw(programs())
        mutant = _mutant(program, slip)
        if mutant is None:
            return
        made.append(True)
        pair = Pair(program, data.draw(starts(program)), tuple(data.draw(traces(program))))
        if _differs(pair, mutant):
            found.append(pair)  # the smallest comes last
            raise AssertionError

    with contextlib.suppress(AssertionError):
        draw()
    assert made, f"the slip '{slip}' has no place in any program"
    return found[-1] if found else None
