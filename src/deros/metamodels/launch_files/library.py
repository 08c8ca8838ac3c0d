"""The launch files of one run: each is read once.

A launch file in Python is a program of its author, and never run here: of it is known that it is
there. What one in XML or YAML declares is read; see :mod:`deros.metamodels.launch_files.contents`.
"""

from __future__ import annotations

import os
from pathlib import Path

from deros.diagnostics import Span
from deros.interfaces.files import is_file, real_path
from deros.metamodels.imports import shown_path
from deros.metamodels.launch_files.contents import document
from deros.metamodels.launch_files.elements import NotALaunchFile, NotRead
from deros.metamodels.launch_files.xml_elements import xml_elements
from deros.metamodels.launch_files.yaml_elements import yaml_elements
from deros.metamodels.parameter_files.library import Share, is_absent, located
from deros.metamodels.reading import Unreadable, read
from deros.models.launch_files import LaunchDocument, LaunchFile, LoadedLaunchFile
from deros.models.parameter_files import Fault, Missing

_READERS = {".xml": xml_elements, ".yaml": yaml_elements, ".yml": yaml_elements}


class LaunchFiles:
    """Reads launch files, and knows which were read."""

    def __init__(self) -> None:
        """Start without files, and without installed packages."""
        self.share: Share = lambda _: None
        self._loaded: dict[str, LoadedLaunchFile] = {}

    @property
    def paths(self) -> list[Path]:
        """The files that have been read, or were there and could not be."""
        return [path for path in map(Path, self._loaded) if is_file(path)]

    def load(self, statement: LaunchFile) -> LoadedLaunchFile:
        """Return what is known of the file of a statement, or why it cannot be used."""
        path = located(statement, self.share)
        if not isinstance(path, str):
            return path
        try:
            key = real_path(path)
        except ValueError:  # a NUL in the path
            return Missing(path, "the path has a NUL in it")
        if key not in self._loaded:
            self._loaded[key] = _load(path, key)
        return self._loaded[key]


def _load(path: str, key: str) -> LoadedLaunchFile:
    try:
        source = read(Path(path), shown_path(path), streams=False)
    except Unreadable as unreadable:
        if is_absent(unreadable):
            return Missing(path, "")
        return Missing(path, unreadable.diagnostic.message)
    ending = os.path.splitext(path)[1]  # noqa: PTH122 - as launch takes it
    if ending == ".py":
        return LaunchDocument(source, key)
    if ending not in _READERS:
        return Fault(
            f"'{shown_path(path)}' ends in none of '.py', '.xml', '.yaml' and '.yml', by which"
            " 'ros2 launch' knows what a file is written in",
            Span(source, 0, 0),
            "rename it",
        )
    try:
        return document(source, key, _READERS[ending](source))
    except NotALaunchFile as refused:
        return refused.fault
    except NotRead:
        return LaunchDocument(source, key)
