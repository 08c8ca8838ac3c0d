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
from deros.metamodels.parameter_files.moving import put_under
from deros.metamodels.parameter_files.substituting import substituted
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
        self._read: dict[str, LoadedFile] = {}
        self._made: dict[tuple[object, ...], LoadedFile] = {}

    @property
    def paths(self) -> list[Path]:
        """The files that have been read, or were there and could not be."""
        return [path for path in map(Path, self._read) if is_file(path)]

    def load(self, statement: ParameterFile) -> LoadedFile:
        """Return what the file of a statement holds, or why it cannot be used."""
        place = located(statement, self.share)
        if not isinstance(place, tuple):
            return place
        path, key = place
        if key not in self._read:
            self._read[key] = _read(path, key)
        found = self._read[key]
        if not isinstance(found, Document) or statement.is_bare:
            return found
        made = key, statement.keys, statement.given
        if made not in self._made:
            self._made[made] = _made(found, statement)
        return self._made[made]


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


def _made(found: Document, statement: ParameterFile) -> LoadedFile:
    """Return what a file says as a statement has it."""
    if statement.given is not None:
        found = substituted(found, statement.given)
    # What cannot be read by itself is not read elsewhere, unless it is not meant to be.
    alone = found if statement.plain is not None else put_under(found, ())
    is_read = isinstance(alone, Document)
    return put_under(found, statement.keys) if statement.keys and is_read else alone


def _read(path: str, key: str) -> LoadedFile:
    """Return the steps of a file, without what they mean."""
    try:
        source = read(Path(path), shown_path(path), streams=False)
    except Unreadable as unreadable:
        if is_absent(unreadable):
            return Missing(path, "")
        return Missing(path, unreadable.diagnostic.message)
    try:
        return Document(source, key, events(source), ())
    except NotReadable as refused:
        return refused.fault
