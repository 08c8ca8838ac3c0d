"""Finds where parsing resumes after a broken statement."""

from __future__ import annotations

import enum
import re

from deros.metamodels.recovery.recogniser import Recogniser, StatementList, skip_blanks

PIECE = re.compile(r'"[^"\\\n]*(?:\\.[^"\\\n]*)*"?|[^\s"{};]+|[{};]')
"""A text, a word with what touches it, or a sign that ends or encloses statements."""

_END_OF_LINE = re.compile(r"[\t\r ]*(?:\n|;|\}|\Z)")
_ENOUGH_TOKENS = 2


_WORD = re.compile(r"[A-Za-z_]\w*")
_SECTIONS = {"node": "parameters", "safety": "parameters"}
"""Statements with a section whose word may also begin a statement beside them, before the first."""


class _Begin(enum.Enum):
    """How certain it is that a statement begins at a position."""

    SURE = enum.auto()
    MISSPELT = enum.auto()


class Search:
    """The search for the end of a broken statement."""

    def __init__(
        self,
        text: str,
        recogniser: Recogniser,
        lists: list[StatementList],
        start: int,
        failed: int,
    ) -> None:
        self._text = text
        self._recogniser = recogniser
        self._lists = lists
        self._start = start
        self._failed = failed
        self._enclosed = text.count("{", 0, start) > text.count("}", 0, start)

    def end(self) -> tuple[int, bool]:
        """Return the end of the statement, and whether another one certainly begins there."""
        text = self._text
        depth = 0
        for piece in PIECE.finditer(text, self._start):
            here, sign = piece.start(), piece.group()
            if here > self._start and depth == 0 and (begin := self._begins(here)):
                return here, begin is _Begin.SURE
            if sign == "{":
                depth += 1
            elif sign == "}":
                if depth == 0 and self._enclosed and here >= self._failed and here > self._start:
                    return here, True
                depth = max(0, depth - 1)
                if depth == 0 and here > self._failed and _END_OF_LINE.match(text, here + 1):
                    return self._past(here, ";"), False
            elif sign == ";" and depth == 0 and here >= self._failed:
                after = self._past(here, "")
                if not text.startswith("{", after):
                    return after, text.startswith("}", after)
        return len(text), False

    def _past(self, position: int, sign: str) -> int:
        after: int = skip_blanks(self._text, position + 1).end()  # type: ignore[union-attr]
        if sign and self._text.startswith(sign, after):
            after = skip_blanks(self._text, after + 1).end()  # type: ignore[union-attr]
        return after

    def _begins(self, here: int) -> _Begin | None:
        """Return whether a statement of an open list begins here."""
        fresh = self._is_fresh(here)
        for each in self._lists:
            how = each.opened_by(self._text, here)
            section = self._section(each)
            if not how:
                # A word of the language that belongs elsewhere is no other one, misspelt.
                is_near = fresh and self._word(here) not in self._recogniser.words
                is_near = is_near and each.seems_opened_by(self._text, here, without=section)
                if is_near and here >= self._failed:
                    return _Begin.MISSPELT
                continue
            if (how == "name" and not fresh) or self._word(here) in section:
                continue
            if how == "keyword" and fresh and here >= self._failed:
                return _Begin.SURE
            attempt = self._recogniser.try_statement(each, self._text, here)
            if here < self._failed:
                # A statement without its end has taken the next one's first words for its own.
                if how == "keyword" and fresh and attempt.end > self._failed:
                    return _Begin.SURE
            elif how == "keyword" and attempt.end >= 0:
                return _Begin.SURE
            elif how == "name":
                tokens = len(PIECE.findall(self._text[here : attempt.reached]))
                if tokens >= _ENOUGH_TOKENS:
                    return _Begin.SURE
        return None

    def _section(self, statements: StatementList) -> tuple[str, ...]:
        """Return the words of a list that may also open a section of the broken statement."""
        broken = self._word(self._start)
        found = _SECTIONS.get(broken)
        return () if found is None or broken not in statements.keywords else (found,)

    def _word(self, place: int) -> str:
        found = _WORD.match(self._text, place)
        return found[0] if found is not None else ""

    def _is_fresh(self, here: int) -> bool:
        """Return whether a position begins a line, or follows the end of a statement."""
        last = here - 1
        while last >= self._start and self._text[last] in "\t\n\r ":
            if self._text[last] == "\n":
                return True
            last -= 1
        return last < self._start or self._text[last] in ";{}"
