"""The consequences of findings for a run: its exit code, and whether it generates."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from deros import codes
from deros.diagnostics import Diagnostic, Severity
from deros.metamodels.languages import DEROS, language_of

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


def exit_code(diagnostics: Iterable[Diagnostic], *, strict: bool = False) -> int:
    """Return 2 if an input could not be read, else 1 if a finding fails the run, else 0."""
    code = CLEAN
    for diagnostic in diagnostics:
        if diagnostic.code in _UNREADABLE:
            return UNUSABLE
        if diagnostic.is_error or (strict and diagnostic.severity is Severity.WARNING):
            code = FINDINGS
    return code


def blocking_diagnostics(findings: Sequence[Diagnostic], path: str) -> list[Diagnostic]:
    """Return the findings without errors that generating from ``path`` corrects.

    A system is to contain the gates that its rules declare, and those are generated from the rules.
    """
    corrected = codes.CORRECTED_BY_GENERATING if language_of(path) is DEROS else frozenset()
    return [each for each in findings if each.code not in corrected]
