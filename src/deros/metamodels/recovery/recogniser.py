"""A recogniser that runs on the expressions of a grammar and reports how far it came.

A :class:`Recogniser` makes no tree. It records the farthest place that no expression matches, what
could stand there, and in which statement lists the place lies. That is all that error recovery
needs to know of a language: statements that are added to a grammar are recovered like all others.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from arpeggio import (
    EndOfFile,
    OneOrMore,
    Optional,
    OrderedChoice,
    ParsingExpression,
    RegExMatch,
    Sequence,
    StrMatch,
    ZeroOrMore,
)

from deros.metamodels.grammar import first_tokens, is_name, is_statement, matches, words_of
from deros.names.names import near

Step = Callable[[str, int], int]
"""Matches a text at a non-blank position; returns where the next token starts, or -1."""

skip_blanks = re.compile(r"[\t\n\r ]*").match

_WORD = re.compile(r"[^\W\d]\w*").match


@dataclass(frozen=True, slots=True)
class StatementList:
    """A repetition of statements in a grammar.

    Attributes:
        number: the identity of the list in its grammar.
        step: matches one statement.
        first: the tokens that a statement may begin with.
    """

    number: int
    step: Step
    first: tuple[ParsingExpression, ...]

    def opened_by(self, text: str, position: int) -> str:
        """Return how a statement would begin here: by a ``"keyword"``, a ``"name"`` or ``""``."""
        how = ""
        for token in self.first:
            if matches(token, text, position):
                if not is_name(token):
                    return "keyword"
                how = "name"
        return how

    def seems_opened_by(self, text: str, position: int, without: Collection[str] = ()) -> bool:
        """Return whether a word stands here that was meant to be a keyword of a statement."""
        found = _WORD(text, position)
        words = [word for word in self.keywords if word not in without]
        return found is not None and bool(near(found.group(), words))

    @property
    def keywords(self) -> list[str]:
        """The words that a statement may begin with."""
        return [word for token in self.first for word in words_of(token)]


class Place(NamedTuple):
    """A statement that a parse is in, and the statements around it."""

    outer: Place | None
    list: StatementList
    start: int


@dataclass(slots=True)
class Trace:
    """The farthest failure of a parse.

    Attributes:
        position: where it is.
        expected: the tokens that were tried there.
        places: for each of them, the statement that it would have been in.
        place: the statement that is being read.
        looked_at: the farthest position where a token was tried in vain since it was set back.
    """

    position: int = -1
    expected: list[ParsingExpression] = field(default_factory=list)
    places: list[Place | None] = field(default_factory=list)
    place: Place | None = None
    looked_at: int = -1

    def fail(self, position: int, token: ParsingExpression) -> None:
        """Note that a token does not match at a position."""
        if position > self.looked_at:
            self.looked_at = position
        if position < self.position:
            return
        if position > self.position:
            self.position = position
            self.expected = [token]
            self.places = [self.place]
        else:
            self.expected.append(token)
            self.places.append(self.place)


@dataclass(frozen=True, slots=True)
class Attempt:
    """The result of matching a piece of text.

    Attributes:
        end: where the piece ends, or -1 if it does not match.
        trace: how far the parse came.
        starts: where the statements begin that the piece holds.
    """

    end: int
    trace: Trace
    starts: frozenset[int]

    @property
    def reached(self) -> int:
        """The farthest position of the parse."""
        return max(self.end, self.trace.position)

    @property
    def head_matches(self) -> bool:
        """Whether the parse came into one of the statements that the piece holds."""
        return any(
            place is not None and place.outer is not None and place.start < self.trace.position
            for place in self.trace.places
        )


def statement_at(places: list[Place | None], position: int) -> Place | None:
    """Return the innermost statement that a failure belongs to.

    Where one could begin at the position, all before it is whole.
    """
    inner = [each for each in places if each is not None]
    beginning = next((each for each in inner if each.start == position), None)
    if beginning is not None or not inner:
        return beginning
    deepest = max(inner, key=lambda each: each.start)
    # Of two statements of one list, the first has read on; the other took a word of it for a name.
    alike = (each for each in inner if each.list.number == deepest.list.number)
    return min(alike, key=lambda each: each.start)


def lists_of(place: Place | None) -> list[StatementList]:
    """Return the lists that a place lies in, innermost first, each once."""
    found: dict[int, StatementList] = {}
    while place is not None:
        found.setdefault(place.list.number, place.list)
        place = place.outer
    return list(found.values())


class Recogniser:
    """The expressions of one grammar as steps over a text.

    Statements that matched are cached, so that a repaired text is not read again from its start;
    :meth:`forget_from` discards what the repair may change.

    Attributes:
        trace: how far the last text was read.
        words: the keywords of the language.
        body: the outermost list of statements.
    """

    def __init__(self, root: ParsingExpression) -> None:
        """Compile the expressions that ``root`` leads to."""
        self.trace = Trace()
        self._matchers: dict[int, Step] = {}
        self._known: dict[tuple[int, int], tuple[int, int]] = {}
        self._lists: dict[int, StatementList] = {}
        self.words: set[str] = set()
        self._root = self._step(root)
        self.body = next(self._top_lists(root), None)

    @property
    def lists(self) -> list[StatementList]:
        """The lists of statements in the grammar."""
        return list(self._lists.values())

    def run(self, text: str) -> bool:
        """Return whether the whole text matches; if not, :attr:`trace` says why."""
        self.trace = Trace()
        return self._root(text, skip_blanks(text).end()) >= 0  # type: ignore[union-attr]

    def run_body(self, text: str, start: int) -> bool:
        """Return whether the statements of the outermost list fill the text from ``start`` on."""
        self.trace = Trace()
        assert self.body is not None
        position = skip_blanks(text, start).end()  # type: ignore[union-attr]
        while True:
            end = self._statement(self.body, text, position)
            if end < 0:
                return position >= len(text)
            position = end

    def try_statement(self, statements: StatementList, text: str, start: int) -> Attempt:
        """Match one statement without using or changing the cache."""
        before, self.trace = self.trace, Trace(place=Place(None, statements, start))
        known, self._known = self._known, {}
        try:
            end = statements.step(text, start)
            return Attempt(end, self.trace, frozenset(key[1] for key in self._known))
        finally:
            self.trace, self._known = before, known

    def try_all(self, text: str) -> Attempt:
        """Match a whole text without using or changing the cache."""
        before, self.trace = self.trace, Trace()
        known, self._known = self._known, {}
        try:
            end = self._root(text, skip_blanks(text).end())  # type: ignore[union-attr]
            return Attempt(end, self.trace, frozenset(key[1] for key in self._known))
        finally:
            self.trace, self._known = before, known

    def statement_before(self, statements: StatementList, position: int) -> int | None:
        """Return where the statement of a list begins that ends at a position, if there is one."""
        number = statements.number
        found = (
            key[1] for key, (end, _) in self._known.items() if end == position and key[0] == number
        )
        return max(found, default=None)

    def begins_statement(self, position: int) -> bool:
        """Return whether a cached statement begins at a position."""
        return any(start == position for _, start in self._known)

    def forget(self) -> None:
        """Discard all cached statements, before another text is read."""
        self._known.clear()

    def forget_from(self, position: int) -> None:
        """Discard cached statements that may depend on the text from ``position`` on."""
        self._known = {
            key: (end, looked_at)
            for key, (end, looked_at) in self._known.items()
            if end < position and looked_at < position
        }

    # Compiling --------------------------------------------------------------------------------

    def _step(self, expression: ParsingExpression) -> Step:
        known = self._matchers.get(id(expression))
        if known is not None:
            return known

        def forward(text: str, position: int) -> int:
            return self._matchers[id(expression)](text, position)

        self._matchers[id(expression)] = forward
        matcher = self._make(expression)
        self._matchers[id(expression)] = matcher
        return matcher

    def _make(self, expression: ParsingExpression) -> Step:
        if isinstance(expression, EndOfFile):
            return self._end(expression)
        if isinstance(expression, RegExMatch):
            self.words.update(words_of(expression))
            return self._token(expression)
        if isinstance(expression, StrMatch):
            return self._sign(expression)
        parts = [self._step(node) for node in expression.nodes]
        kind = type(expression)
        if kind is Sequence:
            return _sequence(parts)
        if kind is OrderedChoice:
            return _choice(parts)
        if kind is Optional:
            return _optional(parts[0])
        if kind not in (ZeroOrMore, OneOrMore):
            raise TypeError(f"no step for {kind.__name__}, which no grammar here needs")
        least = 1 if kind is OneOrMore else 0
        if expression.sep:
            return _separated(parts[0], self._step(expression.sep), least)
        if not is_statement(expression.nodes[0]):
            return _repeated(parts[0], least)
        first = tuple(dict.fromkeys(first_tokens(expression.nodes[0])))
        statements = StatementList(len(self._lists), parts[0], first)
        self._lists[id(expression)] = statements
        return self._statements(statements, least)

    def _end(self, expression: EndOfFile) -> Step:
        def step(text: str, position: int) -> int:
            if position >= len(text):
                return position
            self.trace.fail(position, expression)
            return -1

        return step

    def _token(self, expression: RegExMatch) -> Step:
        find = expression.regex.match

        def step(text: str, position: int) -> int:
            found = find(text, position)
            if found is not None:
                return skip_blanks(text, found.end()).end()  # type: ignore[union-attr]
            self.trace.fail(position, expression)
            return -1

        return step

    def _sign(self, expression: StrMatch) -> Step:
        sign = expression.to_match
        length = len(sign)

        def step(text: str, position: int) -> int:
            if text.startswith(sign, position):
                return skip_blanks(text, position + length).end()  # type: ignore[union-attr]
            self.trace.fail(position, expression)
            return -1

        return step

    def _statements(self, statements: StatementList, least: int) -> Step:
        def step(text: str, position: int) -> int:
            count = 0
            while (end := self._statement(statements, text, position)) >= 0:
                position = end
                count += 1
            return position if count >= least else -1

        return step

    def _statement(self, statements: StatementList, text: str, position: int) -> int:
        """Match one statement of a list, unless it is cached; return its end, or -1."""
        trace = self.trace
        end, looked_at = self._known.get((statements.number, position), (-1, -1))
        if end < 0:
            outer, before = trace.place, trace.looked_at
            trace.place, trace.looked_at = Place(outer, statements, position), -1
            end = statements.step(text, position)
            looked_at = trace.looked_at
            trace.place, trace.looked_at = outer, before
            if end >= 0:
                self._known[statements.number, position] = (end, looked_at)
        if looked_at > trace.looked_at:
            trace.looked_at = looked_at
        return end

    def _top_lists(self, expression: ParsingExpression) -> Iterator[StatementList]:
        """Yield the lists that are in no other list, outermost first."""
        if id(expression) in self._lists:
            yield self._lists[id(expression)]
            return
        for node in expression.nodes:
            yield from self._top_lists(node)


def _sequence(parts: list[Step]) -> Step:
    def step(text: str, position: int) -> int:
        for part in parts:
            position = part(text, position)
            if position < 0:
                return -1
        return position

    return parts[0] if len(parts) == 1 else step


def _choice(parts: list[Step]) -> Step:
    def step(text: str, position: int) -> int:
        for part in parts:
            end = part(text, position)
            if end >= 0:
                return end
        return -1

    return step


def _optional(part: Step) -> Step:
    def step(text: str, position: int) -> int:
        end = part(text, position)
        return end if end >= 0 else position

    return step


def _repeated(part: Step, least: int) -> Step:
    def step(text: str, position: int) -> int:
        count = 0
        while (end := part(text, position)) >= 0:
            position = end
            count += 1
        return position if count >= least else -1

    return step


def _separated(part: Step, separator: Step, least: int) -> Step:
    def step(text: str, position: int) -> int:
        end = part(text, position)
        count = 0
        while end >= 0:
            position = end
            count += 1
            end = separator(text, position)
            if end >= 0:
                end = part(text, end)
        return position if count >= least else -1

    return step
