"""The comparison with the reference engine is sensitive: it finds each mutation of the C code."""

from __future__ import annotations

import faulthandler
import functools
import itertools
import multiprocessing
import os
import re
import resource
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import pytest

from deros.monitor import walk
from deros.monitor.ir import Compute, Program
from tests.support import c_monitors, c_pairs
from tests.support.c_harness import Unit, unit
from tests.support.c_library import Loaded
from tests.support.counterexamples import Pair
from tests.support.killing_pairs import KillingPairs
from tests.support.needs import needs

SLIPS = {
    "for is exclusive": (r"(now - \*since\)) >= duration", r"\1 > duration"),
    "an interval restarts at every event": (r"if \(\*since == \w+\) \{", "if (true) {"),
    "an interval is never cleared": (r"^    \*since = [A-Z0-9_]+;", "    (void)since;"),
    "the end of an interval is not a deadline": (r"^.*due = earlier\(.* duration\);$", ""),
    "a comparison includes its bound": (r" > (?=-?\d)", " >= "),
    "unknown counts as false": (r"(return known \? verdict : \w+)_UNKNOWN", r"\1_FALSE"),
    "or for and": (r"return \(a < b\) \? a : b;(?=\n\}\n\n/\* Kleene)", "return (a < b) ? b : a;"),
    "not of unknown is true": (
        r"(negated\(\w+ operand\)\n\{\n  \w+ verdict = \w+)_UNKNOWN",
        r"\1_TRUE",
    ),
    "NaN is taken as a value": (r"return value == value;", "return true;"),
    "NaN in an array is ignored": (r"numbers = false;", "numbers = true;"),
    "an input is not forgotten": (r"store_truth\(&m->\w+_known, false, news\)", "news"),
    "deadlines are missed": (r"else if \(now >= m->due\)", "else if (false)"),
    "a clock step is ignored": (r"if \(now < m->now\)", "if (false)"),
    "deadlines at t are delayed": (r"while \(m->due <= t\)", "while (m->due < t)"),
    "behaviours act at every event": (r" && \(!held\);", ";"),
    "a nested behaviour ignores the outer": (r"both\(\s*m->\w+_condition,", "both((2),"),
    "a reset is never refused": (r"^    if \(m->\w+_condition == .*\{", "    if (true) {"),
    "a reset succeeds while unknown": (
        r"(if \(\(?m->\w+_condition) == \w+FALSE\)",
        r"\1 < 2)",
    ),
    "a reset has no effect": (r"^(    m->\w+)_ran = true;", r"\1_ran = false;"),
    "messages do not renew the timeout": (r"^    m->\w+_base = m->now;", ""),
    "a missing input stays missing": (r"store_truth\(&m->\w+_missing, false, news\)", "news"),
    "a timeout is late": (r"(\w+_base \+ INT64_C\(\d+\)\)) <= m->now", r"\1 < m->now"),
    "intervals survive a clock step": (r"^  m->\w+_since = [A-Z0-9_]+;", ""),
    "the grace is ignored": (r"bounded\(m->now \+ bounded\(grace\)\)", "m->now"),
    "a latch is lost": (r"^  m->(\w+)_active = true;\n\}", "}"),
    "a disabled behaviour acts": (r"truth_of\(true, m->\w+_enabled\)", "truth_of(true, true)"),
    "enabling does not evaluate the rules": (
        r"(m->\w+_enabled = enabled;)\n    evaluate\(m\);",
        r"\1",
    ),
    "the first event is treated as a later one": (r"if \(!m->started\)", "if (false)"),
    "the change of a rule has no time": (r"^    \*since = now;", "    (void)since;"),
    "rates use the wrong time": (r"t - \*last_t", "t + *last_t"),
    "a rate keeps its first value": (r"^  \*last = value;", ""),
    "within ends too late": (r"\(now < \*until\)", "(now <= *until)"),
    "the end of a within is no deadline": (r"\*due = earlier\(\*due, \*until\);", "(void)due;"),
    "a within restarts at every event": (r"else if \(\*until == \w+\) \{", "else if (true) {"),
    "a within survives a clock step": (r"^  m->\w+_until = 0;", ""),
    "since forgets": (r"m->\w+_kept\)\);", "(0)));"),
    "a since survives a clock step": (r"^  m->\w+_kept = [A-Z0-9_]+_FALSE;", ""),
    "arithmetic is of what was before": (r"^ +m->computed_\d+ = .*;$", ""),
    "arithmetic is known without an operand": (
        r"(?:m->\w+_known && )+is_number\(m->computed",
        "is_number(m->computed",
    ),
    "a quotient by zero is infinite": (r" == 0\.0\) \? NAN", " == 0.0) ? INFINITY"),
    "the previous value is the present one": (r"former = \*last;", "former = value;"),
    "minimum and maximum are swapped": (r"values\[i\] < found", "values[i] > found"),
    "the last element is skipped": (r"i < count;", "(i + 1U) < count;"),
    "a short range is invalid": (r"distance = range_min \+ 0\.0;", "distance = NAN;"),
    "a missing element counts": (r"if \(\w+_given\b", "if (true"),
    "a string is compared by its length": (r"same = \(text\[i\] == expected\[i\]\);", ""),
    "waiting for inputs without a timeout": (r"waiting = true;", "waiting = false;"),
    "a line is wrong": (r"(_BEHAVIOUR_\d+, \d+)U", r"\g<1>1U"),
    "an argument is wrong": (r"_NUMBER, false, 0, 2\.5", "_NUMBER, false, 0, 2.0"),
}
"""Mutations by name: a pattern of the generated text, and its replacement."""

