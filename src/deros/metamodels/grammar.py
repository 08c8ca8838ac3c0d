"""Properties of grammar expressions: keywords, first tokens, statements."""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator

from arpeggio import (
    EndOfFile,
    OneOrMore,
    Optional,
    OrderedChoice,
    ParsingExpression,
    RegExMatch,
    Repetition,
    Sequence,
    StrMatch,
    ZeroOrMore,
)

_CHOICE_OF_WORDS = re.compile(r"\(\?:(\w+(?:\|\w+)*)\)(?:\\b)?")
_LONG_WORD = re.compile(r"[a-z_]{2,}")
_ANY_WORD = "zzyzx"
"""A word that is not a keyword of any language: a token that matches it matches names."""


def is_statement(expression: ParsingExpression) -> bool:
    """Return whether an expression is a statement: it may end in ``;``, or ends in statements."""
    return _is_statement(expression, set())


def _is_statement(expression: ParsingExpression, seen: set[int]) -> bool:
    kind = type(expression)
    if id(expression) in seen:  # an operand may end in an operand
        return False
    seen.add(id(expression))
    if kind is OrderedChoice:
        return any(_is_statement(node, seen) for node in expression.nodes)
    if kind is not Sequence:
        return False
    last = expression.nodes[-1]
    if type(last) is Optional:
        return isinstance(last.nodes[0], StrMatch) and _sign_of(last.nodes[0]) == ";"
    if isinstance(last, Repetition):
        return not last.sep and _is_statement(last.nodes[0], seen)
    return _is_statement(last, seen)


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


def words_after(root: ParsingExpression, token: RegExMatch) -> list[str]:
    """Return the keywords that may come after a token in a text of a language, sorted.

    Args:
        root: the grammar of the language.
        token: one of its tokens.
    """
    after: dict[int, dict[int, ParsingExpression]] = {}
    every = expressions(root)
    is_new = True
    while is_new:
        is_new = False
        for expression in every:
            for node, following in _followed(expression, after.get(id(expression), {})):
                known = after.setdefault(id(node), {})
                is_new = is_new or not known.keys() >= following.keys()
                known.update(following)
    found = {word for each in after.get(id(token), {}).values() for word in words_of(each)}
    return sorted(word for word in found if _LONG_WORD.fullmatch(word))


def expressions(root: ParsingExpression) -> list[ParsingExpression]:
    """Return all expressions of a grammar, each once."""
    found = {id(root): root}
    open_ = [root]
    for expression in open_:  # grows meanwhile
        for node in (*expression.nodes, *_separators(expression)):
            if id(node) not in found:
                found[id(node)] = node
                open_.append(node)
    return list(found.values())


def _separators(expression: ParsingExpression) -> list[ParsingExpression]:
    separator = getattr(expression, "sep", None)
    return [] if separator is None else [separator]


def _followed(
    expression: ParsingExpression, after: dict[int, ParsingExpression]
) -> Iterator[tuple[ParsingExpression, dict[int, ParsingExpression]]]:
    """Yield the parts of an expression, each with tokens that may follow it, given those after."""
    if type(expression) is Sequence:
        for node in reversed(expression.nodes):
            yield node, after
            after = {**_begins(node), **(after if may_be_empty(node) else {})}
        return
    again: dict[int, ParsingExpression] = {}
    if isinstance(expression, ZeroOrMore | OneOrMore):
        again = _begins(expression.nodes[0])
        for separator in _separators(expression):
            yield separator, again
            again = _begins(separator)
    for node in expression.nodes:
        yield node, {**after, **again}


def _begins(expression: ParsingExpression) -> dict[int, ParsingExpression]:
    return {id(token): token for token in first_tokens(expression)}


def may_be_empty(expression: ParsingExpression) -> bool:
    """Return whether an expression matches the empty text."""
    kind = type(expression)
    if kind in (Optional, ZeroOrMore):
        return True
    if kind is Sequence:
        return all(may_be_empty(node) for node in expression.nodes)
    return False


def first_characters(expression: ParsingExpression) -> frozenset[str] | None:
    """Return the characters with which a match may begin, ``""`` for the end of the text.

    ``None`` where that is not known of one of its tokens, or where it matches the empty text.
    """
    if may_be_empty(expression):
        return None
    found: set[str] = set()
    for token in first_tokens(expression):
        if isinstance(token, EndOfFile):
            found.add("")
        elif (literal := literal_of(token)) is not None:
            found.add(literal[0])
        elif choice := _CHOICE_OF_WORDS.fullmatch(token.to_match):
            found.update(word[0] for word in choice[1].split("|"))
        else:
            return None
    return frozenset(found)


def is_name(token: ParsingExpression) -> bool:
    """Return whether a token matches any word."""
    return matches(token, _ANY_WORD, 0)


@functools.cache
def words_of(token: ParsingExpression) -> tuple[str, ...]:
    """Return the words that a token matches; none for a name."""
    literal = literal_of(token)
    if literal is not None:
        return (literal,)
    if not isinstance(token, RegExMatch) or is_name(token):
        return ()
    return tuple(word for word in _LONG_WORD.findall(token.to_match) if matches(token, word, 0))


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
