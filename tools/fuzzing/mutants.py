"""Mutants: what is run, drawn from the seed of the run and a number."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import PurePosixPath
from typing import Literal

from tools.fuzzing.mutations import mutate_bytes, mutate_text
from tools.fuzzing.projects import Project

Kind = Literal["model", "definition", "trace", "message"]
KINDS: tuple[Kind, ...] = ("model", "definition", "trace", "message")
_SHARES = (46, 8, 17, 29)

TRACE = "trace.jsonl"
MESSAGE = "message.cdr"
"""The files of a mutant that hold a trace, and a message as bytes."""


Rules = Mapping[str, Sequence[str]]
"""Paths of files of rules, by the name of their project."""


@dataclass(frozen=True)
class Mutant:
    """A folder of files, and what is run of it.

    Attributes:
        kind: what was mutated, and so what is run.
        project: the name of the project it comes from.
        files: all files, by relative POSIX path.
        entry: the model that is loaded.
        number: of the message, or the random choices, that a run draws.
        changed: the files that differ from the project's.
    """

    kind: Kind
    project: str
    files: Mapping[str, bytes] = field(repr=False)
    entry: str
    number: int = 0
    changed: tuple[str, ...] = ()

    def with_file(self, path: str, content: bytes) -> Mutant:
        """Return the mutant with another content of one file."""
        return replace(self, files={**self.files, path: content})


class Drawing:
    """Draws mutants of a set of projects; the same seed and number give the same mutant."""

    def __init__(self, projects: Sequence[Project], seed: int, rules: Rules) -> None:
        """Remember what to draw from.

        Args:
            projects: what models and definitions are drawn from.
            seed: of the run.
            rules: what traces and messages are drawn for: rules without errors.
        """
        self._projects = {each.name: each for each in projects}
        self._seed = seed
        self._rules = {name: paths for name, paths in rules.items() if paths}
        self._defined = [each for each in projects if each.definitions]
        self._texts: dict[str, list[str]] = {}
        for each in projects:
            for path, content in each.files.items():
                suffix = PurePosixPath(path).suffix
                self._texts.setdefault(suffix, []).append(content.decode(errors="replace"))

    def draw(self, number: int, kinds: Sequence[Kind] = KINDS) -> Mutant:
        """Return mutant ``number`` of the run."""
        chance = random.Random(f"{self._seed}:{number}")
        weights = [_SHARES[KINDS.index(kind)] for kind in kinds]
        kind = chance.choices(kinds, weights)[0]
        if kind == "definition":
            return self._definition(number, chance)
        if kind == "model":
            return self._model(number, chance)
        # Trace and message are drawn where the program is known: when the mutant runs.
        name = chance.choice(sorted(self._rules))
        entry = chance.choice(self._rules[name])
        return Mutant(kind, name, self._projects[name].files, entry, number)

    def _model(self, number: int, chance: random.Random) -> Mutant:
        # A project first: the cases, of which most have errors, would crowd out the others.
        project = chance.choice(list(self._projects.values()))
        path = chance.choice(project.models)
        changed = {path: self._mutated(project.files[path], path, chance)}
        entry = path
        if chance.random() < 0.25:  # another file of the folder, too, or one that imports it
            other = chance.choice(project.models)
            if other != path and chance.random() < 0.5:
                changed[other] = self._mutated(project.files[other], other, chance)
            entry = other
        return _mutant("model", project, changed, entry, number)

    def _definition(self, number: int, chance: random.Random) -> Mutant:
        project = chance.choice(self._defined)
        path = chance.choice(project.definitions)
        changed = {path: self._mutated(project.files[path], path, chance)}
        if chance.random() < 0.2:
            other = chance.choice(project.definitions)
            changed[other] = self._mutated(project.files[other], other, chance)
        return _mutant("definition", project, changed, chance.choice(project.models), number)

    def _mutated(self, content: bytes, path: str, chance: random.Random) -> bytes:
        if chance.random() < 0.12:
            return mutate_bytes(content, chance)
        suffix = PurePosixPath(path).suffix
        text = mutate_text(content.decode(errors="replace"), self._texts[suffix], chance)
        return text.encode(errors="replace")


def _mutant(
    kind: Kind, project: Project, changed: Mapping[str, bytes], entry: str, number: int
) -> Mutant:
    files = {**project.files, **changed}
    return Mutant(kind, project.name, files, entry, number, tuple(sorted(changed)))
