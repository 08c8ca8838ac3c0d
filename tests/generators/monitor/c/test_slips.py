"""Mutations for the proof: one at a time, in code, of every kind."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

from tests.support.c_everything import examples
from tests.support.c_harness import Unit, unit
from tests.support.c_mutants import KINDS, Mutant, mutants
from tests.support.c_slips import LEAST_STEPS, MARGIN, Effort, Found, Results
from tools.mutate_proof import equivalent

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)


@pytest.fixture(scope="module")
def example() -> Unit:
    """Return the monitor of the smallest example."""
    (found,) = (each for each in examples() if each.name == "intelligent_one")
    return unit(found)


@pytest.fixture(scope="module")
def slips(example: Unit) -> list[Mutant]:
    """Return all its mutations."""
    return list(mutants(example.source, example.texts[f"{example.prefix}_monitor.h"]))


def test_every_kind_of_mutation_is_generated(slips: list[Mutant]) -> None:
    """There are at least fifty of each kind, and no two are equal."""
    kinds = Counter(slip.kind for slip in slips)
    assert set(kinds) == set(KINDS)
    assert all(count >= 50 for count in kinds.values())
    assert len({slip.source for slip in slips}) == len(slips)


def test_mutations_change_only_code(example: Unit, slips: list[Mutant]) -> None:
    """Contracts and comments stay, unless a whole loop is removed with its own."""
    comments = _COMMENT.findall(example.source)
    for slip in slips:
        assert slip.source != example.source
        rest = iter(comments)
        assert all(text in rest for text in _COMMENT.findall(slip.source)), slip.name


def test_equivalent_mutations_exist_with_a_reason(slips: list[Mutant]) -> None:
    """Each entry of the list names a generated mutation."""
    names = {each.name for each in slips}
    for slip, reason in equivalent()["intelligent_one"].items():
        assert re.sub(r" \(\d+\)$", "", slip) in names
        assert len(reason) > 20


def test_mutation_in_a_loop_header_is_named_by_its_change() -> None:
    """Neither the loop body nor the rest of the file is part of the name."""
    loop = "int f(int n)\n{\n  for (int i = 0; i < n; ++i) {\n    g(i);\n  }\n  return n;\n}\n"
    named = {mutant.name for mutant in mutants(loop, "") if mutant.kind == "comparison"}
    assert named == {"f: i < n -> i <= n", "f: i < n -> i > n"}


def test_proof_limit_follows_the_effort_without_mutation() -> None:
    """The effort for the same goal counts, not that for other goals."""
    effort = Effort(steps={"hard": 5_000_000, "easy": 10})
    assert effort.allowed("hard") == MARGIN * 5_000_000
    assert effort.allowed("easy") == effort.allowed("another") == LEAST_STEPS


def test_interrupted_run_resumes(tmp_path: Path) -> None:
    """Results of mutations and efforts of proofs are read from the file."""
    path = tmp_path / "results.jsonl"
    before = Results(path)
    before.add("a", "f: x -> y", Found(goal="ensures"))
    before.add_effort("b", "f", Effort("z3", {"ensures": 5}))
    after = Results(path)
    assert after.get("a") == Found(goal="ensures")
    assert after.effort("b") == Effort("z3", {"ensures": 5})
    assert after.get("b") is None
    assert after.effort("a") is None
