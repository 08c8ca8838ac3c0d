"""The models of one run: loaded, checked and built once, as their project files say."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from deros.pipeline.project import Project, interfaces_of, projects_of

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from deros.diagnostics import Diagnostic
    from deros.generators.api.protocol import Context
    from deros.interfaces.store import InterfaceStore
    from deros.metamodels.load import LoadedFile, Repository
    from deros.rules.compiler.build_cache import BuildCache
    from deros.validators.check import Checked, NodeFindings


@dataclass(frozen=True, slots=True)
class Workspace:
    """The models of one run and everything that is shared while they are processed.

    Attributes:
        files: the models that were asked for, in that order.
        projects: the projects that they belong to.
        repository: these models and everything that they import.
        store: the message definitions.
        builds: the rules built so far.
        of_nodes: the findings of node descriptions so far.
    """

    files: tuple[LoadedFile, ...]
    projects: tuple[Project, ...]
    repository: Repository
    store: InterfaceStore
    builds: BuildCache
    of_nodes: NodeFindings = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Have parameter files of packages looked up where their messages are."""
        self.repository.parameter_files.share = self.store.share
        self.repository.launch_files.share = self.store.share

    def check(
        self, files: Sequence[LoadedFile] | None = None, folders: Sequence[str] = ()
    ) -> Checked:
        """Return all findings, as ``deros check`` reports them.

        Models without errors are also held against the targets that their project, or the system
        that runs the rules, names for them: what those refuse is found before anything is
        generated.

        Args:
            files: the models that count as named by the user; all of them by default.
            folders: what the user named. A project in one of these folders is checked as a whole,
                and its allowances must be needed.

        Returns:
            The findings in file order, and those that a model or a project allows.
        """
        from deros.diagnostics import has_errors, in_file_order
        from deros.pipeline.project import unneeded
        from deros.pipeline.refusals import refusals
        from deros.validators.check import Checked

        findings, allowed = self.check_models(files)
        if not has_errors(findings):
            named = self.files if files is None else files
            refused = refusals(named, self.repository, self.context)
            findings = in_file_order([*findings, *refused])
        if not has_errors(findings):
            findings = in_file_order([*findings, *unneeded(self.projects, folders, allowed)])
        return Checked(findings, allowed)

    def check_models(self, files: Sequence[LoadedFile] | None = None) -> Checked:
        """Check models with everything that they import, and the project files.

        For commands that go on to generate, and so learn by themselves what a target refuses.

        Args:
            files: the models that count as named by the user; all of them by default.

        Returns:
            The findings in file order, and those that a model or a project allows.
        """
        from deros.diagnostics import in_file_order
        from deros.validators.check import Checked, check_all

        allowances = [each for project in self.projects for each in project.allowances]
        named = self.files if files is None else files
        checked = check_all(
            named, self.repository, self.store, allowances, self.builds, self.of_nodes
        )
        of_projects = [each for project in self.projects for each in project.diagnostics]
        return Checked(in_file_order([*checked.findings, *of_projects]), checked.allowed)

    def context(self) -> Context:
        """Return what the generators of this run share with its checks."""
        from deros.generators.api.protocol import Context
        from deros.validators.check import check_file

        return Context(self.store, self.repository, check_file, self.builds)

    def again(self, path: str) -> Workspace:
        """Return the workspace of one file whose repository has forgotten what has changed."""
        from deros.rules.compiler.build_cache import BuildCache

        loaded = self.repository.load(path)
        builds = BuildCache(self.store)
        return replace(self, files=(loaded,), builds=builds)


def load(paths: Sequence[str], interfaces: Sequence[Path] = ()) -> Workspace:
    """Load models and everything that they import.

    Args:
        paths: the files, as diagnostics are to show them.
        interfaces: folders with message definitions, searched before those of the projects.
    """
    from deros.interfaces.store import InterfaceStore
    from deros.metamodels.load import Repository
    from deros.rules.compiler.build_cache import BuildCache

    projects = tuple(projects_of(paths))
    store = InterfaceStore(interfaces_of(interfaces, projects))
    repository = Repository()
    files = tuple(repository.load(each) for each in paths)
    return Workspace(files, projects, repository, store, BuildCache(store))


def check_one(path: str, interfaces: Sequence[Path]) -> tuple[LoadedFile, list[Diagnostic]]:
    """Load and check one model; return it with the findings of :meth:`Workspace.check_models`."""
    workspace = load([path], interfaces)
    return workspace.files[0], workspace.check_models().findings
