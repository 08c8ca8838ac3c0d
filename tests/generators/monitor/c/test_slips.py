"""The slips that the proof must find: made one at a time, in code, of every kind."""

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
    """Return all slips in it."""
    return list(mutants(example.source, example.texts[f"{example.prefix}_monitor.h"]))


def test_every_kind_is_made(slips: list[Mutant]) -> None:
    """There are some of every kind, hundreds in all, and no two are equal."""
    kinds = Counter(each.kind for each in slips)
    assert set(kinds) == set(KINDS)
    assert all(count >= 50 for count in kinds.values())
    assert len({each.source for each in slips}) == len(slips)


def test_slips_are_in_code(example: Unit, slips: list[Mutant]) -> None:
    """No contract and no comment is changed, but where a whole loop goes with its own."""
    comments = _COMMENT.findall(example.source)
    for each in slips:
        assert each.source != example.source
        rest = iter(comments)
        assert all(text in rest for text in _COMMENT.findall(each.source)), each.name


def test_listed_slips_are_made(slips: list[Mutant]) -> None:
    """What is listed as equivalent names a slip, and says why."""
    names = {each.name for each in slips}
    for slip, reason in equivalent()["intelligent_one"].items():
        assert re.sub(r" \(\d+\)$", "", slip) in names
        assert len(reason) > 20


def test_a_slip_in_the_head_of_a_loop_is_named_by_what_changes() -> None:
    """Neither the body of the loop nor the rest of the file is part of its name."""
    loop = "int f(int n)\n{\n  for (int i = 0; i < n; ++i) {\n    g(i);\n  }\n  return n;\n}\n"
    named = {each.name for each in mutants(loop, "") if each.kind == "comparison"}
    assert named == {"f: i < n -> i <= n", "f: i < n -> i > n"}


def test_a_goal_is_allowed_more_than_it_took() -> None:
    """What it took without the slip decides, and not what other goals took."""
    effort = Effort(steps={"hard": 5_000_000, "easy": 10})
    assert effort.allowed("hard") == MARGIN * 5_000_000
    assert effort.allowed("easy") == effort.allowed("another") == LEAST_STEPS


def test_an_interrupted_run_goes_on(tmp_path: Path) -> None:
    """What became of a slip, and what a function's proof takes, are read again."""
    path = tmp_path / "results.jsonl"
    before = Results(path)
    before.add("a", "f: x -> y", Found(goal="ensures"))
    before.add_effort("b", "f", Effort("z3", {"ensures": 5}))
    after = Results(path)
    assert after.get("a") == Found(goal="ensures")
    assert after.effort("b") == Effort("z3", {"ensures": 5})
    assert after.get("b") is None
    assert after.effort("a") is None
