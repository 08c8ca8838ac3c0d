"""Which files an ``import`` or ``use`` statement means."""

from __future__ import annotations

import glob
import os
from pathlib import Path, PurePath

from deros import codes
from deros.diagnostics import Diagnostic, Span, report
from deros.interfaces.names import did_you_mean, near


def find_files(
    importer: str, pattern: str, span: Span, suffixes: tuple[str, ...]
) -> tuple[str, ...] | Diagnostic:
    """Return the files that ``pattern``, a path or a glob, means in the file ``importer``.

    Files found by a glob come sorted by name; those of other suffixes, and the importing file itself,
    are not meant. A path that leads to no file of one of the ``suffixes`` is a diagnostic.
    """
    path = os.path.normpath(Path(importer).parent / pattern)
    if glob.has_magic(pattern) and not os.path.lexists(path):
        importing = os.path.realpath(importer)
        found = sorted(
            each
            for each in glob.glob(path, recursive=True)
            if each.endswith(suffixes) and os.path.realpath(each) != importing
        )
        if found:
            return tuple(map(shown_path, found))
        message = f"no file matches '{pattern}'"
        return report(codes.UNKNOWN_IMPORT, message, span)
    if not pattern.endswith(suffixes):
        message = (
            f"'{pattern}' cannot be imported here: its name does not end in {' or '.join(suffixes)}"
        )
        return report(codes.UNKNOWN_LANGUAGE, message, span)
    if not os.path.isfile(path):
        message = f"there is no file '{pattern}'"
        return report(codes.UNKNOWN_IMPORT, message, span, _hint(path, suffixes))
    return (shown_path(path),)


def shown_path(path: str) -> str:
    """Return a path as diagnostics show it: relative to the current directory when it is below it."""
    if os.path.isabs(path):
        relative = os.path.relpath(path)
        if not relative.startswith(os.pardir):
            path = relative
    return PurePath(path).as_posix()


def _hint(path: str, suffixes: tuple[str, ...]) -> str:
    folder = os.path.dirname(path) or os.curdir
    try:
        names = [name for name in os.listdir(folder) if name.endswith(suffixes)]
    except OSError:
        return f"there is no folder '{shown_path(folder)}' either"
    return did_you_mean(near(os.path.basename(path), sorted(names)))
