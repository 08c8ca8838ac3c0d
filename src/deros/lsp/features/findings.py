"""Findings while typing, and their own edits as quick fixes."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator

from lsprotocol import types

from deros.diagnostics import Diagnostic, Fix, Severity
from deros.lsp.analysis import Analysis
from deros.lsp.places import Places, uri_of

_SEVERITIES = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    Severity.INFO: types.DiagnosticSeverity.Information,
}


def published(places: Places, found: Diagnostic) -> types.Diagnostic:
    """Return a finding as editors show it: the texts are those of the command line."""
    message = found.message if not found.hint else f"{found.message}\n{found.hint}"
    related = [
        types.DiagnosticRelatedInformation(places.location(each.span), each.message)
        for each in found.related
    ]
    return types.Diagnostic(
        places.range(found.span),
        message,
        _SEVERITIES[found.severity],
        code=found.code.name,
        source="deros",
        related_information=related or None,
    )


def by_file(findings: Iterable[Diagnostic]) -> dict[str, list[Diagnostic]]:
    """Return findings by the absolute path of their file."""
    files: dict[str, list[Diagnostic]] = {}
    for each in findings:
        files.setdefault(os.path.abspath(each.span.file), []).append(each)  # noqa: PTH100
    return files


def quick_fixes(
    places: Places, analysis: Analysis, asked: types.Range
) -> Iterator[types.CodeAction]:
    """Yield the edits of the findings at a range; of each the likeliest first, and preferred."""
    start = places.offset(analysis.source, asked.start)
    end = places.offset(analysis.source, asked.end)
    for each in analysis.findings:
        if each.span.source is not analysis.source:
            continue
        if each.span.start <= end and start <= each.span.end:
            for number, fix in enumerate(_fixes(each)):
                edit = types.TextEdit(places.range(fix.span), fix.text)
                yield types.CodeAction(
                    _title(fix),
                    types.CodeActionKind.QuickFix,
                    diagnostics=[published(places, each)],
                    is_preferred=number == 0,
                    edit=types.WorkspaceEdit({uri_of(fix.span.file): [edit]}),
                )


def _fixes(found: Diagnostic) -> list[Fix]:
    """Return the certain edit of a finding, and those that a person chooses among."""
    certain = [] if found.fix is None else [found.fix]
    return list(dict.fromkeys([*certain, *found.choices]))


def _title(fix: Fix) -> str:
    text, old = fix.text.strip(), fix.span.text.strip()
    if not text:
        return f"Remove '{old}'"
    return f"Replace '{old}' by '{text}'" if old else f"Insert '{text}'"
