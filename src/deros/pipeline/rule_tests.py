"""The tests of rules: finds the timelines, loads the rules that they are about, and plays them."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from deros.diagnostics import Diagnostic, SourceFile, in_file_order
from deros.metamodels.languages import DEROS, ROSSYSTEM
from deros.metamodels.reading import Unreadable, read
from deros.models.rules import Rules
from deros.pipeline.project import interfaces_of, project_of
from deros.simulation.timelines.document import (
    Case,
    RulesFile,
    RulesText,
    has_timelines,
    read_document,
)
from deros.simulation.timelines.lines import Fault, Line
from deros.simulation.timelines.outcomes import Outcome, Player
from deros.simulation.timelines.reading import read_entries, read_timeline
from deros.simulation.timelines.results import RuleTests

if TYPE_CHECKING:
    from deros.interfaces.store import InterfaceStore
    from deros.rules.program.ir import Program

TIMELINE = ".timeline"
"""The suffix of files that are timelines and nothing else."""

SUFFIXES = (".md", TIMELINE)


def run_rule_tests(
    files: Sequence[str],
    rules: Sequence[str] = (),
    interfaces: Sequence[Path] = (),
    grace_ns: int = 0,
) -> RuleTests:
    """Play the timelines of some files.

    Args:
        files: of timelines.
        rules: files of rules that ought to have some.
        interfaces: folders with message definitions, searched before those of the projects.
        grace_ns: how late inputs may be at the start, like ``startup_grace`` of the node.
    """
    run = _Run(tuple(interfaces), grace_ns)
    for each in files:
        run.file(each)
    players = tuple(each for each in run.players if each is not None and each.played)
    played = {os.path.realpath(each.file) for each in players}
    unplayed = tuple(each for each in rules if os.path.realpath(each) not in played)
    findings = tuple(in_file_order(dict.fromkeys(run.diagnostics)))
    return RuleTests(tuple(run.outcomes), players, unplayed, findings)


def is_timeline_file(path: str) -> bool:
    """Return whether a file in a folder has timelines; what cannot be read may have some."""
    if path.endswith(TIMELINE):
        return True
    if not path.endswith(SUFFIXES):
        return False
    try:
        return has_timelines(read(Path(path), path, streams=False))
    except Unreadable:
        return False


@dataclass
class _Run:
    """What was found so far."""

    interfaces: tuple[Path, ...]
    grace_ns: int
    outcomes: list[Outcome] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    of_files: dict[str, Player | None] = field(default_factory=dict)  # by the path of the rules
    of_texts: list[Player | None] = field(default_factory=list)

    @property
    def players(self) -> Iterator[Player | None]:
        """The rules played so far; ``None`` stands for those that have errors."""
        yield from self.of_files.values()
        yield from self.of_texts

    def file(self, path: str) -> None:
        """Play the timelines of a file."""
        source = self._read(path)
        if source is None:
            return
        document = read_document(source)
        self.diagnostics += document.diagnostics
        store = self._store(path)
        texts: dict[int, Player | None] = {}
        for case in document.cases:
            if isinstance(case.rules, RulesFile):
                player = self._of_file(path, case.rules)
            else:
                key = id(case.rules)
                if key not in texts:
                    texts[key] = self._player(path, rules_of_text(case.rules, store), store)
                    self.of_texts.append(texts[key])
                player = texts[key]
            if player is not None:
                self._play(path, case, player)

    def _play(self, path: str, case: Case, player: Player) -> None:
        try:
            recorded = self._recorded(path, case.trace)
            timeline = read_timeline(case, player.program, recorded)
        except Fault as fault:
            self.diagnostics.append(fault.diagnostic)
            return
        lines, findings = read_entries(timeline, player.program, player.store)
        self.diagnostics += findings
        if not any(each.is_error for each in findings):
            self.outcomes.append(player.play(timeline, lines))

    def _recorded(self, path: str, named: Line | None) -> SourceFile | None:
        if named is None:
            return None
        trace = os.path.normpath(Path(path).parent / named.text)
        try:
            return read(Path(trace), trace, streams=False)
        except Unreadable as unreadable:
            hint = "the path of a trace is relative to the file that names it"
            raise named.fault(unreadable.diagnostic.message, hint) from unreadable

    def _of_file(self, path: str, named: RulesFile) -> Player | None:
        rules = os.path.normpath(Path(path).parent / named.path)
        if rules not in self.of_files:
            self.of_files[rules] = self._load(rules, named)
        return self.of_files[rules]

    def _load(self, path: str, named: RulesFile) -> Player | None:
        from deros.pipeline.workspace import load

        if not Path(path).is_file() or not path.endswith(DEROS.suffix):
            text = f"there is no file '{named.path}' with rules"
            if named.is_implied:
                text = f"no rules: neither here nor in '{named.path}' beside it"
            hint = "write 'Rules: [robot.deros](robot.deros)' below the title"
            self.diagnostics.append(Fault(text, named.span, hint).diagnostic)
            return None
        workspace = load([path], self.interfaces)
        model = workspace.files[0].model
        findings = workspace.repository.diagnostics
        program = None
        if isinstance(model, Rules):
            built = workspace.builds.of(model)
            program, findings = built.program, [*findings, *built.diagnostics]
        return self._player(path, (program, findings), workspace.store)

    def _player(
        self, path: str, loaded: tuple[Program | None, Sequence[Diagnostic]], store: InterfaceStore
    ) -> Player | None:
        program, findings = loaded
        errors = [each for each in findings if each.is_error]
        self.diagnostics += errors
        if errors or program is None:
            return None
        return Player(path, program, store, self.grace_ns)

    def _store(self, path: str) -> InterfaceStore:
        from deros.interfaces.store import InterfaceStore

        return InterfaceStore(interfaces_of(self.interfaces, [project_of(path)]))

    def _read(self, path: str) -> SourceFile | None:
        try:
            return read(Path(path), path, streams=False)
        except Unreadable as unreadable:
            self.diagnostics.append(unreadable.diagnostic)
            return None


def rules_of_text(
    rules: RulesText, store: InterfaceStore
) -> tuple[Program | None, Sequence[Diagnostic]]:
    """Build rules that stand beside their timelines; return the program, and the findings."""
    from deros.metamodels.load import Repository
    from deros.rules.compiler.build import build

    repository = Repository()
    path = rules.source.path
    if rules.system is not None:
        beside = Path(path).parent / rules.system_path
        repository.load_part(beside, rules.system, ROSSYSTEM)
    model = repository.load_part(path, rules.source, DEROS).model
    findings = repository.diagnostics
    if not isinstance(model, Rules):
        return None, findings
    built = build(model, store)
    return built.program, [*findings, *built.diagnostics]
