"""The comparison with the reference engine is sensitive: it finds each mutation of the C code."""

from __future__ import annotations

import faulthandler
import functools
import itertools
import multiprocessing
import os
import resource
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from deros.rules.program import walk
from deros.rules.program.ir import Compare, Compute, Const, Program
from tests.support import c_monitors, c_pairs
from tests.support.c_harness import Unit, unit
from tests.support.c_library import Loaded
from tests.support.c_planted import planted
from tests.support.c_shared import shared
from tests.support.counterexamples import Pair
from tests.support.killing_pairs import KillingPairs
from tests.support.needs import needs
from tests.support.slips import listed

SLIPS = listed("Monitor in C")
"""Mutations by name: structural changes of the generated code that are made together."""

WORDS = ("auto", "it's")
"""Strings of the drawn programs that have one length."""

FLAGS = ("-O0", "-Wno-error")
"""Options of the compiler: a mutation may leave a variable that is not used."""

PROGRAMS = 40
"""Number of programs drawn for each choice of inputs in a round."""

ROUNDS = 4
"""Rounds of draws. What a seed draws changes with the loaded modules (:func:`c_pairs.cases`): one
round may miss what every other one finds."""

CPU_S = 1
"""Processor seconds for a pair, which takes milliseconds without an endless loop."""

BATCH = 8
"""Number of mutated programs compiled at once."""


def drawn() -> Iterator[c_pairs.Case]:
    """Draw programs for mutations, mixing different kinds, one round after the other."""
    for number in range(ROUNDS):
        yield from _round(number)


@functools.cache
def _round(number: int) -> tuple[c_pairs.Case, ...]:
    """Draw as many programs of each choice of inputs, and of what is rare among all else."""
    draws: list[tuple[tuple[str, ...], Callable[[Program], bool] | None]] = [
        *((kinds, None) for kinds in c_pairs.FOCUSES.values()),
        (("number",), _divides),
        (("text",), _compares_texts),
    ]
    chosen = [
        c_pairs.cases(kinds, PROGRAMS, 3 + number, first=100 * place, accept=accept)[::-1]
        for place, (kinds, accept) in enumerate(draws)  # later programs of a draw are larger
    ]
    mixed = itertools.zip_longest(*chosen)
    return tuple(case for row in mixed for case in row if case is not None)


def _divides(program: Program) -> bool:
    """Return whether a program has a quotient."""
    values = walk.values(walk.conditions(program))
    return any("/" in value.wording for value in values if isinstance(value, Compute))


def _compares_texts(program: Program) -> bool:
    """Return whether a program compares a string with a constant that is not empty."""
    return any(
        isinstance(part, Compare) and isinstance(part.right, Const) and part.right.value in WORDS
        for condition in walk.conditions(program)
        for part in walk.parts(condition)
    )


def mutated(slip: str, rendered: Unit) -> Unit | None:
    """Return a mutated monitor, or ``None`` if the slip has no place in it."""
    header = rendered.texts[f"{rendered.prefix}_monitor.h"]
    changed = planted(rendered.source, header, SLIPS[slip])
    if changed is None:
        return None
    texts = {**rendered.texts, f"{rendered.prefix}_monitor.c": changed}
    return replace(rendered, texts=texts)


@dataclass(frozen=True)
class Replay:
    """The monitor of a pair without and with a slip: a number in each of two libraries."""

    pair: Pair
    sound: Loaded
    wrong: Loaded
    number: int

    def kills(self) -> bool:
        """Return whether the mutated monitor differs from the reference.

        Raises:
            AssertionError: the sound one does.
        """
        c_monitors.compare(self.sound, self.number, self.pair.steps, self.pair.start)
        return _differs(self.wrong, self.number, self.pair)


@pytest.fixture(scope="module")
def replays(
    killing_pairs: KillingPairs, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Replay]:
    """Return the stored pair of each slip that has a place in it, all compiled together."""
    pairs: dict[str, Pair] = {}
    sound: list[Unit] = []
    wrong: list[Unit] = []
    for slip, pair in killing_pairs.stored.items():
        if slip not in SLIPS:
            continue
        made = unit(pair.program, f"stored_{len(pairs)}")
        changed = mutated(slip, made)
        if changed is not None:
            pairs[slip] = pair
            sound.append(made)
            wrong.append(changed)
    first, second = shared([sound, wrong], tmp_path_factory.mktemp("replays"), *FLAGS)
    return {slip: Replay(pair, first, second, n) for n, (slip, pair) in enumerate(pairs.items())}


@needs("gcc")
@pytest.mark.parametrize("slip", SLIPS)
@pytest.mark.essential
def test_mutation_is_detected(
    slip: str, killing_pairs: KillingPairs, replays: dict[str, Replay], tmp_path: Path
) -> None:
    """A stored program and trace distinguish the mutated monitor from the reference."""
    killing_pairs.check(
        slip,
        lambda pair: _kills(slip, pair, replays.get(slip), tmp_path),
        lambda small: _search(slip, _by_size() if small else drawn(), tmp_path),
    )


@needs("gcc")
@pytest.mark.slow(seconds=60)
@pytest.mark.parametrize("slip", SLIPS)
def test_random_pairs_detect_mutation(slip: str, tmp_path: Path) -> None:
    """Some random program and trace distinguishes the mutated monitor from the reference."""
    assert _search(slip, drawn(), tmp_path) is not None


def _kills(slip: str, pair: Pair, replay: Replay | None, folder: Path) -> bool:
    """Return whether the mutated monitor differs from the reference, and the sound one does not."""
    if replay is None or replay.pair is not pair:  # it has just been found
        sound = unit(pair.program, "found")
        wrong = mutated(slip, sound)
        if wrong is None:
            return False
        right = Loaded([sound], folder / "sound", *FLAGS)
        replay = Replay(pair, right, Loaded([wrong], folder / "wrong", *FLAGS), 0)
    return replay.kills()


def _search(slip: str, cases: Iterable[c_pairs.Case], folder: Path) -> Pair | None:
    """Return the first pair that detects a mutation, without the steps that it does not need."""
    wrong = ((mutated(slip, case.unit), case) for case in cases)
    found = ((made, case) for made, case in wrong if made is not None)
    is_made = False
    while batch := list(itertools.islice(found, BATCH)):
        is_made = True
        units = [made for made, _ in batch]
        library = Loaded(units, folder / units[0].prefix, *FLAGS)
        for number, (_, case) in enumerate(batch):
            for pair in case.pairs:
                if _differs(library, number, pair):
                    return _shortened(library, number, pair)
    assert is_made, f"the slip '{slip}' has no place in any program"
    return None


def _by_size() -> list[c_pairs.Case]:
    """Return the programs of a round, the smallest first."""
    return sorted(_round(0), key=lambda case: len(case.unit.source))


def _shortened(library: Loaded, number: int, pair: Pair) -> Pair:
    place = 0
    while place < len(pair.steps):
        less = replace(pair, steps=pair.steps[:place] + pair.steps[place + 1 :])
        if _differs(library, number, less):
            pair = less
        else:
            place += 1
    return pair


def _differs(library: Loaded, number: int, pair: Pair) -> bool:
    """Compare in a separate process: a mutation may cause a crash or an endless loop."""

    def compare() -> None:
        faulthandler.disable()
        resource.setrlimit(resource.RLIMIT_CPU, (CPU_S, CPU_S))
        try:
            c_monitors.compare(library, number, pair.steps, pair.start)
        except AssertionError:
            os._exit(1)
        os._exit(0)

    child = multiprocessing.get_context("fork").Process(target=compare)
    child.start()
    child.join()
    return child.exitcode != 0
