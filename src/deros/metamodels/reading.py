"""From a file to text that a parser can take: decoding, comments, and the depth of nesting."""

from __future__ import annotations

import errno
import re
from pathlib import Path

from deros import codes
from deros.diagnostics import Diagnostic, SourceFile, Span, report

MAX_DEPTH = 100
"""How deep brackets and other nested constructs may go; hand-written models stay below ten."""

_SPECIAL = re.compile(
    r'(?P<text>"(?:\\.|[^"\\\n])*")'
    r"|(?P<comment>//[^\n]*|/\*.*?\*/)"
    r"|(?P<unclosed>/\*)"
    r"|(?P<open>[({\[])"
    r"|(?P<close>[)}\]])",
    re.DOTALL,
)
_NOT_LINE_END = re.compile(r"[^\r\n]")


class Unreadable(Exception):  # noqa: N818 - it carries a finding, and is no fault of the program
    """The text cannot go to a parser; ``diagnostic`` says why."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


def read(path: Path, shown: str, *, streams: bool = True) -> SourceFile:
    """Read a UTF-8 file; ``shown`` is its path as diagnostics name it.

    Without ``streams``, a pipe or a device is refused: it may keep the reader waiting for ever.

    Raises:
        Unreadable: the file cannot be opened, or does not hold text.
    """
    nothing = SourceFile(shown, "")
    start = Span(nothing, 0, 0)
    try:
        if not streams and path.exists() and not (path.is_file() or path.is_dir()):
            raise OSError(errno.EINVAL, "neither a file nor a folder")
        data = path.read_bytes()
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        message = f"cannot read '{shown}': {reason}"
        raise Unreadable(report(codes.UNREADABLE_FILE, message, start)) from error
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        message = f"'{shown}' is not UTF-8 text: byte {error.start}, in line {line}, fits nowhere"
        hint = "save the file with the encoding UTF-8"
        raise Unreadable(report(codes.NOT_UTF8, message, start, hint)) from error
    if "\0" in text:
        message = f"'{shown}' holds a NUL character, so it is no text file"
        raise Unreadable(report(codes.NOT_UTF8, message, start))
    return SourceFile(shown, text)


def prepare(source: SourceFile) -> str:
    """Return the text with its comments blanked out, every other character at its place.

    Raises:
        Unreadable: a comment is not closed, or brackets are nested too deeply to parse.
    """
    text = source.text
    pieces: list[str] = []
    done = 0
    depth = 0
    for found in _SPECIAL.finditer(text):
        kind = found.lastgroup
        if kind == "open":
            depth += 1
            if depth > MAX_DEPTH:
                raise Unreadable(too_deep(Span(source, found.start(), found.end())))
        elif kind == "close":
            depth = max(0, depth - 1)
        elif kind == "comment":
            pieces += (text[done : found.start()], _NOT_LINE_END.sub(" ", found.group()))
            done = found.end()
        elif kind == "unclosed":
            span = Span(source, found.start(), found.end())
            message = "this comment is not closed"
            raise Unreadable(report(codes.SYNTAX_ERROR, message, span, "close it with '*/'"))
    pieces.append(text[done:])
    return "".join(pieces)


def too_deep(span: Span) -> Diagnostic:
    """Make the diagnostic for a place where nesting passes :data:`MAX_DEPTH`."""
    message = f"nested more than {MAX_DEPTH} levels deep"
    return report(codes.NESTED_TOO_DEEPLY, message, span, "split it into named parts")
