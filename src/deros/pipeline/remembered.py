"""What earlier checks found, for as long as everything that they rest on is the same.

A check asks the file system only by :mod:`deros.interfaces.files`. What it found is kept with all
questions and answers, and holds again if each of them has the same answer, deros and the libraries
around it are the same, and so is what the check was asked to do. Content is compared, not times.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deros.diagnostics import Diagnostic, Fix, Related, Severity, SourceFile, Span, find
from deros.interfaces.files import Recorded, answer_again, read_regular
from deros.pipeline.caches import caches

if TYPE_CHECKING:
    from deros.validators.findings.allowed import Allowance, Allowed, ProjectAllowance

_FORMAT = 1
_LARGEST = 16 << 20
_MOST_FILES = 64
_VARIABLES = ("AMENT_PREFIX_PATH",)
_LIBRARIES = ("site-packages", "dist-packages")


@dataclass(frozen=True, slots=True)
class Found:
    """The findings of a check.

    Attributes:
        findings: the findings to report.
        allowed: the findings that are allowed.
        files: how many files were checked.
        named: the models that were named, alone or by their folder.
    """

    findings: Sequence[Diagnostic]
    allowed: Sequence[Allowed]
    files: int
    named: Sequence[str]


class Memory:
    """The findings of the last check of some files, as they were when this was made.

    A check that is remembered has run since: what changes deros meanwhile is no part of it.
    """

    def __init__(self, files: Sequence[str], interfaces: Sequence[Path]) -> None:
        """Look for the place of the findings of these files, with these interfaces."""
        self._path = _path(files, interfaces)
        self._state = "" if self._path is None else _state()

    def recall(self) -> Found | None:
        """Return what the last check of the same files found, if that still holds."""
        if self._path is None:
            return None
        try:
            digest, _, body = read_regular(self._path, _LARGEST).decode().partition("\n")
            if digest != _digest(body):
                return None
            kept = json.loads(body)
            if kept["state"] != self._state:
                return None
            if any(answer_again(tuple(asked)) != answer for *asked, answer in kept["answers"]):
                return None
            found = _Reader(kept["sources"]).found(kept)
            # Those asked last are kept longest.
            self._path.touch()
            return found
        except (OSError, ValueError, KeyError, TypeError, IndexError):
            return None  # damaged, or of another version

    def remember(self, answers: Recorded, found: Found) -> None:
        """Keep what a check found; where that is not possible, the next one has to do it again."""
        path = self._path
        if path is None:
            return
        writer = _Writer()
        kept = {
            "state": self._state,
            "answers": [[*asked, answer] for asked, answer in answers.items()],
            **writer.found(found),
            "sources": writer.sources,
        }
        body = json.dumps(kept, separators=(",", ":"))
        text = f"{_digest(body)}\n{body}"
        if len(text) > _LARGEST:
            return
        with contextlib.suppress(OSError):
            with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False) as stream:
                stream.write(text)
            os.replace(stream.name, path)  # noqa: PTH105 - a path and a name
            _clear(path.parent)


def _clear(folder: Path) -> None:
    """Keep the newest files only."""
    files = sorted(folder.iterdir(), key=lambda each: each.stat().st_mtime_ns, reverse=True)
    for each in files[_MOST_FILES:]:
        each.unlink()


# What a check rests on besides files --------------------------------------------------------------


def _path(files: Sequence[str], interfaces: Sequence[Path]) -> Path | None:
    """Return where the findings of a check are kept; ``None`` without a place for that."""
    try:
        asked = [os.getcwd(), *files, "", *map(str, interfaces)]  # noqa: PTH109 - as text
    except OSError:  # a folder that was removed
        return None
    place = caches()
    if place is None:
        return None
    folder = place / "check"
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError:  # nothing can be kept
        return None
    return folder / _digest(json.dumps(asked))


def _state() -> str:
    """Return what differs if deros, its libraries or its environment do."""
    package = Path(__file__).parents[1]
    return _digest(
        json.dumps(
            [
                _FORMAT,
                sys.version,
                sys.prefix,
                [os.environ.get(name) for name in _VARIABLES],
                [[each, _time(each)] for each in sys.path if each.endswith(_LIBRARIES)],
                [str(package), *_times(str(package))],
            ]
        )
    )


def _time(path: str) -> int:
    try:
        return os.stat(path).st_mtime_ns  # noqa: PTH116 - many
    except OSError:
        return 0


def _times(folder: str) -> Iterator[tuple[str, int, int]]:
    with os.scandir(folder) as listed:
        entries = sorted(listed, key=lambda each: each.name)
    for each in entries:
        if each.is_dir():
            if each.name != "__pycache__":
                yield from _times(each.path)
        else:
            status = each.stat()
            yield each.path, status.st_mtime_ns, status.st_size


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode(errors="surrogateescape")).hexdigest()


# Findings as JSON ---------------------------------------------------------------------------------


class _Writer:
    """Writes findings, and collects the sources that they show a line of."""

    def __init__(self) -> None:
        self.sources: list[list[str]] = []
        self._numbers: dict[int, int] = {}

    def found(self, found: Found) -> dict[str, Any]:
        return {
            "findings": [self._finding(each) for each in found.findings],
            "allowed": [[self._finding(each.finding), self._by(each.by)] for each in found.allowed],
            "files": found.files,
            "named": list(found.named),
        }

    def _finding(self, found: Diagnostic) -> list[Any]:
        return [
            found.code.name,
            found.message,
            self._span(found.span),
            found.hint,
            [[self._span(each.span), each.message] for each in found.related],
            found.severity.value,
            None if found.fix is None else self._fix(found.fix),
            list(found.subjects),
            [list(each) for each in found.where],
            [self._fix(each) for each in found.choices],
        ]

    def _fix(self, fix: Fix) -> list[Any]:
        return [self._span(fix.span), fix.text]

    def _by(self, by: Allowance | ProjectAllowance) -> list[Any]:
        from deros.validators.findings.allowed import Allowance

        span = self._span(by.span)
        if isinstance(by, Allowance):
            return [by.code, by.line, by.reason, span]
        return [by.code, by.pattern, by.reason, span, str(by.root)]

    def _span(self, span: Span) -> list[int]:
        number = self._numbers.setdefault(id(span.source), len(self.sources))
        if number == len(self.sources):
            self.sources.append([span.source.path, span.source.text])
        return [number, span.start, span.end]


class _Reader:
    """Reads what :class:`_Writer` wrote."""

    def __init__(self, sources: list[list[str]]) -> None:
        self._sources = [SourceFile(path, text) for path, text in sources]

    def found(self, kept: dict[str, Any]) -> Found:
        return Found(
            [self._finding(each) for each in kept["findings"]],
            [self._allowed(*each) for each in kept["allowed"]],
            kept["files"],
            kept["named"],
        )

    def _finding(self, kept: list[Any]) -> Diagnostic:
        name, message, span, hint, related, severity, fix, subjects, where, choices = kept
        code = find(name)
        if code is None:
            raise ValueError(name)
        return Diagnostic(
            code,
            message,
            self._span(span),
            hint,
            tuple(Related(self._span(where), what) for where, what in related),
            Severity(severity),
            None if fix is None else self._fix(*fix),
            tuple(subjects),
            tuple((name, value) for name, value in where),
            tuple(self._fix(*each) for each in choices),
        )

    def _fix(self, span: list[int], text: str) -> Fix:
        return Fix(self._span(span), text)

    def _allowed(self, finding: list[Any], by: list[Any]) -> Allowed:
        from deros.validators.findings.allowed import Allowance, Allowed, ProjectAllowance

        code, place, reason, span, *root = by
        allowance: Allowance | ProjectAllowance
        if root:
            allowance = ProjectAllowance(code, place, reason, Path(root[0]), self._span(span))
        else:
            allowance = Allowance(code, place, reason, self._span(span))
        return Allowed(self._finding(finding), allowance)

    def _span(self, kept: list[int]) -> Span:
        number, start, end = kept
        return Span(self._sources[number], start, end)
