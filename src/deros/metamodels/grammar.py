"""Properties of grammar expressions: keywords, first tokens, statements."""

from __future__ import annotations

import re
from collections.abc import Iterator

from arpeggio import (
    EndOfFile,
    Optional,
    OrderedChoice,
    ParsingExpression,
    RegExMatch,
    Repetition,
    Sequence,
    StrMatch,
    ZeroOrMore,
)

_LONG_WORD = re.compile(r"[a-z_]{2,}")
_ANY_WORD = "zzyzx"
"""A word that is not a keyword of any language: a token that matches it matches names."""


def is_statement(expression: ParsingExpression) -> bool:
    """Return whether an expression is a statement: it may end in ``;``, or ends in statements."""
    kind = type(expression)
    if kind is OrderedChoice:
        return any(is_statement(node) for node in expression.nodes)
    if kind is not Sequence:
        return False
    last = expression.nodes[-1]
    if type(last) is Optional:
        return isinstance(last.nodes[0], StrMatch) and _sign_of(last.nodes[0]) == ";"
    if isinstance(last, Repetition):
        return not last.sep and is_statement(last.nodes[0])
    return is_statement(last)


def first_tokens(expression: ParsingExpression) -> Iterator[ParsingExpression]:
    """Yield the tokens with which a match of an expression may begin."""
    yield from _first(expression, set())


def _first(expression: ParsingExpression, seen: set[int]) -> Iterator[ParsingExpression]:
    if isinstance(expression, (RegExMatch, StrMatch, EndOfFile)):
        yield expression
        return
    if id(expression) in seen:
        return
    seen.add(id(expression))
    for node in expression.nodes:
        yield from _first(node, seen)
        if type(expression) is not OrderedChoice and not may_be_empty(node):
            break


def may_be_empty(expression: ParsingExpression) -> bool:
    """Return whether an expression matches the empty text."""
    kind = type(expression)
    if kind in (Optional, ZeroOrMore):
        return True
    if kind is Sequence:
        return all(may_be_empty(node) for node in expression.nodes)
    return False


def is_name(token: ParsingExpression) -> bool:
    """Return whether a token matches any word."""
    return matches(token, _ANY_WORD, 0)


def words_of(token: ParsingExpression) -> list[str]:
    """Return the words that a token matches; none for a name."""
    literal = literal_of(token)
    if literal is not None:
        return [literal]
    if not isinstance(token, RegExMatch) or is_name(token):
        return []
    return [word for word in _LONG_WORD.findall(token.to_match) if matches(token, word, 0)]


def literal_of(token: ParsingExpression) -> str | None:
    """Return the text that a token matches, or ``None`` if it matches several."""
    return _sign_of(token) if isinstance(token, (StrMatch, RegExMatch)) else None


def _sign_of(token: ParsingExpression) -> str | None:
    if isinstance(token, EndOfFile):
        return None
    sign: str = token.to_match
    is_literal = not isinstance(token, RegExMatch) or re.fullmatch(r"\w+", sign) is not None
    return sign if is_literal else None


def matches(token: ParsingExpression, text: str, position: int) -> bool:
    """Return whether a token matches at a position."""
    if isinstance(token, EndOfFile):
        return position >= len(text)
    if isinstance(token, RegExMatch):
        return token.regex.match(text, position) is not None
    return text.startswith(token.to_match, position)
