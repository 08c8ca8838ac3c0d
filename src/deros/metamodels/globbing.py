"""Files that a pattern with ``*``, ``?``, ``[…]`` and ``**`` matches, each folder visited once.

``glob`` of the standard library follows every symbolic link, so that a cycle of two links makes it
run for ever.
"""

from __future__ import annotations

import glob
import os.path
from collections.abc import Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from pathlib import PurePath

from deros.interfaces.files import entries, identity, is_folder, is_named

MOST_FOLDERS = 20_000
"""The number of folders that a pattern may search."""


class TooManyFolders(Exception):  # noqa: N818 - a finding about the model, not an error of the program
    """The pattern searches more folders than :data:`MOST_FOLDERS`."""


def matching_files(parent: str, pattern: str) -> Iterator[str]:
    """Yield the paths below ``parent`` that the pattern matches, folders apart, in no order.

    Raises:
        TooManyFolders: the pattern searches too much.
    """
    *folders, last = PurePath(pattern).parts
    if last == "**":
        folders.append(last)
        last = "*"
    for folder in folder_levels(parent, folders)[-1]:
        if not glob.has_magic(last):
            path = os.path.join(folder, last)  # noqa: PTH118 - millions of them
            if is_named(path) and not is_folder(path):
                yield path
            continue
        for entry in entries(folder):
            if _matches(entry.name, last) and not entry.is_folder:
                yield entry.path


def folder_levels(parent: str, parts: Sequence[str]) -> list[list[str]]:
    """Return the folders that each beginning of a pattern's parts leads to, no folder twice.

    Raises:
        TooManyFolders: there are too many.
    """
    levels = [[parent]]
    for number, part in enumerate(parts):
        if part == "**" and number and parts[number - 1] == "**":
            levels.append(levels[-1])
            continue
        found = _all_below(levels[-1]) if part == "**" else _within(levels[-1], part)
        levels.append(list(_distinct(found)))
    return levels


def path_matches(path: PurePath, pattern: str) -> bool:
    """Return whether a relative path matches a pattern; ``**`` is any number of folders."""
    return _parts_match(path.parts, PurePath(pattern).parts)


def _parts_match(parts: Sequence[str], patterns: Sequence[str]) -> bool:
    if not patterns:
        return not parts
    first, *others = patterns
    if first == "**":
        return not others or any(_parts_match(parts[n:], others) for n in range(len(parts) + 1))
    return bool(parts) and fnmatchcase(parts[0], first) and _parts_match(parts[1:], others)


def _within(folders: Iterable[str], part: str) -> Iterator[str]:
    for folder in folders:
        if not glob.has_magic(part):
            path = os.path.join(folder, part)  # noqa: PTH118
            if is_folder(path):
                yield path
            continue
        for entry in entries(folder):
            if _matches(entry.name, part) and entry.is_folder:
                yield entry.path


def _all_below(folders: Iterable[str]) -> Iterator[str]:
    """Yield the folders themselves and all below them but hidden ones, each real folder once."""
    waiting = list(_distinct(folders))
    seen = {_identity(each) for each in waiting}
    for folder in waiting:  # grows meanwhile
        yield folder
        for entry in entries(folder):
            if not entry.name.startswith(".") and entry.is_folder:
                known = _identity(entry.path)
                if known not in seen:
                    seen.add(known)
                    waiting.append(entry.path)


def _distinct(folders: Iterable[str]) -> Iterator[str]:
    seen: set[object] = set()
    for folder in folders:
        known = _identity(folder)
        if known not in seen:
            seen.add(known)
            if len(seen) > MOST_FOLDERS:
                raise TooManyFolders(f"searches more than {MOST_FOLDERS:,} folders")
            yield folder


def _identity(folder: str) -> object:
    return identity(folder) or folder


def _matches(name: str, pattern: str) -> bool:
    """Return whether a name matches; a hidden one only if the pattern begins with a dot."""
    return fnmatchcase(name, pattern) and (not name.startswith(".") or pattern.startswith("."))
