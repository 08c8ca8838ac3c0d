"""Random programs with random traces, compiled many at a time and compared with the reference."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

from deros.generators.api.protocol import GenerationError
from deros.rules.program import ir
from tests.support import c_monitors
from tests.support.c_harness import Unit, unit
from tests.support.c_library import CrashError, Library, Loaded
from tests.support.counterexamples import Pair, pairs
from tests.support.strategies import ALL_KINDS, KINDS, MORE_KINDS, programs

TRACES = 5
"""Traces that are drawn for each program: to compile takes longer than to compare."""

FOLDER = Path(__file__).resolve().parents[1] / "generators/monitor/c/counterexamples"
"""Where pairs are kept on which C and the reference have differed."""

FOCUSES: dict[str, tuple[str, ...]] = {
    "all kinds": tuple(KINDS),
    "integers and elements": tuple(MORE_KINDS),
    "arrays": ("scan", "array", "element", "floats", "ints"),
    "few values": ("number", "boolean"),
    "rates": ("stamped", "number", "quaternion"),
    "mixed": tuple(ALL_KINDS),
}
"""The kinds of inputs that programs are drawn with."""


@dataclass(frozen=True)
class Case:
    """A compiled program, and what it is to be driven with."""

    unit: Unit
    pairs: tuple[Pair, ...]


def cases(
    kinds: tuple[str, ...],
    wanted: int,
    chosen_seed: int,
    traces: int = TRACES,
    first: int = 0,
    accept: Callable[[ir.Program], bool] | None = None,
) -> list[Case]:
    """Draw programs that C has monitors for, each with its traces; they are numbered.

    The same seed gives the same programs only while the same modules are loaded: Hypothesis also
    draws the constants in their source.

    Args:
        kinds: the kinds of their inputs.
        wanted: their number.
        chosen_seed: the seed of the draws.
        traces: the number of traces of each program.
        first: the number of the first program.
        accept: returns whether a program is wanted; every one is by default.

    Raises:
        AssertionError: fewer than one of ten programs could be used.
    """
    found: list[Case] = []
    chosen = programs(kinds=kinds)
    if accept is not None:
        chosen = chosen.filter(accept)
    for batch in range(10):
        for drawn in _draws(chosen, wanted, traces, chosen_seed + (batch << 48)):
            try:
                rendered = unit(drawn[0].program, f"random_{first + len(found)}")
            except GenerationError:
                continue
            found.append(Case(rendered, drawn))
            if len(found) == wanted:
                return found
    raise AssertionError(f"{len(found)} of {10 * wanted} random programs can be used")


def _draws(
    chosen: st.SearchStrategy[ir.Program], examples: int, traces: int, chosen_seed: int
) -> list[tuple[Pair, ...]]:
    """Draw programs, each with its traces."""
    found: list[tuple[Pair, ...]] = []

    @seed(chosen_seed)
    @settings(
        max_examples=examples,
        database=None,
        deadline=None,
        phases=(Phase.generate,),
        suppress_health_check=list(HealthCheck),
    )
    @given(chosen.flatmap(lambda each: st.tuples(*[pairs(each)] * traces)))
    def draw(drawn: tuple[Pair, ...]) -> None:
        found.append(drawn)

    draw()
    return found


def differences(library: Library, chosen: Sequence[Case]) -> Iterator[tuple[Pair, AssertionError]]:
    """Compare all cases of a library; yield the pairs that differ, each with its shortest trace."""
    for number, case in enumerate(chosen):
        for pair in case.pairs:
            error = _difference(library, number, pair)
            if error is not None:
                crashed = isinstance(error, CrashError)  # and answers no more
                yield pair if crashed else _shortened(library, number, pair), error


def compare_alone(pair: Pair) -> None:
    """Compile one program and compare it.

    Raises:
        AssertionError: it differs from the reference.
        GenerationError: C has no such monitor.
    """
    with tempfile.TemporaryDirectory(prefix="deros-c-") as folder:
        library = Loaded([unit(pair.program)], Path(folder), "-O0")
        c_monitors.compare(library, 0, pair.steps, pair.start)


def _difference(library: Library, number: int, pair: Pair) -> AssertionError | None:
    try:
        c_monitors.compare(library, number, pair.steps, pair.start)
    except AssertionError as error:
        return error
    return None


def _shortened(library: Library, number: int, pair: Pair) -> Pair:
    """Return a pair that differs without any step that it does not take."""
    place = 0
    while place < len(pair.steps):
        less = replace(pair, steps=pair.steps[:place] + pair.steps[place + 1 :])
        if _difference(library, number, less) is None:
            place += 1
        else:
            pair = less
    return pair
