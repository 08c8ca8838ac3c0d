"""The parameter files of one run: each is read once."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from deros.interfaces.files import is_file, real_path
from deros.metamodels.imports import shown_path
from deros.metamodels.parameter_files.events import NotReadable, events
from deros.metamodels.parameter_files.moving import moved_below
from deros.metamodels.parameter_files.reading import Overrides
from deros.metamodels.reading import Unreadable, read
from deros.models.parameter_files import (
    Document,
    LoadedFile,
    Missing,
    NotInstalled,
    ParameterFile,
)

Share = Callable[[str], Path | None]
"""Returns the share folder of an installed package."""


class ParameterFiles:
    """Reads parameter files, and knows which were read."""

    def __init__(self) -> None:
        """Start without files, and without installed packages."""
        self.share: Share = lambda _: None
        self._loaded: dict[str, LoadedFile] = {}
        self._moved: dict[tuple[str, str], LoadedFile] = {}

    @property
    def paths(self) -> list[Path]:
        """The files that have been read, or were there and could not be."""
        return [path for path in map(Path, self._loaded) if is_file(path)]

    def load(self, statement: ParameterFile) -> LoadedFile:
        """Return what the file of a statement holds, or why it cannot be used."""
        place = located(statement, self.share)
        if not isinstance(place, tuple):
            return place
        path, key = place
        if key not in self._loaded:
            self._loaded[key] = _load(path, key)
        found = self._loaded[key]
        namespace = "" if statement.below is None else statement.below.namespace
        if not namespace or not isinstance(found, Document):
            return found
        if (key, namespace) not in self._moved:
            self._moved[key, namespace] = moved_below(found, namespace)
        return self._moved[key, namespace]


class _Named(Protocol):
    """A statement that names a file."""

    @property
    def path(self) -> str: ...

    @property
    def folder(self) -> str: ...

    @property
    def in_package(self) -> tuple[str, str] | None: ...


def located(statement: _Named, share: Share) -> tuple[str, str] | NotInstalled | Missing:
    """Return the path of the file that a statement names, as written and without links."""
    found = statement.in_package
    if found is None:
        path = os.path.normpath(os.path.join(statement.folder, statement.path))  # noqa: PTH118
    else:
        package, below = found
        folder = share(package)
        if folder is None:
            return NotInstalled(package)
        path = os.path.normpath(folder / below)
    try:
        return path, real_path(path)
    except ValueError:
        return Missing(path, "the path has a NUL in it")


def is_absent(unreadable: Unreadable) -> bool:
    """Return whether a file could not be read because there is none."""
    cause = unreadable.__cause__
    return isinstance(cause, OSError) and cause.errno in (errno.ENOENT, errno.ENOTDIR)


def _load(path: str, key: str) -> LoadedFile:
    try:
        source = read(Path(path), shown_path(path), streams=False)
    except Unreadable as unreadable:
        if is_absent(unreadable):
            return Missing(path, "")
        return Missing(path, unreadable.diagnostic.message)
    try:
        steps = events(source)
        overrides: Overrides[None] = Overrides()
        overrides.read(steps, None)
    except NotReadable as refused:
        return refused.fault
    sections = tuple(slot.section() for slot in overrides.slots)
    return Document(source, key, steps, sections)
