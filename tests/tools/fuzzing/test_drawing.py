"""Mutants are drawn from a seed and a number, and have the size of the examples."""

from __future__ import annotations

import random
from collections import Counter
from pathlib import Path

import pytest

from tools.fuzzing.mutants import KINDS, Drawing
from tools.fuzzing.mutations import LONGEST, mutate_bytes, mutate_text
from tools.fuzzing.projects import projects
from tools.fuzzing.running import Runner, sound_rules

PROJECTS = projects()
Rules = dict[str, tuple[str, ...]]


@pytest.fixture(scope="module")
def rules() -> Rules:
    """Return the files of rules that build, by project."""
    return sound_rules(PROJECTS)


def test_same_seed_and_number_give_the_same_mutant(rules: Rules) -> None:
    """A finding can be reproduced from the output of a run."""
    first, second = Drawing(PROJECTS, 7, rules), Drawing(PROJECTS, 7, rules)
    assert all(first.draw(number) == second.draw(number) for number in range(200))
    assert Drawing(PROJECTS, 8, rules).draw(1) != first.draw(1)


def test_every_kind_is_drawn_with_changes(rules: Rules) -> None:
    """Models and definitions differ from their project; traces and messages are drawn later."""
    drawing = Drawing(PROJECTS, 1, rules)
    sources = {project.name: project.files for project in PROJECTS}
    kinds: Counter[str] = Counter()
    changed = 0
    for number in range(400):
        mutant = drawing.draw(number)
        kinds[mutant.kind] += 1
        changed += mutant.files != sources[mutant.project]
        assert mutant.entry in mutant.files
    assert kinds.keys() == set(KINDS)
    assert changed > 0.4 * (kinds["model"] + kinds["definition"])


def test_only_requested_kinds_are_drawn(rules: Rules) -> None:
    """A run may be limited to one kind."""
    drawing = Drawing(PROJECTS, 1, rules)
    assert {drawing.draw(number, ("definition",)).kind for number in range(30)} == {"definition"}


def test_traces_and_messages_belong_to_a_program(rules: Rules, tmp_path: Path) -> None:
    """Rules with errors, as in many cases, have no program to play or decode."""
    drawing, runner = Drawing(PROJECTS, 1, rules), Runner(tmp_path)
    drawn = [drawing.draw(number, ("trace", "message")) for number in range(100)]
    for mutant in drawn:
        runner.run(mutant)
    assert "no program" not in runner.ends
    assert {mutant.project for mutant in drawn} == {name for name in rules if rules[name]}


@pytest.mark.parametrize("seed", range(40))
def test_mutations_stay_small(seed: int) -> None:
    """Repeated mutation keeps the text within its maximum length."""
    chance = random.Random(seed)
    text, data = PROJECTS[0].files[PROJECTS[0].models[0]].decode(), b"\0\1\0\0abc"
    for _ in range(30):
        text, data = mutate_text(text, [text], chance), mutate_bytes(data, chance)
        assert len(text) <= LONGEST
        assert len(data) <= LONGEST
