"""Tools that check the emitted C: they find planted faults, and no others."""

from __future__ import annotations

import functools
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest

from tests.support import c_library, c_pairs
from tests.support.c_everything import examples
from tests.support.c_fuzz import fuzz_text
from tests.support.c_harness import DRIVER, Unit, unit
from tests.support.c_library import CrashError, Watched

FUZZED = ("-std=c99", "-g", "-O1", "-fsanitize=fuzzer,address,undefined")
ENTRY = "int LLVMFuzzerTestOneInput(const char *d, long s) { return (d == 0) && (s != 0); }"

needs_sanitizers = pytest.mark.skipif(
    not c_library.has_sanitizers(), reason="no gcc with sanitizers"
)


def slipped(made: Unit, right: str, wrong: str) -> Unit:
    """Return a mutated monitor."""
    name = f"{made.prefix}_monitor.c"
    assert right in made.texts[name]
    return Unit(made.program, made.view, {**made.texts, name: made.source.replace(right, wrong)})


@pytest.mark.slow
@needs_sanitizers
def test_sanitizers_find_nothing(tmp_path: Path) -> None:
    """Random monitors have no out-of-bounds access and no undefined behaviour."""
    cases = c_pairs.cases(c_pairs.FOCUSES["mixed"], 12, 5)
    with Watched([case.unit for case in cases], tmp_path) as library:
        assert list(c_pairs.differences(library, cases)) == []


@pytest.mark.slow
@needs_sanitizers
def test_sanitizers_detect_an_overrun(tmp_path: Path) -> None:
    """Reading one element too far ends the program with a report."""
    cases = c_pairs.cases(("floats",), 20, 5)
    reads = [case for case in cases if "i < count;" in case.unit.source]
    units = [slipped(read.unit, "i < count;", "i <= count;") for read in reads]
    watched = Watched(units, tmp_path)
    _, error = next(c_pairs.differences(watched, reads))
    assert isinstance(error, CrashError)
    assert "heap-buffer-overflow" in str(error)


@pytest.fixture(scope="module")
def example() -> Unit:
    """Return the monitor of the smallest example."""
    (found,) = (each for each in examples() if each.name == "intelligent_one")
    return unit(found)


@functools.cache
def has_fuzzer() -> bool:
    """Return whether clang links programs with libFuzzer and the sanitizers."""
    with tempfile.TemporaryDirectory(prefix="deros-c-") as folder:
        return shutil.which("clang") is not None and c_library.links(
            folder, "clang", *FUZZED, text=ENTRY
        )


def fuzz(made: Unit, folder: Path) -> subprocess.CompletedProcess[str]:
    """Fuzz a monitor with some tens of thousands of inputs."""
    if not has_fuzzer():
        pytest.skip("no clang with libFuzzer")
    for name, text in made.texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "fuzz.c").write_text(fuzz_text(made), encoding="utf-8")
    flags = [*FUZZED, "-fno-sanitize-recover=all", "-I", str(DRIVER), "fuzz.c", "-o", "fuzz", "-lm"]
    subprocess.run(["clang", *flags], cwd=folder, check=True, timeout=120)
    options = ["-runs=20000", "-seed=1", "-max_len=256", "-len_control=0", "-timeout=5"]
    return subprocess.run(
        ["./fuzz", *options], cwd=folder, capture_output=True, text=True, timeout=120, check=False
    )


def test_fuzzer_finds_nothing(example: Unit, tmp_path: Path) -> None:
    """No input violates the invariants of the smallest example."""
    done = fuzz(example, tmp_path)
    assert done.returncode == 0, done.stderr


SLIPS = {
    "a latch clears itself": (
        "  m->too_fast_condition = condition;",
        "  m->too_fast_condition = condition;\n  m->stop_active = rises;",
    ),
    "a clock step is ignored": ("if (now < m->now)", "if (false)"),
    "a time is not bounded": ("return (t < 0) ? 0 :", "return (t < 0) ? t :"),
    "a loop does not end": ("m->speed_missing = true;", "(void)m;"),
    "a missing input is known": ("news = store_truth(&m->speed_known, false, news);", "(void)m;"),
}
"""Mutations by name, and the violated invariants."""


@pytest.mark.parametrize(
    "slip",
    [
        pytest.param(each, marks=pytest.mark.slow) if each == "a loop does not end" else each
        for each in SLIPS
    ],
)
def test_fuzzer_detects_a_mutation(slip: str, example: Unit, tmp_path: Path) -> None:
    """A mutation violates an invariant after some call."""
    done = fuzz(slipped(example, *SLIPS[slip]), tmp_path)
    assert done.returncode != 0
