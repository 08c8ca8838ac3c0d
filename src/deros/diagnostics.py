"""Positions, diagnostics and their codes, which all rooms share.

A check never prints and never raises for a fault in a user's text: it yields :class:`Diagnostic`
objects, and the command line or an editor renders them. The codes are declared once, in
:mod:`deros.codes`.
"""

from __future__ import annotations

import enum
import re
from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property

_LONGEST_TEXT = 1000
_END = 300
_END_OF_LINE = re.compile(r"\s*(//[^\n]*)?\n\s*")
_WORD = re.compile(r"\w+")

ANY_NAME = "*"
"""Among the lost words of a source: a declaration without a name, which may be of any name."""


class Severity(enum.Enum):
    """The severity of a finding; errors fail a run, and warnings do under ``--strict``."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


@dataclass(frozen=True, slots=True)
class Code:
    """A kind of finding.

    Attributes:
        name: its stable name, ``DRS201``.
        slug: its name in words, ``unknown-import``.
        title: what it reports, in a few words.
        severity: the severity of its findings.
        reports_absence: whether it says that something is missing, which may be in a statement that
            could not be read.
    """

    name: str
    slug: str
    title: str
    severity: Severity
    reports_absence: bool = False

    def __str__(self) -> str:
        """Return name and slug, as users read it."""
        return f"{self.name} {self.slug}"


ALL_CODES: dict[str, Code] = {}
"""The codes by name: ``DRS317``."""

SLUGS: dict[str, Code] = {}
"""The codes by slug: ``input-without-timeout``."""


def declare(
    number: int,
    slug: str,
    title: str,
    severity: Severity = Severity.ERROR,
    *,
    absence: bool = False,
) -> Code:
    """Declare a code.

    Args:
        number: the digits of its name.
        slug: its name in words, accepted wherever a code is.
        title: what it reports, in a few words.
        severity: the severity of its findings.
        absence: whether its findings say that something is missing.
    """
    code = Code(f"DRS{number:03d}", slug, title, severity, absence)
    assert code.name not in ALL_CODES, f"{code.name} is declared twice"
    assert slug not in SLUGS, f"{slug} is declared twice"
    ALL_CODES[code.name] = SLUGS[slug] = code
    return code


def find(word: str) -> Code | None:
    """Return the code with the name or the slug ``word``, exactly as declared, or ``None``."""
    return ALL_CODES.get(word) or SLUGS.get(word)


class SourceFile:
    """One text file as it was read: its path as the user named it, and its text.

    Identity is what counts: two reads of one path are two sources. Positions in it are character
    offsets; lines and columns (both from 1, columns in characters) are worked out on demand,
    because a model has many more spans than diagnostics.

    Attributes:
        path: as the user named the file.
        text: all of it, also what could not be read.
        lost: the words of the statements that could not be read, see :meth:`mentions_lost`.
    """

    def __init__(self, path: str, text: str) -> None:
        """Store ``text`` read from ``path``."""
        self.path = path
        self.text = text
        self.lost: frozenset[str] = frozenset()

    def mentions_lost(self, name: str) -> bool:
        """Return whether a statement that could not be read mentions ``name``.

        Such a statement may declare the name, use it or connect it: that something seems to be
        missing there follows from the syntax error alone, and is not reported a second time. Of a
        graph name its last part counts.
        """
        return bool(self.lost) and (last_word(name) in self.lost or ANY_NAME in self.lost)

    @cached_property
    def _line_starts(self) -> list[int]:
        starts = [0]
        position = self.text.find("\n")
        while position >= 0:
            starts.append(position + 1)
            position = self.text.find("\n", position + 1)
        return starts

    def line_column(self, offset: int) -> tuple[int, int]:
        """Return line and column, both from 1, of a character offset."""
        line = bisect_right(self._line_starts, offset)
        return line, offset - self._line_starts[line - 1] + 1

    def line_start(self, number: int) -> int:
        """Return the offset of the first character of line ``number`` (from 1), or of the end."""
        starts = self._line_starts
        return starts[number - 1] if number <= len(starts) else len(self.text)

    def line(self, number: int) -> str:
        """Return the text of line ``number`` (from 1) without its line end."""
        starts = self._line_starts
        end = starts[number] if number < len(starts) else len(self.text)
        return self.text[starts[number - 1] : end].rstrip("\r\n")

    def __repr__(self) -> str:
        """Return a form without the text, which is long."""
        return f"SourceFile({self.path!r})"


@dataclass(frozen=True, slots=True)
class Span:
    """A piece of a source: characters ``start`` up to, not including, ``end``."""

    source: SourceFile
    start: int
    end: int

    @property
    def file(self) -> str:
        """The path of the source."""
        return self.source.path

    @property
    def line(self) -> int:
        """The line of the first character, from 1."""
        return self.source.line_column(self.start)[0]

    @property
    def column(self) -> int:
        """The column of the first character, from 1."""
        return self.source.line_column(self.start)[1]

    @property
    def end_line(self) -> int:
        """The line where the span ends, from 1."""
        return self.source.line_column(self.end)[0]

    @property
    def end_column(self) -> int:
        """The column just past the last character, from 1."""
        return self.source.line_column(self.end)[1]

    @property
    def text(self) -> str:
        """The characters themselves."""
        return self.source.text[self.start : self.end]


@dataclass(frozen=True, slots=True)
class Related:
    """Another place that is relevant to a diagnostic, with an explanation."""

    span: Span
    message: str

    def __post_init__(self) -> None:
        """Make the text readable."""
        object.__setattr__(self, "message", _readable(self.message))


@dataclass(frozen=True, slots=True)
class Fix:
    """The hint of a diagnostic as an edit: ``text`` in place of ``span``."""

    span: Span
    text: str


class NearMiss(str):
    """A hint that asks which of some names was meant, and knows them as edits.

    It is the text of the hint. With words before or behind it, it is a text as any other.

    Attributes:
        meant: what may be written instead, the likeliest first.
        written: the part of the finding's place that they replace; all of it if this is empty.
    """

    __slots__ = ("meant", "written")

    meant: tuple[str, ...]
    written: str

    def __new__(cls, text: str, meant: Iterable[str], written: str = "") -> NearMiss:
        """Make the hint ``text``."""
        made = super().__new__(cls, text)
        made.meant = tuple(meant)
        made.written = written
        return made

    def edits(self, place: Span) -> tuple[Fix, ...]:
        """Return an edit for each of the names, or none where it is not plain what they replace.

        Args:
            place: of the finding. Quotes around it stay.
        """
        if self.written:
            words = re.finditer(rf"(?<!\w){re.escape(self.written)}(?!\w)", place.text)
        else:
            words = re.finditer(r'^"?([^\s"]+)"?$', place.text)
        found = [word.span(word.re.groups) for word in words]
        if len(found) != 1:
            return ()
        start, end = (place.start + offset for offset in found[0])
        span = Span(place.source, start, end)
        return tuple(Fix(span, each) for each in self.meant if each != span.text)


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding: the problem, its position, the likely intention, and what to do.

    Where the hint asks for one certain edit, ``fix`` is that edit, for tools that apply it. Where
    it asks which name was meant, ``choices`` has an edit for each: a person chooses. The names that
    it is about are those at its places, and ``subjects`` besides. One that depends on the arguments
    of a system has been found with the values in ``where``, and defaults of others.

    Its texts are shortened if they are very long, as those of :class:`Related` are.
    """

    code: Code
    message: str
    span: Span
    hint: str = ""
    related: tuple[Related, ...] = ()
    severity: Severity = field(default=Severity.ERROR)
    fix: Fix | None = None
    subjects: tuple[str, ...] = ()
    where: tuple[tuple[str, bool | int | float | str], ...] = ()
    choices: tuple[Fix, ...] = ()

    def __post_init__(self) -> None:
        """Make the texts readable."""
        object.__setattr__(self, "message", _readable(self.message))
        object.__setattr__(self, "hint", _readable(str(self.hint)))

    @property
    def is_error(self) -> bool:
        """Whether this finding alone fails a run."""
        return self.severity is Severity.ERROR


