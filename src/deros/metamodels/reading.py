"""Reading of files for the parsers: decoding, comments, and the depth of nesting."""

from __future__ import annotations

import errno
import gc
import re
import sys
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from deros import codes
from deros.diagnostics import Diagnostic, SourceFile, Span, report
from deros.interfaces.files import read_regular
from deros.interfaces.types import MOST_DIGITS
from deros.names.names import not_text

MAX_DEPTH = 100
"""The greatest depth of nested constructs; hand-written models stay below ten."""

_FRAMES_TO_PARSE = 20_000

_SPECIAL = re.compile(
    r'(?P<text>"[^"\\\n]*(?:\\.[^"\\\n]*)*")'
    r"|(?P<comment>//[^\n]*|/\*.*?\*/)"
    r"|(?P<unclosed>/\*)"
    r"|(?P<open>[({\[])"
    r"|(?P<close>[)}\]])",
    re.DOTALL,
)
DIRECTIVE = re.compile(r"(?://+|/\*+)\s*(deros\s*:)\s*")
"""How a comment begins that speaks to deros, about its line or the next one."""

LARGEST_MODEL = 4 << 20
"""The largest model file in bytes: some thirty thousand lines, which take seconds."""

LARGEST_STREAM = 256 << 20
"""The largest size in bytes of other inputs: traces of hours."""

_LONGEST_WORD = 255
_LONG_WORD = re.compile(rf"\w{{{_LONGEST_WORD + 1},}}")
_LONG_CHAIN = re.compile(rf"(?:-\s*){{{MAX_DEPTH + 1}}}|(?:\bnot\s+){{{MAX_DEPTH + 1}}}")
_CHOICE = re.compile(r"\b(?P<inner>(?:then|else)\s+)?if\b")
_MANY_SIGNS = re.compile(rf"-(?:\s*-){{{MAX_DEPTH}}}")
_MANY_NOT = re.compile(rf"not\s+(?:not\s+){{{MAX_DEPTH}}}")
_INNER_IF = re.compile(r"then\s+if\b"), re.compile(r"else\s+if\b")
_QUOTED = re.compile(r'"[^"\\\n]*(?:\\.[^"\\\n]*)*"')
_NOT_LINE_END = re.compile(r"[^\r\n]")


