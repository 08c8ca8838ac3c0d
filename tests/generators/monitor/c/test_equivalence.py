"""The C monitor behaves like the reference engine, for any rules and any trace."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.generators.api.protocol import GenerationError
from deros.generators.monitor.c.interface import render_monitor
from tests.support import c_pairs, counterexamples
from tests.support.c_library import Loaded
from tests.support.needs import needs
from tests.support.profiles import scaled, slow

PROGRAMS = scaled(60)
"""Number of programs drawn per property; five traces are compared for each.

``make pairs`` draws others in every run.
"""

QUICK = ("all kinds", "arrays", "rates")
"""The kinds of programs that every run compares; all of them in CI."""

KEPT = sorted([*counterexamples.FOLDER.glob("*.json"), *c_pairs.FOLDER.glob("*.json")])


@needs("gcc")
@pytest.mark.parametrize(
    "focus", [each if each in QUICK else slow(each) for each in c_pairs.FOCUSES]
)
@pytest.mark.essential
def test_events_match_the_reference(focus: str, tmp_path: Path) -> None:
    """Both give the same events at the same nanosecond, and the same state after every call."""
    cases = c_pairs.cases(c_pairs.FOCUSES[focus], PROGRAMS, 1)
    library = Loaded([case.unit for case in cases], tmp_path, "-O0")
    for pair, error in c_pairs.differences(library, cases):
        raise AssertionError(f"{error}\nof {pair}") from error


@needs("gcc")
@pytest.mark.parametrize("path", KEPT, ids=lambda path: path.stem)
def test_former_counterexample_passes(path: Path) -> None:
    """Former failures are compared in C as well, if C supports the rules."""
    pair = counterexamples.read(path)
    try:
        render_monitor(pair.program)
    except GenerationError:
        pytest.skip("C does not support these rules")
    c_pairs.compare_alone(pair)


@pytest.mark.slow
@needs("gcc")
def test_difference_is_minimised(tmp_path: Path) -> None:
    """A failing pair is reported without unnecessary steps."""
    cases = c_pairs.cases(("number", "boolean"), 20, 1)
    units = [case.unit for case in cases]
    for unit in units:  # every action runs while its behaviour holds
        name = f"{unit.prefix}_monitor.c"
        unit.texts[name] = unit.texts[name].replace("&& (!held)", "|| held")
    differing = [pair for pair, _ in c_pairs.differences(Loaded(units, tmp_path), cases)]
    assert differing
    assert min(len(pair.steps) for pair in differing) <= 3
    kept = counterexamples.write(differing[0], tmp_path / "kept")
    assert counterexamples.read(kept).program == differing[0].program
