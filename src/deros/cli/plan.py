"""The requests of ``deros generate``: the targets of each model that is named."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.models import Named, named_models, to_be_checked
from deros.pipeline.generate import Request
from deros.pipeline.project import project_of, targets_of

if TYPE_CHECKING:
    from deros.metamodels.load import LoadedFile
    from deros.models.rules import Rules


def plan(
    paths: Sequence[str],
    target: str | None,
    options: Mapping[str, str],
    interfaces: tuple[Path, ...],
) -> list[Request]:
    """Return a request for each model and target.

    Of a folder those models are taken that have the target, or, without one, that the project file
    names targets for; but no node that has a program already, none of a package that
    rules generate, and no system that is part of another one.

    Args:
        paths: files and folders.
        target: the target, or ``None`` for those of the project file.
        options: the options of generators.
        interfaces: folders with message definitions.

    Raises:
        click.UsageError: there is no target for a file, or nothing to generate in the folders.
    """
    named = named_models(paths)
    if any(each.searched for each in named):
        named = _worth_generating(named, options, interfaces)
    requests = [
        Request(each.path, name, options, interfaces)
        for each in named
        for name in _targets(each, target)
    ]
    if not requests:
        what = f"the target '{target}'" if target else "a target in the project file"
        raise click.UsageError(f"no model in {', '.join(paths)} has {what}")
    return requests


def output_of(requests: Sequence[Request]) -> Path:
    """Return the folder that the project files name to write to, or the current one.

    Raises:
        click.UsageError: two of the models belong to projects that name different folders.
    """
    folders = {project_of(each.file).output for each in requests}
    if len(folders) > 1:
        raise click.UsageError("the models belong to projects with different outputs: give -o")
    return next(iter(folders)) or Path()


def _targets(model: Named, target: str | None) -> tuple[str, ...]:
    from deros.generators.api.registry import discover
    from deros.metamodels.languages import language_of

    language = language_of(model.path)
    if target is not None:
        known = language is not None and discover().find(language.name, target) is not None
        return (target,) if known or not model.searched else ()
    targets = targets_of(model.path)
    if not targets and not model.searched:
        suffix = Path(model.path).suffix.removeprefix(".")
        raise click.UsageError(
            f"Missing option '--target'; a project file may name targets: targets.{suffix}"
        )
    return targets


def _worth_generating(
    named: Sequence[Named], options: Mapping[str, str], interfaces: tuple[Path, ...]
) -> list[Named]:
    """Leave out models found in folders from which nothing is generated."""
    from deros.models.node import NodeType
    from deros.models.rules import Rules
    from deros.pipeline.workspace import load

    workspace = load([each.path for each in named], interfaces)
    whole = {id(each) for each in to_be_checked(named, workspace.files, workspace.repository)}
    generated = {
        package
        for each in workspace.files
        if isinstance(each.model, Rules)
        for package in _packages_of_rules(each.model, options)
    }

    def is_wanted(model: Named, file: LoadedFile) -> bool:
        if not model.searched:
            return True
        node = file.model
        if isinstance(node, NodeType):
            return node.executable is None and node.package not in generated
        return id(file) in whole

    return [
        model for model, file in zip(named, workspace.files, strict=True) if is_wanted(model, file)
    ]


def _packages_of_rules(rules: Rules, options: Mapping[str, str]) -> tuple[str, str]:
    """Return the packages of the safety node and its gates, in Python and in C++."""
    from deros.systems.safety_nodes import CPP_SUFFIX, package_name

    package = options.get("package", package_name(rules.name)).removesuffix(CPP_SUFFIX)
    return package, f"{package}{CPP_SUFFIX}"