PROGRAMS = 40
"""Number of programs drawn for each choice of inputs."""

CPU_S = 1
"""Processor seconds for a pair, which takes milliseconds without an endless loop."""

BATCH = 8
"""Number of mutated programs compiled at once."""


@functools.cache
def drawn() -> tuple[c_pairs.Case, ...]:
    """Draw programs for mutations, mixing different kinds."""
    chosen = [
        c_pairs.cases(kinds, PROGRAMS, 3, first=100 * number)[::-1]  # later ones are larger
        for number, kinds in enumerate(c_pairs.FOCUSES.values())
    ]
    divided = 100 * len(c_pairs.FOCUSES)
    chosen.append(c_pairs.cases(("number",), PROGRAMS, 3, first=divided, accept=_divides))
    mixed = itertools.zip_longest(*chosen)
    return tuple(case for row in mixed for case in row if case is not None)


def _divides(program: Program) -> bool:
    """Return whether a program has a quotient, of which too few are drawn among all else."""
    values = walk.values(walk.conditions(program))
    return any("/" in value.wording for value in values if isinstance(value, Compute))


def mutated(slip: str, rendered: Unit) -> Unit | None:
    """Return a mutated monitor, or ``None`` if its text does not contain the pattern."""
    name = f"{rendered.prefix}_monitor.c"
    text = rendered.texts[name]
    changed = re.sub(*SLIPS[slip], text, flags=re.MULTILINE)
    if changed == text:
        return None
    return replace(rendered, texts={**rendered.texts, name: changed})


@needs("gcc")
@pytest.mark.parametrize("slip", SLIPS)
def test_mutation_is_detected(slip: str, killing_pairs: KillingPairs, tmp_path: Path) -> None:
    """A stored program and trace distinguish the mutated monitor from the reference."""
    killing_pairs.check(
        slip,
        lambda pair: _kills(slip, pair, tmp_path),
        lambda small: _search(slip, _by_size() if small else drawn(), tmp_path),
    )


@needs("gcc")
@pytest.mark.slow
@pytest.mark.parametrize("slip", SLIPS)
def test_random_pairs_detect_mutation(slip: str, tmp_path: Path) -> None:
    """Some random program and trace distinguishes the mutated monitor from the reference."""
    assert _search(slip, drawn(), tmp_path) is not None


def _kills(slip: str, pair: Pair, folder: Path) -> bool:
    """Return whether the mutated monitor differs from the reference, and the sound one does not."""
    sound = unit(pair.program, "sound")
    wrong = mutated(slip, unit(pair.program, "wrong"))
    if wrong is None:
        return False
    library = Loaded([sound, wrong], folder / "replayed", "-O0", "-Wno-error")
    c_monitors.compare(library, 0, pair.steps, pair.start)
    return _differs(library, 1, pair)


def _search(slip: str, cases: Iterable[c_pairs.Case], folder: Path) -> Pair | None:
    """Return the first pair that detects a mutation, without the steps that it does not need."""
    wrong = ((mutated(slip, case.unit), case) for case in cases)
    found = ((made, case) for made, case in wrong if made is not None)
    while batch := list(itertools.islice(found, BATCH)):
        units = [made for made, _ in batch]
        library = Loaded(units, folder / units[0].prefix, "-O0", "-Wno-error")
        for number, (_, case) in enumerate(batch):
            for pair in case.pairs:
                if _differs(library, number, pair):
                    return _shortened(library, number, pair)
    return None


def _by_size() -> list[c_pairs.Case]:
    """Return the drawn programs, the smallest first."""
    return sorted(drawn(), key=lambda case: len(case.unit.source))


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
