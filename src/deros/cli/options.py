"""Options and exit codes that several commands share."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import click

from deros import codes
from deros.diagnostics import Diagnostic, Severity

CLEAN = 0
FINDINGS = 1
UNUSABLE = 2

_UNREADABLE = frozenset(
    {
        codes.UNREADABLE_FILE,
        codes.NOT_UTF8,
        codes.UNKNOWN_LANGUAGE,
        codes.FILE_TOO_LARGE,
        codes.UNUSABLE_BASELINE,
        codes.UNREADABLE_PROJECT,
    }
)

Command = TypeVar("Command", bound=Callable[..., Any])


def interfaces_option(command: Command) -> Command:
    """Add ``--interfaces PATH``, which may be given several times."""
    option = click.option(
        "--interfaces",
        "interfaces",
        multiple=True,
        metavar="PATH",
        type=click.Path(exists=True, file_okay=False, path_type=Path),
        help="Folder with .msg, .srv and .action files of packages; may be given several times.",
    )
    return option(command)


def exit_code(diagnostics: Iterable[Diagnostic], *, strict: bool = False) -> int:
    """Return 2 if an input could not be read, else 1 if a finding fails the run, else 0."""
    code = CLEAN
    for diagnostic in diagnostics:
        if diagnostic.code in _UNREADABLE:
            return UNUSABLE
        if diagnostic.is_error or (strict and diagnostic.severity is Severity.WARNING):
            code = FINDINGS
    return code


def in_the_way_of_generating(findings: Sequence[Diagnostic], path: str) -> list[Diagnostic]:
    """Return the findings without those that only what ``path`` generates can mend.

    A system is to contain the gates that its rules declare, and those are generated from the rules.
    """
    mended = codes.MENDED_AFTER_GENERATION if path.endswith(".deros") else frozenset()
    return [each for each in findings if each.code not in mended]
