"""What highlighters look for in a text, as regular expressions that Python and editors read."""

from __future__ import annotations

import enum
import functools
from collections.abc import Iterable
from dataclasses import dataclass

from deros.metamodels.keywords import constant_words, keywords, opening_words
from deros.metamodels.languages import Language


class Kind(enum.Enum):
    """A kind of text that is coloured alike."""

    COMMENT = "comment"
    TEXT = "text"
    ARGUMENT = "argument"
    NAME = "graph name"
    NUMBER = "number"
    BLANK = "blanks"
    UNIT = "unit"
    CONSTANT = "constant"
    OPENING = "word that begins a statement"
    WORD = "other word of the language"
    SIGN = "operator"


@dataclass(frozen=True, slots=True)
class Pattern:
    """A regular expression, and what its groups are.

    Attributes:
        kinds: the kind of each group, or of the whole match if there is one kind only. Groups cover
            all of a match.
        regex: of the syntax that Python's ``re`` and Oniguruma share.
    """

    kinds: tuple[Kind, ...]
    regex: str


_NUMBER = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?"
_UNIT = r"[A-Za-z%°µμΩ][\w°]*(?:(?:\*\*|\^)-?\d+)?"
_UNITS = rf"{_UNIT}(?:\s*[*/]\s*{_UNIT})*"


@functools.cache
def patterns(language: Language) -> tuple[Pattern, ...]:
    """Return the patterns of a language, the first of which that matches counts.

    Some words of the languages are names in other places; only the parser tells them apart.
    """
    constants, opening = constant_words(language), opening_words(language)
    words = keywords(language)
    rest = words - constants - opening
    return (
        Pattern((Kind.COMMENT,), r"//[^\n]*|/\*(?:.|\n)*?\*/"),
        Pattern((Kind.TEXT,), r'"[^"\\\n]*(?:\\.[^"\\\n]*)*"'),
        Pattern((Kind.ARGUMENT,), r"\$[A-Za-z_]\w*"),
        Pattern((Kind.NAME,), r"(?<![\w)\]])~?/(?=[\w~])(?:[\w~/]|-(?!>))*"),
        Pattern(
            (Kind.NUMBER, Kind.BLANK, Kind.UNIT),
            rf"(?<![\w.])({_NUMBER})(?:(\s+)((?!(?:{_any(words)})\b){_UNITS}))?(?!\w)",
        ),
        Pattern((Kind.CONSTANT,), _word(constants)),
        Pattern((Kind.OPENING,), _word(opening)),
        Pattern((Kind.WORD,), _word(rest)),
        Pattern((Kind.SIGN,), r"->|[=!<>]=|[=<>+*:-]|/(?![/*])"),
    )


def _any(words: Iterable[str]) -> str:
    return "|".join(sorted(words))


def _word(words: Iterable[str]) -> str:
    """Return what matches words that are no part of a path."""
    return rf"(?<![\w./~$])(?:{_any(words)})(?![\w./])"
