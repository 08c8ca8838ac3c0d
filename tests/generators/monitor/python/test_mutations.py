"""The comparison with the reference engine is sensitive: it finds each mutation of the code."""

from __future__ import annotations

import contextlib
import functools
import re

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from deros.generators.monitor.python.interface import render_monitor
from deros.monitor.ir import Program
from tests.support.counterexamples import Pair
from tests.support.killing_pairs import KillingPairs
from tests.support.monitors import compare
from tests.support.strategies import programs, starts, traces

SLIPS = {
    "for is exclusive": (r"t >= (\w+_due)", r"t > \1"),
    "an interval restarts at every event": (r"if \w+_due is NEVER:", "if True:"),
    "an interval is never cleared": (r"(\w+_due) = self\._\w+_due = NEVER", r"\1 = NEVER"),
    "a comparison includes its bound": (r" > ", " >= "),
    "unknown counts as false": (r" is False", " is not True"),
    "and for or": (r" or ", " and "),
    "or for and": (r"^( +if .*) and (?=.*:$)", r"\1 or "),
    "NaN is taken as a value": (r"^        if (\w+) == \1\b.*:", "        if True:"),
    "an input is not forgotten": (r"^            self\._forget_\w+\(\)$", "            pass"),
    "deadlines are missed": (r"^            self\._catch_up\(t\)", "            pass"),
    "behaviours act at every event": (r"if not self\._behaviour_\d+:", "if True:"),
    "a nested behaviour ignores the outer": (r"if self\._behaviour_\d+ and ", "if "),
    "a reset is never refused": (r"^            if self\._behaviour_.*:", "            if False:"),
    "messages do not renew the timeout": (
        r"^            self\._\w+_heard = t$",
        "            pass",
    ),
    "intervals survive a clock step": (
        r"^        self\.(_\w+_due) = NEVER$",
        r"        self.\1 = getattr(self, '\1', NEVER)",
    ),
    "the first event is treated as a later one": (
        r"^        if not self\._started:",
        "        if False:",
    ),
    "the grace is ignored": (r"_heard = t \+ grace$", "_heard = t"),
    "a latch is lost": (r"'\w+' in latched$", "False"),
    "a disabled behaviour acts": (r"'\w+' not in self\._disabled", "True"),
    "enabling does not evaluate the rules": (
        r"^( +)self\._disabled\.remove\(behaviour\)$",
        r"\g<0>\n\1return",
    ),
    "new values are ignored": (r"^( +)if (?:not fresh|\w+ == self\._\w+):$", r"\1if True:"),
    "a missing input stays missing": (r"_silent = self\._\w+_missing = False", "_silent = False"),
    "the geometry of a scan is kept": (r"scan_beams\(len\(ranges\), ", "scan_beams(4, "),
    "the change of a rule has no time": (r"^( {12,})self\._\w+_since = t$", r"\g<1>pass"),
    "within ends too late": (r"t < (\w+_until):", r"t <= \1:"),
    "the end of a within is no deadline": (r"if (\w+_until) < self\._due:", "if False:"),
    "a within restarts at every event": (r"elif \w+_until is NEVER:", "else:"),
    "a within survives a clock step": (
        r"^        self\.(_\w+_until) = 0$",
        r"        self.\1 = getattr(self, '\1', 0)",
    ),
    "since forgets its cause": (r"(\w+_kept) = self\._\w+_kept = True", r"\1 = True"),
    "a since survives a clock step": (
        r"^        self\.(_\w+_kept) = False$",
        r"        self.\1 = getattr(self, '\1', False)",
    ),
    "arithmetic is of what was before": (
        r"^( +)self\._computed_\d+ = _compute_\d+\(.*\)$",
        r"\1pass",
    ),
    "a quotient by zero is infinite": (r" != 0\.0 else math\.nan", " != 0.0 else math.inf"),
    "arithmetic is known without its operands": (
        r"^        self\.(_computed_\d+) = NAN$",
        r"        self.\1 = getattr(self, '\1', NAN)",
    ),
    "the previous value is the present one": (r"former = self\.last", "former = value"),
    "rates use the wrong time": (r"t - self\._(\w+_last_t)", r"t + self._\1"),
}
"""Mutations by name: a pattern of the generated text, and its replacement."""


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


def _mutant(slip: str, program: Program) -> str | None:
    """Return the mutated monitor, or ``None`` if the text does not contain the pattern."""
    text = render_monitor(program)
    mutant = re.sub(*SLIPS[slip], text, flags=re.MULTILINE)
    return mutant if mutant != text else None


def _differs(pair: Pair, text: str) -> bool:
    try:
        compare(pair.program, pair.steps, text, pair.start)
    except (AssertionError, ArithmeticError, LookupError, TypeError):
        return True
    return False


def _kills(slip: str, pair: Pair) -> bool:
    """Return whether the mutated monitor differs from the reference, and the sound one does not."""
    pair.compare()
    mutant = _mutant(slip, pair.program)
    return mutant is not None and _differs(pair, mutant)


def _search(slip: str, *, shrink: bool) -> Pair | None:
    """Draw pairs until one detects a mutation; return the smallest one if it is to ``shrink``."""
    found: list[Pair] = []

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
        mutant = _mutant(slip, program)
        if mutant is None:
            return
        pair = Pair(program, data.draw(starts(program)), tuple(data.draw(traces(program))))
        if _differs(pair, mutant):
            found.append(pair)  # the smallest comes last
            raise AssertionError

    with contextlib.suppress(AssertionError):
        draw()
    return found[-1] if found else None
