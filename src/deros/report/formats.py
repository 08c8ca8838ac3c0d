"""Diagnostics for other programs: JSON, SARIF 2.1.0, and the annotations of GitHub Actions."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any
from urllib.parse import quote

from deros import __version__
from deros.codes import ABSENT_FINDING, ALL_CODES
from deros.diagnostics import Diagnostic, Fix, Severity, Span, encodable, in_file_order
from deros.report.baseline import Compared, Entry, fingerprints
from deros.validators.findings.allowed import Allowance, Allowed

_SARIF_LEVEL = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}
_GITHUB_COMMAND = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "notice"}


def render_json(diagnostics: Sequence[Diagnostic], allowed: Sequence[Allowed] = ()) -> str:
    """Return an array of flat objects; lines and columns count from 1, ends are exclusive.

    Those of ``allowed`` come last and give the reason under ``allowed``.
    """
    objects = [_json_object(d) for d in diagnostics]
    objects += [{**_json_object(each.finding), "allowed": each.by.reason} for each in allowed]
    return json.dumps(objects, indent=2, ensure_ascii=False) + "\n"


def _json_object(diagnostic: Diagnostic) -> dict[str, Any]:
    span, fix = diagnostic.span, diagnostic.fix
    return {
        "file": encodable(span.file),
        "line": span.line,
        "column": span.column,
        "end_line": span.end_line,
        "end_column": span.end_column,
        "severity": diagnostic.severity.value,
        "code": diagnostic.code.name,
        "slug": diagnostic.code.slug,
        "message": diagnostic.message,
        "hint": diagnostic.hint,
        "fix": None
        if fix is None
        else {
            "line": fix.span.line,
            "column": fix.span.column,
            "end_line": fix.span.end_line,
            "end_column": fix.span.end_column,
            "text": fix.text,
        },
    }


def render_sarif(
    diagnostics: Sequence[Diagnostic],
    allowed: Sequence[Allowed] = (),
    compared: Compared | None = None,
) -> str:
    """Return a log of the Static Analysis Results Interchange Format, version 2.1.0 (OASIS).

    With a baseline, it also contains the known findings, marked as such.
    """
    known = set(compared.known) if compared is not None else set()
    # Absent findings have separate results.
    every = [each for each in diagnostics if each.code is not ABSENT_FINDING]
    if known:
        every = in_file_order(known.union(every))
    absent = compared.absent if compared is not None else ()
    used = {d.code.name for d in (*every, *(each.finding for each in allowed))}
    used |= {entry.code for entry in absent if entry.code in ALL_CODES}
    index = {name: position for position, name in enumerate(sorted(used))}
    results = [_sarif_result(d, index[d.code.name]) for d in every]
    for result, finding, fingerprint in zip(results, every, fingerprints(every), strict=True):
        result["partialFingerprints"] = {"deros/v1": fingerprint}
        if compared is not None:
            result["baselineState"] = "unchanged" if finding in known else "new"
    log = {
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [
            {
                "tool": {
                    "driver": {
                        "name": "deros",
                        "version": __version__,
                        "rules": [_sarif_rule(name) for name in sorted(used)],
                    }
                },
                "columnKind": "unicodeCodePoints",
                "results": [
                    *results,
                    *(_sarif_suppressed(each, index[each.finding.code.name]) for each in allowed),
                    *(_sarif_absent(each) for each in absent),
                ],
            }
        ],
    }
    return json.dumps(log, indent=2, ensure_ascii=False) + "\n"


def _sarif_rule(name: str) -> dict[str, Any]:
    code = ALL_CODES[name]
    return {
        "id": name,
        "name": code.slug,
        "shortDescription": {"text": code.title},
        "defaultConfiguration": {"level": _SARIF_LEVEL[code.severity]},
    }


def _sarif_result(diagnostic: Diagnostic, rule_index: int) -> dict[str, Any]:
    text = diagnostic.message
    if diagnostic.hint:
        text = f"{text}\n{diagnostic.hint}"
    result: dict[str, Any] = {
        "ruleId": diagnostic.code.name,
        "ruleIndex": rule_index,
        "level": _SARIF_LEVEL[diagnostic.severity],
        "message": {"text": text},
        "locations": [{"physicalLocation": _sarif_location(diagnostic.span)}],
    }
    if diagnostic.related:
        result["relatedLocations"] = [
            {
                "id": position,
                "physicalLocation": _sarif_location(related.span),
                "message": {"text": related.message},
            }
            for position, related in enumerate(diagnostic.related)
        ]
    if diagnostic.fix is not None:
        result["fixes"] = [_sarif_fix(diagnostic.fix, diagnostic.hint)]
    return result


def _sarif_suppressed(allowed: Allowed, rule_index: int) -> dict[str, Any]:
    suppression = {
        "kind": "inSource" if isinstance(allowed.by, Allowance) else "external",
        "status": "accepted",
        "justification": encodable(allowed.by.reason),
        "location": {"physicalLocation": _sarif_location(allowed.by.span)},
    }
    return {**_sarif_result(allowed.finding, rule_index), "suppressions": [suppression]}


def _sarif_absent(entry: Entry) -> dict[str, Any]:
    return {
        "ruleId": entry.code,
        "message": {"text": entry.message},
        "locations": [{"physicalLocation": {"artifactLocation": {"uri": quote(entry.file)}}}],
        "partialFingerprints": {"deros/v1": entry.fingerprint},
        "baselineState": "absent",
    }


def _sarif_fix(fix: Fix, hint: str) -> dict[str, Any]:
    place = _sarif_location(fix.span)
    replacement = {"deletedRegion": place["region"], "insertedContent": {"text": fix.text}}
    return {
        "description": {"text": hint},
        "artifactChanges": [
            {"artifactLocation": place["artifactLocation"], "replacements": [replacement]}
        ],
    }


def _sarif_location(span: Span) -> dict[str, Any]:
    return {
        "artifactLocation": {"uri": quote(encodable(span.file))},
        "region": {
            "startLine": span.line,
            "startColumn": span.column,
            "endLine": span.end_line,
            "endColumn": span.end_column,
        },
    }


def render_github(diagnostics: Sequence[Diagnostic]) -> str:
    """Return one workflow command a line; GitHub shows them beside the lines of a pull request."""
    return "".join(_github_line(d) for d in diagnostics)


def _github_line(diagnostic: Diagnostic) -> str:
    span = diagnostic.span
    where = {
        "file": encodable(span.file),
        "line": span.line,
        "col": span.column,
        "endLine": span.end_line,
        "endColumn": span.end_column,
        "title": str(diagnostic.code),
    }
    properties = ",".join(f"{name}={_property(str(value))}" for name, value in where.items())
    text = diagnostic.message
    if diagnostic.hint:
        text = f"{text}\n{diagnostic.hint}"
    return f"::{_GITHUB_COMMAND[diagnostic.severity]} {properties}::{_data(text)}\n"


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
