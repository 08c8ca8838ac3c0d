"""Baselines: the accepted warnings of a project, so that a check reports only new ones.

A baseline is a JSON file. Each finding in it has a fingerprint made of its code, its message and
the text that it points at, not of its line, so that it is recognized when lines move. Errors are
never part of a baseline.
"""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deros import codes
from deros.diagnostics import Diagnostic, SourceFile, Span, report
from deros.interfaces.files import read_regular
from deros.validators.findings.hints import unknown_code

_VERSION = 1
_LARGEST = 64 << 20
_KIND = "deros baseline"

Key = tuple[str, str]
"""A file, relative to the folder of the baseline, and a fingerprint in it."""


class Unusable(Exception):  # noqa: N818 - it carries a finding and is not an error of the program
    """The baseline cannot be read or written; ``diagnostic`` says why."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        """Store the finding."""
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


@dataclass(frozen=True, slots=True)
class Entry:
    """One finding of a baseline."""

    file: str
    fingerprint: str
    code: str
    message: str


@dataclass(frozen=True, slots=True)
class Baseline:
    """The content of a baseline.

    Attributes:
        path: its file.
        source: its text, for positions in it.
        checked: the files that were named when it was written, relative to its folder.
        entries: the findings.
    """

    path: Path
    source: SourceFile
    checked: tuple[str, ...]
    entries: tuple[Entry, ...]


@dataclass(frozen=True, slots=True)
class Compared:
    """Findings compared with a baseline.

    Attributes:
        new: the findings that are not in the baseline, and all errors.
        known: the findings that are in it.
        absent: its entries that were not found again, if that is certain.
    """

    new: tuple[Diagnostic, ...]
    known: tuple[Diagnostic, ...]
    absent: tuple[Entry, ...]


def fingerprints(findings: Iterable[Diagnostic]) -> list[str]:
    """Return a text for each finding that is the same when only its line has changed.

    The findings are in file order. Equal ones of one file are numbered.
    """
    seen: Counter[tuple[str, str]] = Counter()
    result = []
    for each in findings:
        parts = (each.code.name, each.message, " ".join(each.span.text.split()))
        said = "\0".join(parts)
        number = seen[each.span.file, said]
        seen[each.span.file, said] += 1
        digest = hashlib.sha256(f"{said}\0{number}".encode(errors="replace"))
        result.append(digest.hexdigest()[:32])
    return result


def read(path: Path) -> Baseline:
    """Read a baseline.

    Raises:
        Unusable: the file cannot be read, or is not a baseline.
    """
    try:
        text = read_regular(path, _LARGEST).decode()
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        hint = "write it with --write-baseline" if isinstance(error, FileNotFoundError) else ""
        raise _unusable(path, f"cannot read the baseline '{path}': {reason}", hint) from error
    try:
        data = json.loads(text)
        if not isinstance(data, dict) or data.get("kind") != _KIND:
            raise _unusable(path, f"'{path}' is not a baseline of deros")
        if data["version"] != _VERSION:
            found = f"has version {data['version']}; the supported version is {_VERSION}"
            message = f"the baseline '{path}' {found}"
            raise _unusable(path, message, "write it again with --write-baseline")
        entries = tuple(
            Entry(
                str(each["file"]),
                str(each["fingerprint"]),
                _code_name(str(each["code"])),
                str(each["message"]),
            )
            for each in data["findings"]
        )
        checked = tuple(map(str, data["checked"]))
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        message = f"'{path}' is not a baseline of deros: {type(error).__name__}: {error}"
        raise _unusable(path, message) from error
    return Baseline(path, SourceFile(str(path), text), checked, entries)


def compare(findings: Sequence[Diagnostic], baseline: Baseline, named: Iterable[str]) -> Compared:
    """Compare findings, in file order, with a baseline.

    An entry counts as absent only if all files of the baseline were checked, and no error may hide
    it.
    """
    root = baseline.path.parent
    left = {(entry.file, entry.fingerprint): entry for entry in baseline.entries}
    new, known = [], []
    for finding, fingerprint in zip(findings, fingerprints(findings), strict=True):
        key = _relative(finding.span.file, root), fingerprint
        if finding.is_error or left.pop(key, None) is None:
            new.append(finding)
        else:
            known.append(finding)
    now = {_relative(each, root) for each in named}
    whole = all(each in now or not (root / each).exists() for each in baseline.checked)
    judged = whole and not any(each.is_error for each in new)
    return Compared(tuple(new), tuple(known), tuple(left.values()) if judged else ())


def absent(entry: Entry, baseline: Baseline) -> Diagnostic:
    """Return the remark that a finding of the baseline no longer occurs."""
    start = max(0, baseline.source.text.find(entry.fingerprint))
    span = Span(baseline.source, start, start + len(entry.fingerprint))
    message = f"{entry.file}: {entry.code} no longer occurs: {entry.message}"
    hint = "write the baseline again with --write-baseline"
    if codes.find(entry.code) is None:
        hint = f"there is no diagnostic '{entry.code}': {unknown_code(entry.code)}"
    return report(codes.ABSENT_FINDING, message, span, hint)


def _code_name(word: str) -> str:
    """Return the name of a code that is written as name or slug; an unknown one as it is."""
    code = codes.find(word)
    return word if code is None else code.name


def write(path: Path, findings: Sequence[Diagnostic], named: Iterable[str]) -> int:
    """Write a baseline of the findings, without errors, and return how many it holds.

    Raises:
        Unusable: the file cannot be written, or another one is in its place.
    """
    if path.exists() or path.is_symlink():
        read(path)
    root = path.parent
    listed = [
        {
            "file": _relative(finding.span.file, root),
            "code": finding.code.name,
            "slug": finding.code.slug,
            "fingerprint": fingerprint,
            "message": finding.message,
        }
        for finding, fingerprint in zip(findings, fingerprints(findings), strict=True)
        if not finding.is_error
    ]
    listed.sort(key=lambda entry: (entry["file"], entry["code"], entry["message"]))
    checked = sorted({_relative(each, root) for each in named})
    data: dict[str, Any] = {"kind": _KIND, "version": _VERSION, "checked": checked}
    text = json.dumps({**data, "findings": listed}, indent=1, ensure_ascii=False) + "\n"
    try:
        with tempfile.TemporaryDirectory(prefix=".deros-", dir=root) as staging:
            staged = Path(staging) / "baseline"
            staged.write_text(text, encoding="utf-8", errors="backslashreplace")
            staged.replace(path)
    except OSError as error:
        message = f"cannot write the baseline '{path}': {error.strerror or error}"
        raise _unusable(path, message) from error
    return len(listed)


def _relative(file: str, root: Path) -> str:
    """Return a path relative to a folder, so that it is the same wherever the check is run."""
    return Path(os.path.relpath(file, root)).as_posix()


def _unusable(path: Path, message: str, hint: str = "") -> Unusable:
    span = Span(SourceFile(str(path), ""), 0, 0)
    return Unusable(report(codes.UNUSABLE_BASELINE, message, span, hint))
