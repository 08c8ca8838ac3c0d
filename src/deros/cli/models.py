"""The models on a command line: files, and all models below folders."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.generators.output.source_tree import NOT_SEARCHED
from deros.interfaces.files import is_folder, real_path, status, walk
from deros.metamodels.globbing import MOST_FOLDERS
from deros.metamodels.languages import ROSSYSTEM, language_of, suffixes
from deros.pipeline.project import project_of

if TYPE_CHECKING:
    from deros.metamodels.load import LoadedFile, Repository

_IGNORED = ("CMakeCache.txt", "COLCON_IGNORE", "AMENT_IGNORE")


@dataclass(frozen=True, slots=True)
class Named:
    """One model of a command line.

    Attributes:
        path: its file.
        searched: whether it was found in a folder that was named, not named itself.
    """

    path: str
    searched: bool


def named_models(paths: Sequence[str]) -> list[Named]:
    """Return the models that the arguments name, each once, those of a folder sorted.

    Raises:
        click.UsageError: a folder has no model, or too many folders in it.
    """
    found: dict[str, Named] = {}
    for path in paths:
        if not is_folder(path) or language_of(path) is not None:
            found[path] = Named(path, False)
            continue
        models = files_below(path, lambda each: language_of(each) is not None)
        if not models:
            raise click.UsageError(
                f"the folder '{path}' contains no model ({', '.join(suffixes())})"
            )
        for each in models:
            found.setdefault(each, Named(each, True))
    return list(found.values())


def files_below(folder: str, is_wanted: Callable[[str], bool]) -> list[str]:
    """Return the wanted files below a folder, by name.

    Hidden folders are left out, those of builds, and what deros writes to.

    Raises:
        click.UsageError: there are too many folders in it.
    """
    return sorted(filter(is_wanted, _files_below(folder, project_of(folder).output)))


def _files_below(folder: str, output: Path | None) -> Iterator[str]:
    for searched, (here, below, names) in enumerate(walk(folder)):
        if searched >= MOST_FOLDERS:
            raise click.UsageError(f"'{folder}' has more than {MOST_FOLDERS:,} folders: name one")
        below[:] = [each for each in below if _is_searched(Path(here, each), output)]
        yield from (
            os.path.normpath(Path(here, name)) for name in names if not name.startswith(".")
        )


def _is_searched(folder: Path, output: Path | None) -> bool:
    if output is not None and real_path(folder) == real_path(output):
        return False
    if folder.name.startswith(".") or folder.name in NOT_SEARCHED:
        return False
    return not any(status(folder / name) for name in _IGNORED)


def to_be_checked(
    named: Iterable[Named], loaded: Sequence[LoadedFile], repository: Repository
) -> list[LoadedFile]:
    """Return the files that count as named by the user.

    A system that was found in a folder, and that another system imports, is a part of that one: by
    itself its topics may lack ends.
    """
    from deros.models.system import System

    parts = {
        id(repository.load(path))
        for each in repository.files
        if isinstance(each.model, System)
        for statement in each.model.imports
        for path in statement.files
        if language_of(path) is ROSSYSTEM
    }
    pairs = zip(named, loaded, strict=True)
    return [file for name, file in pairs if not (name.searched and id(file) in parts)]
