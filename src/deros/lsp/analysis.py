"""What is known of the files that an editor has open: models, findings and words.

Each open file is checked as ``deros check FILE`` does, with the unsaved text of all open files in
place of what the disk holds. What it imports is loaded once, and again when it changes.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from deros.diagnostics import Diagnostic, SourceFile
from deros.interfaces.files import Question, answer_again, recorded, unsaved
from deros.metamodels.languages import Language
from deros.metamodels.load import LoadedFile
from deros.models.rules import Rules
from deros.models.system import System
from deros.pipeline.workspace import Workspace, load
from deros.systems.known_topics import TopicTable
from deros.words.index import index_of
from deros.words.words import Index

_CONTENT = "content"
_MOST_ANSWERS, _SPARE_ANSWERS = 2, 100
"""So many times the answers that a file rests on, and so many more, are kept of earlier texts."""


@dataclass(frozen=True)
class Analysis:
    """One state of an open file.

    Attributes:
        file: as it was loaded.
        findings: of the file and of all that it imports, as ``deros check`` reports them.
        workspace: the models that it rests on.
    """

    file: LoadedFile
    findings: tuple[Diagnostic, ...]
    workspace: Workspace

    @property
    def source(self) -> SourceFile:
        """The text; empty if the file could not be read."""
        return self.file.source or SourceFile(self.file.path, "")

    @property
    def language(self) -> Language | None:
        """The language of the file."""
        return self.file.language

    @cached_property
    def paths(self) -> frozenset[str]:
        """The paths of all files that it rests on, without symbolic links."""
        return frozenset(os.path.realpath(each.path) for each in self.workspace.repository.files)

    @cached_property
    def topics(self) -> TopicTable | None:
        """The topics that the file may name; ``None`` for one that names none."""
        match self.file.model:
            case Rules() as rules:
                return self.workspace.builds.of(rules).topics
            case System() as system:
                return TopicTable([self.workspace.builds.flat(system)])
            case _:
                return None

    @cached_property
    def index(self) -> Index:
        """The words of the file, as far as it could be read."""
        return self._index(self.file)

    @cached_property
    def indexes(self) -> tuple[Index, ...]:
        """The words of the file, and of each file that it rests on."""
        others = (each for each in self.workspace.repository.files if each is not self.file)
        return self.index, *map(self._index, others)

    def _index(self, file: LoadedFile) -> Index:
        return index_of(file.model, self.workspace.builds, self.workspace.store)


@dataclass(slots=True)
class _Kept:
    """The last analysis of a file, and the answers of the file system that it rests on."""

    analysis: Analysis
    answers: dict[Question, str]
    needed: int
    """How many answers the file rested on when it was last loaded as a whole."""
    is_spent: bool = False
    """Whether a later analysis has taken on its repository; if that failed, nothing is sure."""

    @property
    def may_grow(self) -> bool:
        """Whether answers that only earlier texts needed are still few."""
        return len(self.answers) <= _MOST_ANSWERS * self.needed + _SPARE_ANSWERS


@dataclass(slots=True)
class Analyses:
    """The analyses of the open files.

    Attributes:
        interfaces: folders with message definitions, searched before those of projects.
    """

    interfaces: tuple[Path, ...] = ()
    _kept: dict[str, _Kept] = field(default_factory=dict)

    def of(self, path: str, texts: Mapping[str, str]) -> Analysis:
        """Return the analysis of an open file.

        Args:
            path: the file.
            texts: the unsaved texts of all open files, by path.
        """
        contents = {os.path.realpath(each): text.encode() for each, text in texts.items()}
        with unsaved(contents), recorded() as answers:
            kept = self._kept.get(path)
            if kept is not None and kept.is_spent:
                kept = None
            changed = [] if kept is None else _changed(kept.answers)
            if kept is not None and not changed:
                return kept.analysis
            if kept is not None and not (kept.may_grow and _only_models(changed, kept.analysis)):
                kept = None
            if kept is None:
                workspace = load([path], self.interfaces)
            else:
                kept.is_spent = True
                workspace = _again(path, kept.analysis.workspace, changed)
                answers.update({**kept.answers, **answers})
            findings = tuple(workspace.check().findings)
        analysis = Analysis(workspace.files[0], findings, workspace)
        needed = len(answers) if kept is None else kept.needed
        self._kept[path] = _Kept(analysis, dict(answers), needed)
        return analysis

    def last(self, path: str) -> Analysis | None:
        """Return the last analysis of a file, which may be of an earlier text."""
        kept = self._kept.get(path)
        return None if kept is None else kept.analysis

    def close(self, path: str) -> None:
        """Forget a file that is no longer open."""
        self._kept.pop(path, None)


def _changed(answers: Mapping[Question, str]) -> list[Question]:
    """Return the questions that have another answer now."""
    return [asked for asked, answer in answers.items() if answer_again(asked) != answer]


def _only_models(changed: Iterable[Question], before: Analysis) -> bool:
    """Return whether nothing has changed but the texts of models."""
    return all(
        kind == _CONTENT and os.path.realpath(path) in before.paths for kind, path, _ in changed
    )


def _again(path: str, before: Workspace, changed: Iterable[Question]) -> Workspace:
    """Return the workspace with files loaded again that have changed, or rest on such files."""
    for _, file, _ in changed:
        before.repository.forget(file)
    return before.again(path)