def report(
    code: Code,
    message: str,
    span: Span,
    hint: str = "",
    related: tuple[Related, ...] = (),
    fix: Fix | None = None,
    subjects: tuple[str, ...] = (),
) -> Diagnostic:
    """Make a diagnostic with the severity of its code."""
    choices = hint.edits(span) if isinstance(hint, NearMiss) else ()
    return Diagnostic(
        code, message, span, hint, related, code.severity, fix, subjects, choices=choices
    )


def last_word(name: str) -> str:
    """Return the last word of a name: of ``/front/scan`` or ``arm.scan`` it is ``scan``."""
    words = _WORD.findall(name)
    return words[-1] if words else name


def _readable(text: str) -> str:
    """Return the text in one line, in an encodable form, without its middle if it is very long.

    Names and texts of a model come into it as they are, over several lines and with comments at
    their ends, and file names as the system has them.
    """
    if "\n" in text:
        text = _END_OF_LINE.sub(" ", text)
    if len(text) > _LONGEST_TEXT:
        text = f"{text[: _LONGEST_TEXT - _END]} … {text[-_END:]}"
    return encodable(text)


def encodable(text: str) -> str:
    """Return the text with an escape for each half of a character, which no stream takes."""
    return text if text.isascii() else text.encode(errors="backslashreplace").decode()


def in_file_order(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Sort by file, position and code, dropping exact repeats."""
    unique = dict.fromkeys(diagnostics)
    return sorted(unique, key=lambda d: (d.span.file, d.span.start, d.span.end, d.code.name))


def has_errors(diagnostics: Iterable[Diagnostic]) -> bool:
    """Return whether any of the findings is an error."""
    return any(d.is_error for d in diagnostics)
