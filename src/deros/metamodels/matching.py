"""A fast implementation of the parsers that textX builds from grammars.

Arpeggio, textX's parser, raises an exception for every alternative that does not match, and looks
for a comment before every token. It takes three and a half times as long as the functions made here
from the very same parser expressions. They yield the very same parse tree, except that the value of
a token is a :class:`Token`, which knows its place. Where they find no match,
:mod:`deros.metamodels.recovery.recovery` says what is wrong.

Prepared text is parsed, see :func:`deros.metamodels.reading.prepare`: its comments are blank.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from arpeggio import (
    EndOfFile,
    NonTerminal,
    OneOrMore,
    Optional,
    OrderedChoice,
    ParsingExpression,
    RegExMatch,
    Repetition,
    Sequence,
    StrMatch,
    Terminal,
    ZeroOrMore,
)

from deros.metamodels.grammar import first_characters
from deros.metamodels.repaired_text import RepairedText, restore_places

Matcher = Callable[[str, int, list[Any]], int]
"""Matches a text at a non-blank position and appends the parse tree to the list.

It returns the position of the next non-blank character, or -1, and then anything appended is
to be thrown away.
"""

_skip_blanks = re.compile(r"[\t\n\r ]*").match


class DoesNotParse(Exception):  # noqa: N818 - it is the answer of a parser
    """A text does not conform to the grammar."""


class Token(str):
    """A piece of a model's text; ``start`` is the offset of its first character."""

    __slots__ = ("start",)
    start: int

    @property
    def end(self) -> int:
        """The offset just past the last character."""
        return self.start + len(self)


class _Leaf(Terminal):  # type: ignore[misc]
    def __init__(self, rule: Any, position: int, value: str) -> None:
        self.rule = rule
        self.rule_name = rule.rule_name
        self.position = position
        self.value = value


class _Branch(NonTerminal):  # type: ignore[misc]
    end: int | None = None
    """Where it ends, once an element has been made of it."""

    def __init__(self, rule: Any, nodes: list[Any]) -> None:
        list.__init__(self, nodes)
        self.rule = rule
        self.rule_name = rule.rule_name
        self.position = nodes[0].position


class Parser:
    """Makes the parse trees of one grammar."""

    def __init__(self, grammar: ParsingExpression) -> None:
        """Make the matchers of all expressions.

        Raises:
            TypeError: the grammar uses an expression that has no matcher.
        """
        self._match = _Compiler().matcher(grammar)

    def parse(self, text: str) -> Any:
        """Return the parse tree of prepared text.

        Raises:
            DoesNotParse: it has a syntax error.
        """
        found: list[Any] = []
        if self._match(text, _skip_blanks(text).end(), found) < 0:  # type: ignore[union-attr]
            raise DoesNotParse
        if isinstance(text, RepairedText) and text.edits:
            restore_places(found[0], text)
        return found[0]


class _Compiler:
    """Makes one matcher for each parser expression; expressions refer to each other in circles."""

    def __init__(self) -> None:
        self._matchers: dict[int, Matcher] = {}

    def matcher(self, expression: ParsingExpression) -> Matcher:
        """Return the matcher of an expression, made at its first use."""
        known = self._matchers.get(id(expression))
        if known is not None:
            return known

        def forward(text: str, position: int, out: list[Any]) -> int:
            return self._matchers[id(expression)](text, position, out)

        self._matchers[id(expression)] = forward
        matcher = self._make(expression)
        self._matchers[id(expression)] = matcher
        return matcher

    def _make(self, expression: ParsingExpression) -> Matcher:
        if isinstance(expression, EndOfFile):
            return _end(expression)
        if isinstance(expression, RegExMatch):
            return _token(expression)
        if isinstance(expression, StrMatch):
            return _sign(expression)
        parts = [self.matcher(node) for node in expression.nodes]
        kind = type(expression)
        if kind is Sequence:
            matcher = _sequence(parts)
        elif kind is OrderedChoice:
            matcher = _choice(parts, [first_characters(node) for node in expression.nodes])
        elif kind is Optional:
            matcher = _optional(parts[0], first_characters(expression.nodes[0]))
        elif kind in (ZeroOrMore, OneOrMore):
            matcher = self._repetition(expression, parts[0])
        else:
            raise TypeError(f"no matcher for {kind.__name__}, which no grammar here needs")
        return _branch(expression, matcher) if expression.root else matcher

    def _repetition(self, expression: Repetition, part: Matcher) -> Matcher:
        separator = self.matcher(expression.sep) if expression.sep else None
        least = 1 if type(expression) is OneOrMore else 0
        return _repeated(part, separator, least, first_characters(expression.nodes[0]))


def _end(expression: EndOfFile) -> Matcher:
    def match(text: str, position: int, out: list[Any]) -> int:
        if position < len(text):
            return -1
        out.append(_Leaf(expression, position, ""))
        return position

    return match


def _token(expression: RegExMatch) -> Matcher:
    find = expression.regex.match

    def match(text: str, position: int, out: list[Any]) -> int:
        found = find(text, position)
        if found is None:
            return -1
        token = Token(found.group())
        token.start = position
        out.append(_Leaf(expression, position, token))
        end: int = _skip_blanks(text, found.end()).end()  # type: ignore[union-attr]
        return end

    return match


def _sign(expression: StrMatch) -> Matcher:
    sign = expression.to_match
    length = len(sign)

    def match(text: str, position: int, out: list[Any]) -> int:
        if not text.startswith(sign, position):
            return -1
        out.append(_Leaf(expression, position, sign))
        end: int = _skip_blanks(text, position + length).end()  # type: ignore[union-attr]
        return end

    return match


def _sequence(parts: list[Matcher]) -> Matcher:
    if len(parts) == 1:
        return parts[0]

    def match(text: str, position: int, out: list[Any]) -> int:
        for part in parts:
            position = part(text, position, out)
            if position < 0:
                return -1
        return position

    return match


def _choice(parts: list[Matcher], firsts: list[frozenset[str] | None]) -> Matcher:
    possible: dict[str, list[Matcher]] = {}  # by the first character

    def match(text: str, position: int, out: list[Any]) -> int:
        first = text[position : position + 1]
        if first not in possible:
            pairs = zip(parts, firsts, strict=True)
            possible[first] = [part for part, known in pairs if known is None or first in known]
        before = len(out)
        for part in possible[first]:
            end = part(text, position, out)
            if end >= 0:
                return end
            del out[before:]
        return -1

    return match


def _optional(part: Matcher, firsts: frozenset[str] | None) -> Matcher:
    def match(text: str, position: int, out: list[Any]) -> int:
        if firsts is not None and text[position : position + 1] not in firsts:
            return position
        before = len(out)
        end = part(text, position, out)
        if end >= 0:
            return end
        del out[before:]
        return position

    return match


def _repeated(
    part: Matcher, separator: Matcher | None, least: int, firsts: frozenset[str] | None
) -> Matcher:
    def match(text: str, position: int, out: list[Any]) -> int:
        count = 0
        while True:
            before = len(out)
            end = position
            if separator is not None and count:
                end = separator(text, end, out)
            if end >= 0:
                fits = firsts is None or text[end : end + 1] in firsts
                end = part(text, end, out) if fits else -1
            if end < 0:
                del out[before:]
                return position if count >= least else -1
            position = end
            count += 1

    return match


def _branch(expression: ParsingExpression, inner: Matcher) -> Matcher:
    def match(text: str, position: int, out: list[Any]) -> int:
        nodes: list[Any] = []
        end = inner(text, position, nodes)
        if end >= 0 and nodes:
            out.append(_Branch(expression, nodes))
        return end

    return match
