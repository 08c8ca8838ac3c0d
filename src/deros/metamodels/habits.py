"""Habits of other languages: what a text that fits nowhere was meant to say.

Each row has a pattern for the text at the fault, if need be one for the text before it, what to
write instead, and words. A row is offered only if the statement parses on with its edit.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from deros.metamodels.languages import Language

_LOOK_BACK = 400


@dataclass(frozen=True, slots=True)
class Habit:
    """A habit that was recognised: the edit, ``text`` in place of ``start`` to ``end``, and words.

    ``text`` is ``None`` where no edit can be given.
    """

    start: int
    end: int
    text: str | None
    hint: str
    message: str = ""


@dataclass(frozen=True, slots=True)
class _Row:
    r"""One habit.

    Attributes:
        pattern: of the text; the fault lies where its group ``at`` begins, or the whole match.
        text: what to write instead of the match, with its groups as ``\g<name>``; ``None`` if
            that cannot be told.
        hint: in words, with the groups likewise.
        message: what is wrong, if the words for any syntax error do not say it.
        languages: those that have the habit; none for all.
    """

    pattern: re.Pattern[str]
    text: str | None
    hint: str
    message: str = ""
    languages: tuple[Language, ...] = ()


def _row(pattern: str, text: str | None, hint: str, message: str = "", languages: str = "") -> _Row:
    wanted = tuple(each for each in _LANGUAGES if each in languages.split())
    return _Row(re.compile(pattern), text, hint, message, wanted)


_LANGUAGES: tuple[Language, ...] = ("rosnode", "rossystem", "deros")
_RULES = "deros"
_NUMBER = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?"
_OPERAND = r"[\w/.~]+(?:\(\))?"

_ROWS = (
    # Characters
    _row(
        '[\u201c\u201d\u201e\u00ab\u00bb](?P<said>[^"\u201c\u201d\u201e\u00ab\u00bb\n]*)'
        "[\u201c\u201d\u00ab\u00bb]",
        r'"\g<said>"',
        "write plain quotes: '\"'",
        "typographic quotes are no quotes here",
    ),
    _row(
        r"'(?P<said>[^'\"\n]*)'",
        r'"\g<said>"',
        "write double quotes: '\"'",
        "a text stands in double quotes",
    ),
    _row("[\u00a0\u2002-\u200a\u202f\u3000]+", " ", "write a plain blank"),
    _row("[\u2010-\u2014\u2212]", "-", "write a plain '-'"),
    _row("\u2264", "<=", "write '<='"),
    _row("\u2265", ">=", "write '>='"),
    _row("\u2260", "!=", "write '!='"),
    _row("\u2192", "->", "write '->'", languages=_RULES),
    _row("\u2192", "to", "write 'to'", languages="rossystem"),
    _row(
        r"#+(?P<said>[^\n]*)",
        r"//\g<said>",
        "a comment begins with '//'",
        "'#' begins no comment here",
    ),
    _row(
        r"<!--(?P<said>[^\n]*?)-->",
        r"/*\g<said>*/",
        "a comment stands between '/*' and '*/'",
        "'<!--' begins no comment here",
    ),
    _row(r"--(?P<said> [^\n]*)", r"//\g<said>", "a comment begins with '//'"),
    _row(r"to\b", "->", "write '->'", languages=_RULES),
    # Conditions
    _row(r"\|\|?", " or ", "write 'or'", languages=_RULES),
    _row(r"&&?", " and ", "write 'and'", languages=_RULES),
    _row(r"!(?!=)", "not ", "write 'not'", languages=_RULES),
    _row(r"(?i:or)\b", "or", "write 'or': keywords are in lower case", languages=_RULES),
    _row(r"(?i:and)\b", "and", "write 'and': keywords are in lower case", languages=_RULES),
    _row(r"(?i:not)\b", "not", "write 'not': keywords are in lower case", languages=_RULES),
    _row(r"NOT[ ]+(?P<at>)", "not ", "write 'not': keywords are in lower case", languages=_RULES),
    _row(r"(?:===|:=)", "=", "write '='", languages=_RULES),
    _row(r"<>|~=|/=", "!=", "write '!='", languages=_RULES),
    _row(r"=[ ]*(?P<at>)(?P<sign>[<>])", r"\g<sign>=", r"write '\g<sign>='", languages=_RULES),
    _row(r"is\s+not\b", "!=", "write '!='", languages=_RULES),
    _row(r"is\b", "=", "write '='", languages=_RULES),
    _row(r"(?:equals|eq)\b", "=", "write '='", languages=_RULES),
)


def habits(text: str, position: int, start: int, language: Language) -> Iterator[Habit]:
    """Yield the habits that explain why a text fits nowhere at a position.

    Args:
        text: the whole text.
        position: where it fits nowhere.
        start: where its statement begins.
        language: of the text.
    """
    for row in _ROWS:
        if row.languages and language not in row.languages:
            continue
        match = _match(row.pattern, text, position, start)
        if match is not None and row.hint:
            yield Habit(
                match.start(),
                match.end(),
                None if row.text is None else match.expand(row.text),
                match.expand(row.hint),
                match.expand(row.message),
            )


def _match(pattern: re.Pattern[str], text: str, position: int, start: int) -> re.Match[str] | None:
    """Match a pattern whose group ``at``, or whose start, is at a position."""
    if "at" not in pattern.groupindex:
        return pattern.match(text, position)
    begin = max(start, position - _LOOK_BACK)
    found = (each for each in pattern.finditer(text, begin) if each.start("at") >= position)
    match = next(found, None)
    return match if match is not None and match.start("at") == position else None