class Unreadable(Exception):  # noqa: N818 - it carries a finding and is not an error of the program
    """The text cannot be parsed; ``diagnostic`` says why."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


def read(path: Path, shown: str, *, streams: bool = True) -> SourceFile:
    """Read a UTF-8 file; ``shown`` is its path as diagnostics name it.

    Without ``streams``, pipes and devices are rejected, because they may block for ever.

    Raises:
        Unreadable: the file cannot be opened, is too large, or does not hold text.
    """
    nothing = SourceFile(shown, "")
    start = Span(nothing, 0, 0)
    most = LARGEST_STREAM if streams else LARGEST_MODEL
    try:
        data = _read_stream(path, most) if streams else read_regular(path, most)
    except (OSError, ValueError) as error:
        if isinstance(error, OSError) and error.errno == errno.EFBIG:
            message = f"'{shown}' is larger than {most >> 20} MB"
            hint = (
                "split it into several files, and import them"
                if not streams
                else "cut it into parts"
            )
            raise Unreadable(report(codes.FILE_TOO_LARGE, message, start, hint)) from error
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        message = f"cannot read '{shown}': {reason}"
        raise Unreadable(report(codes.UNREADABLE_FILE, message, start)) from error
    return decoded(data, shown)


def decoded(data: bytes, shown: str) -> SourceFile:
    """Return what a file or a stream holds as text; ``shown`` is its name in diagnostics.

    Raises:
        Unreadable: it is not UTF-8 text.
    """
    start = Span(SourceFile(shown, ""), 0, 0)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        message = f"'{shown}' is not UTF-8 text: byte {error.start}, in line {line}, is invalid"
        hint = "save the file with the encoding UTF-8"
        raise Unreadable(report(codes.NOT_UTF8, message, start, hint)) from error
    if "\0" in text:
        message = f"'{shown}' contains a NUL character, so it is not a text file"
        raise Unreadable(report(codes.NOT_UTF8, message, start))
    return SourceFile(shown, text)


def _read_stream(path: Path, most: int) -> bytes:
    """Read a file or stream up to the size limit."""
    with path.open("rb") as stream:
        data = stream.read(most + 1)
    if len(data) > most:
        raise OSError(errno.EFBIG, "too large")
    return data


def prepare(source: SourceFile) -> str:
    """Return the text with its comments blanked out, every other character at its place.

    Raises:
        Unreadable: a comment is not closed, brackets, signs, ``not`` or ``if`` are nested too
            deeply to parse, a word or number is longer than any, or a character has no place in a
            text.
    """
    text = source.text
    if found := not_text(text):
        raise Unreadable(forbidden_character(found[0], Span(source, found.start(), found.end())))
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
    prepared = "".join(pieces)
    _check_words(source, prepared)
    _check_chains(source, prepared)
    return prepared


def comments(source: SourceFile) -> Iterator[Span]:
    """Yield the place of each closed comment in a text, as :func:`prepare` finds them."""
    for found in _SPECIAL.finditer(source.text):
        if found.lastgroup == "comment":
            yield Span(source, found.start(), found.end())


def _check_words(source: SourceFile, text: str) -> None:
    """Reject words outside quotes that are longer than any name, before they are converted.

    Whole numbers would be, too, where Python converts them.
    """
    if _LONG_WORD.search(text) is None:
        return
    for found in _LONG_WORD.finditer(_without_quotes(text)):
        span = Span(source, found.start(), found.end())
        if not found[0][0].isdecimal():
            message = (
                f"a name of {len(found[0])} characters is longer than the limit of {_LONGEST_WORD}"
            )
            raise Unreadable(report(codes.NAME_TOO_LONG, message, span, "choose a shorter name"))
        if len(found[0]) > MOST_DIGITS:
            raise Unreadable(report(codes.SYNTAX_ERROR, "number out of range", span))


def _check_chains(source: SourceFile, text: str) -> None:
    """Reject what is nested without brackets: ``- - x``, ``not not p``, ``else if p then …``."""
    if not _may_have_chains(text):
        return
    text = _without_quotes(text)
    deepest = _LONG_CHAIN.search(text)
    nested = 0
    for found in _CHOICE.finditer(text):
        nested = nested + 1 if found["inner"] else 0
        if nested > MAX_DEPTH:
            deepest = found
            break
    if deepest is not None:
        raise Unreadable(too_deep(Span(source, deepest.start(), deepest.end())))


def _may_have_chains(text: str) -> bool:
    """Return whether a text has a long chain, perhaps in quotes.

    Every model is asked this. Expressions that begin with a fixed character take a thirtieth of
    the time of those that tell the place.
    """
    return (
        _MANY_SIGNS.search(text) is not None
        or _MANY_NOT.search(text) is not None
        or sum(len(each.findall(text)) for each in _INNER_IF) > MAX_DEPTH
    )


def _without_quotes(text: str) -> str:
    return _QUOTED.sub(lambda quoted: " " * len(quoted[0]), text)


def forbidden_character(character: str, span: Span) -> Diagnostic:
    """Return the diagnostic for a forbidden character, written as such or as an escape."""
    name = unicodedata.name(character, "control character").lower()
    if "\ud800" <= character <= "\udfff":
        name = "unpaired surrogate"
    message = f"the character U+{ord(character):04X} ({name}) is not allowed in a text"
    return report(codes.FORBIDDEN_CHARACTER, message, span, "remove it")


def too_deep(span: Span) -> Diagnostic:
    """Return the diagnostic for nesting deeper than :data:`MAX_DEPTH`."""
    message = f"nested more than {MAX_DEPTH} levels deep"
    return report(codes.NESTED_TOO_DEEPLY, message, span, "split it into named parts")


@contextmanager
def room_to_parse() -> Iterator[None]:
    """Raise the recursion limit for nested models, and suspend garbage collection.

    A parse makes objects by the hundred thousand and hardly any garbage: collections would only
    walk the growing model again and again.
    """
    limit = sys.getrecursionlimit()
    collects = gc.isenabled()
    gc.disable()
    sys.setrecursionlimit(max(limit, _FRAMES_TO_PARSE))
    try:
        yield
    finally:
        sys.setrecursionlimit(limit)
        if collects:
            gc.enable()
