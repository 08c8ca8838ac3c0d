"""The comparison with the reference engine is sensitive: it finds each mutation of the code."""

from __future__ import annotations

import contextlib
import functools

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from deros.generators.monitor.python.interface import render_monitor
from tests.support.counterexamples import Pair
from tests.support.killing_pairs import KillingPairs
from tests.support.monitors import compare
from tests.support.python_mutants import planted
from tests.support.slips import Slip
from tests.support.strategies import programs, starts, traces

SLIPS: dict[str, tuple[Slip, ...]] = {
    "for is exclusive": (Slip("comparison", "$", "t >= $_due$", ">"),),
    "an interval restarts at every event": (Slip("value", "$", "$_due$ is NEVER", "True"),),
    "an interval is never cleared": (
        Slip("target", "$", "self._$_due$", "", "$_due$ = @ = NEVER"),
    ),
    "a comparison includes its bound": (
        Slip("comparison", "on_$ _judge_$ _act _compute_$", "$$ > $$", ">="),
    ),
    "unknown counts as false": (
        Slip("comparison", "_judge_$ _act reset", "$$ is False", "is not"),
        Slip("constant", "_judge_$ _act reset", "False", "", "$$ is @"),
    ),
    "and for or": (Slip("operator", "$", "$$ or $$", "and"),),
    "and for or in a rule": (Slip("operator", "_judge_$", "$$ or $$", "and"),),
    "or for and": (Slip("operator", "$", "$$ and $$", "or", "if @: $$"),),
    "or for and in a rule": (Slip("operator", "_judge_$", "$$ and $$", "or"),),
    "NaN is taken as a value": (Slip("value", "on_$ _judge_$", "$1 == $1", "True", "if @ $$"),),
    "an input is not forgotten": (Slip("statement", "on_$", "self._forget_$()"),),
    "deadlines are missed": (Slip("statement", "$", "self._catch_up(t)"),),
    "behaviours act at every event": (Slip("value", "_act", "not self._behaviour_$", "True"),),
    "a nested behaviour ignores the outer": (
        Slip("value", "_act", "self._behaviour_$", "True", "@ and $$"),
    ),
    "a reset is never refused": (Slip("value", "reset", "self._behaviour_$ is False", "True"),),
    "a reset is granted on its way": (
        Slip("value", "reset _act", "self._behaviour_$_early is False", "True"),
    ),
    "a reset is always refused": (Slip("value", "reset", "self._behaviour_$ is False", "False"),),
    "messages do not renew the timeout": (Slip("statement", "on_$", "self._$_heard = t"),),
    "intervals survive a clock step": (Slip("once", "_restart", "self._$_due$ = NEVER"),),
    "the first event is treated as a later one": (
        Slip("value", "on_$", "not self._started", "False"),
    ),
    "the grace is ignored": (Slip("value", "_restart", "grace", "0", "self._$_heard = t + @"),),
    "a latch is lost": (Slip("value", "__init__", "'$' in latched", "False"),),
    "a disabled behaviour acts": (Slip("value", "_act", "'$' not in self._disabled", "True"),),
    "enabling does not evaluate the rules": (
        Slip(
            "statement",
            "enable",
            "self._evaluate(t)",
            "",
            "if enabled and $$: self._disabled.remove(behaviour) @ $$",
        ),
    ),
    "disabling does not evaluate the rules": (
        Slip("statement", "enable", "self._evaluate(t)", "", "$$ self._disabled.add(behaviour) @"),
    ),
    "new values are ignored": (Slip("value", "on_$", "$ == self._$", "True", "if @: return"),),
    "new values of several are ignored": (
        Slip("value", "on_$", "not fresh", "True", "if @: return"),
    ),
    "a missing input stays missing": (
        Slip("target", "on_$", "self._$_missing", "", "self._$_silent = @ = False"),
    ),
    "the geometry of a scan is kept": (
        Slip("value", "$", "len(ranges)", "4", "scan_beams(@, $$)"),
    ),
    "the change of a rule has no time": (Slip("statement", "_judge_$", "self._$_since = t"),),
    "within ends too late": (Slip("comparison", "$", "t < $_until$", "<="),),
    "the end of a within is no deadline": (Slip("value", "$", "$_until$ < self._due", "False"),),
    "a within restarts at every event": (Slip("value", "$", "$_until$ is NEVER", "True"),),
    "a within survives a clock step": (Slip("once", "_restart", "self._$_until$ = 0"),),
    "since forgets its cause": (Slip("target", "$", "self._$_kept$", "", "$_kept$ = @ = True"),),
    "a since survives a clock step": (Slip("once", "_restart", "self._$_kept$ = False"),),
    "a cause that was never heard is kept": (
        Slip("value", "_judge_$", "not self._$_came", "False"),
    ),
    "a begins does not end": (Slip("value", "_judge_$", "t < $_due$ < NEVER", "True"),),
    "arithmetic is of what was before": (
        Slip("statement", "$", "self._computed_$ = _compute_$($$)"),
    ),
    "a quotient by zero is infinite": (
        Slip("value", "_compute_$", "math.nan", "math.inf", "$$ != 0.0 else @"),
    ),
    "arithmetic is known without its operands": (
        Slip("once", "_forget_$", "self._computed_$ = NAN"),
    ),
    "the previous value is the present one": (
        Slip("value", "follow", "self.last", "value", "former = @"),
    ),
    "rates use the wrong time": (Slip("operator", "$", "t - self._$_last_t$", "+"),),
}
"""Mutations by name: structural changes of the generated code that are made together."""


@pytest.mark.parametrize("slip", SLIPS)
def test_mutation_is_detected(slip: str, killing_pairs: KillingPairs) -> None:
    """A stored program and trace distinguish the mutated monitor from the reference."""
    killing_pairs.check(
        slip, functools.partial(_kills, slip), lambda shrink: _search(slip, shrink=shrink)
    )


@pytest.mark.slow
@pytest.mark.parametrize("slip", SLIPS)
def test_random_pairs_detect_mutation(slip: str) -> None:
    """Some random program and trace distinguishes the mutated monitor from the reference."""
    assert _search(slip, shrink=False) is not None


def _differs(pair: Pair, text: str) -> bool:
    try:
        compare(pair.program, pair.steps, text, pair.start)
    except (AssertionError, ArithmeticError, LookupError, TypeError):
        return True
    return False


def _kills(slip: str, pair: Pair) -> bool:
    """Return whether the mutated monitor differs from the reference, and the sound one does not."""
    pair.compare()
    mutant = planted(render_monitor(pair.program), SLIPS[slip])
    return mutant is not None and _differs(pair, mutant)


def _search(slip: str, *, shrink: bool) -> Pair | None:
    """Draw pairs until one detects a mutation; return the smallest one if it is to ``shrink``."""
    found: list[Pair] = []
    made: list[bool] = []

    @settings(
        max_examples=3000,
        database=None,
        derandomize=True,
        phases=[Phase.generate, Phase.shrink] if shrink else [Phase.generate],
        suppress_health_check=list(HealthCheck),
        report_multiple_bugs=False,
    )
    @given(st.data())
    def draw(data: st.DataObject) -> None:
        program = data.draw(programs())
        mutant = planted(render_monitor(program), SLIPS[slip])
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
