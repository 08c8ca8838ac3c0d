"""The launch files of one run, and its files for xacro: each is read once.

A launch file in Python is a program of its author, and never run here: of it is known that it is
there. What one in XML or YAML declares is read; see :mod:`deros.metamodels.launch_files.contents`,
and :mod:`deros.metamodels.launch_files.xacro` for xacro.
"""

from __future__ import annotations

import os
from pathlib import Path

from deros.diagnostics import Span
from deros.interfaces.files import is_file, real_path
from deros.metamodels.imports import shown_path
from deros.metamodels.launch_files.contents import document
from deros.metamodels.launch_files.elements import NotALaunchFile, NotRead
from deros.metamodels.launch_files.xacro import xacro_contents
from deros.metamodels.launch_files.xml_elements import xml_elements
from deros.metamodels.launch_files.yaml_elements import yaml_elements
from deros.metamodels.parameter_files.library import Share, is_absent, located
from deros.metamodels.reading import Unreadable, read
from deros.models.launch_files import (
    LaunchDocument,
    LaunchFile,
    LoadedLaunchFile,
    LoadedXacroFile,
    XacroDocument,
    XacroFile,
)
from deros.models.parameter_files import Fault, Missing

_MOST_INCLUDED = 200
"""Files that one file for xacro may include, before no more is said of it."""
_READERS = {".xml": xml_elements, ".yaml": yaml_elements, ".yml": yaml_elements}


class LaunchFiles:
    """Reads launch files, and knows which were read."""

    def __init__(self) -> None:
        """Start without files, and without installed packages."""
        self.share: Share = lambda _: None
        self._loaded: dict[str, LoadedLaunchFile] = {}
        self._xacro: dict[str, LoadedXacroFile] = {}
        self._parts: set[str] = set()

    @property
    def paths(self) -> list[Path]:
        """The files that have been read, or were there and could not be."""
        read = dict.fromkeys((*self._loaded, *self._xacro, *sorted(self._parts)))
        return [path for path in map(Path, read) if is_file(path)]

    def load(self, statement: LaunchFile) -> LoadedLaunchFile:
        """Return what is known of the file of a statement, or why it cannot be used."""
        place = located(statement, self.share)
        if not isinstance(place, tuple):
            return place
        path, key = place
        if key not in self._loaded:
            self._loaded[key] = _load(path, key)
        return self._loaded[key]

    def load_xacro(self, statement: XacroFile) -> LoadedXacroFile:
        """Return what is known of the file of a parameter, or why it cannot be used."""
        place = located(statement, self.share)
        if not isinstance(place, tuple):
            return place
        path, key = place
        if key not in self._xacro:
            seen: set[str] = set()
            self._xacro[key] = _load_xacro(path, key, seen)
            self._parts |= seen
        return self._xacro[key]


def _load_xacro(path: str, key: str, seen: set[str]) -> LoadedXacroFile:
    """Read a file and what it includes; ``seen`` is what has been read before."""
    seen.add(key)
    try:
        source = read(Path(path), shown_path(path), streams=False)
    except Unreadable as unreadable:
        if is_absent(unreadable):
            return Missing(path, "")
        return Missing(path, unreadable.diagnostic.message)
    try:
        found = xacro_contents(xml_elements(source))
    except NotALaunchFile as refused:
        return refused.fault
    except NotRead:
        return XacroDocument(source, key)
    included: list[XacroDocument] = []
    for name in found.includes:
        inner = os.path.normpath(os.path.join(os.path.dirname(path), name))  # noqa: PTH118, PTH120
        inner_key = real_path(inner)
        if inner_key in seen or len(seen) >= _MOST_INCLUDED:
            found.is_complete &= inner_key in seen
            continue
        document = _load_xacro(inner, inner_key, seen)
        if isinstance(document, XacroDocument):
            included.append(document)
        found.is_complete &= isinstance(document, XacroDocument) and document.is_complete
    return XacroDocument(
        source,
        key,
        {**found.arguments, **{n: s for each in included for n, s in each.arguments.items()}},
        frozenset(found.used).union(*(each.used for each in included)),
        {**found.needed, **{n: s for each in included for n, s in each.needed.items()}},
        tuple(included),
        found.is_complete,
    )


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
