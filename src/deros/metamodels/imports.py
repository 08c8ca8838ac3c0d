"""The files of an ``import`` or ``use`` statement."""

from __future__ import annotations

import glob
import os
from pathlib import Path, PurePath

from deros import codes
from deros.diagnostics import Diagnostic, Span, report
from deros.interfaces.files import entries, is_file, is_folder, real_path
from deros.metamodels.globbing import TooManyFolders, folder_levels, matching_files
from deros.names.names import did_you_mean, near

LIBRARY = "deros:"
"""What the paths of files begin with that come with deros."""

_LIBRARY_FOLDER = Path(__file__).with_name("library")


def find_files(
    importer: str, pattern: str, span: Span, suffixes: tuple[str, ...]
) -> tuple[str, ...] | Diagnostic:
    """Return the files that ``pattern``, a path or a glob, names in the file ``importer``.

    Files found by a glob come sorted by name; those of other suffixes, and the importing file
    itself, are left out. A path to no file, or to one of another suffix, is a diagnostic.
    ``deros:NAME`` is a file that comes with deros.
    """
    if pattern.startswith(LIBRARY):
        return _find_in_library(pattern.removeprefix(LIBRARY), span)
    path = os.path.normpath(Path(importer).parent / pattern)
    if glob.has_magic(pattern) and not is_file(path):
        importing = real_path(importer)
        try:
            found = sorted(
                os.path.normpath(each)
                for each in matching_files(str(Path(importer).parent), pattern)
                if each.endswith(suffixes) and real_path(each) != importing
            )
        except TooManyFolders as error:
            return report(codes.UNKNOWN_IMPORT, f"'{pattern}' {error}", span, "name the folder")
        if found:
            return tuple(map(shown_path, found))
        return report(
            codes.UNKNOWN_IMPORT, f"no file matches '{pattern}'", span, _alike(importer, pattern)
        )
    if not pattern.endswith(suffixes):
        wanted = " or ".join(suffixes)
        message = f"'{pattern}' cannot be imported here: its name does not end in {wanted}"
        return report(codes.UNKNOWN_LANGUAGE, message, span)
    if not is_file(path):
        message = f"there is no file '{pattern}'"
        hint = _alike(importer, pattern) or _hint(Path(path), suffixes)
        return report(codes.UNKNOWN_IMPORT, message, span, hint)
    return (shown_path(path),)


def listed_folders(importer: str, pattern: str) -> tuple[str, ...]:
    """Return the folders whose content decides which files ``pattern`` names in ``importer``.

    There are none for a path; for a glob, those where a new file or folder may match.
    """
    parent = Path(importer).parent
    if (
        pattern.startswith(LIBRARY)
        or not glob.has_magic(pattern)
        or is_file(os.path.normpath(parent / pattern))
    ):
        return ()
    parts = Path(pattern).parts
    first = next(number for number, part in enumerate(parts) if glob.has_magic(part))
    found: dict[str, None] = {}
    try:
        levels = folder_levels(str(parent), parts[:-1])
    except TooManyFolders:
        return ()
    for folders in levels[first:]:
        found.update((shown_path(os.path.normpath(each)), None) for each in sorted(folders))
    return tuple(found)


def library_files() -> list[str]:
    """Return the paths, as imports write them, of the files that come with deros."""
    return sorted(f"{LIBRARY}{each.name}" for each in entries(_LIBRARY_FOLDER))


def _find_in_library(name: str, span: Span) -> tuple[str, ...] | Diagnostic:
    known = library_files()
    if LIBRARY + name in known:
        return (shown_path(str(_LIBRARY_FOLDER / name)),)
    message = f"no file '{name}' comes with deros"
    meant = near(name, [each.removeprefix(LIBRARY) for each in known])
    hint = did_you_mean([LIBRARY + each for each in meant]) or f"there are: {', '.join(known)}"
    return report(codes.UNKNOWN_IMPORT, message, span, hint)


def shown_path(path: str) -> str:
    """Return a path as diagnostics show it: relative where it lies below the current directory."""
    if Path(path).is_absolute():
        relative = os.path.relpath(path)
        if not relative.startswith(os.pardir):
            path = relative
    return PurePath(path).as_posix()


def _alike(importer: str, pattern: str) -> str:
    """Return a hint with folders for the first one in ``pattern`` that does not exist."""
    folder, parts = Path(importer).parent, PurePath(pattern).parts
    for number, part in enumerate(parts[:-1]):
        if glob.has_magic(part):
            return ""
        if is_folder(folder / part):
            folder /= part
            continue
        others = near(part, [each.name for each in entries(folder) if each.is_folder])
        meant = (PurePath(*parts[:number], each, *parts[number + 1 :]) for each in others)
        return did_you_mean([each.as_posix() for each in meant])
    return ""


def _hint(path: Path, suffixes: tuple[str, ...]) -> str:
    names = [each.name for each in entries(path.parent)]
    if not is_folder(path.parent):
        return f"its folder '{shown_path(str(path.parent))}' does not exist either"
    alike = near(path.name, (name for name in names if name.endswith(suffixes)))
    return did_you_mean(alike, path.name)
