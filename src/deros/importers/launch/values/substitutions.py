r"""Texts of launch files taken apart: ``$(name operand …)`` between pieces of text.

As ``launch/frontend/grammar.lark`` reads them: an operand ends at a blank, or stands between
quotes, and a backslash escapes the character behind it.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

_NAME = re.compile(r"[A-Za-z][\w-]*")
_DEEPEST = 40
"""Substitutions within others."""


class InexpressibleError(Exception):
    """A model cannot say this; the text says why, and follows on the name of what it is about.

    Attributes:
        is_used: whether what needs a value that cannot be said has been reported.
    """

    def __init__(self, why: str) -> None:
        super().__init__(why)
        self.is_used = False


@dataclass(frozen=True, slots=True)
class Substitution:
    """``$(name operand …)``."""

    name: str
    operands: tuple[Pieces, ...] = ()


Piece = str | Substitution
Pieces = tuple[Piece, ...]
"""A text, no two of whose neighbours are texts."""


def pieces_of(text: str) -> Pieces:
    """Return the pieces of a text.

    Raises:
        InexpressibleError: launch cannot read it.
    """
    return _Reading(text).template("")


class _Reading:
    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0
        self._depth = 0

    def template(self, quote: str) -> Pieces:
        """Return all up to the end, or up to and without the quote that ends it."""
        found: list[Piece] = []
        literal: list[str] = []
        while self._at < len(self._text) and not (quote and self._next == quote):
            if self._text.startswith("$(", self._at):
                self._flush(found, literal)
                found.append(self._substitution(quote))
            else:
                literal.append(self._character())
        self._flush(found, literal)
        return tuple(found)

    @property
    def _next(self) -> str:
        return self._text[self._at : self._at + 1]

    @staticmethod
    def _flush(found: list[Piece], literal: list[str]) -> None:
        if literal:
            found.append("".join(literal))
            literal.clear()

    def _character(self) -> str:
        """Return the next character, without the backslash that escapes it."""
        if self._next == "\\" and self._at + 1 < len(self._text):
            self._at += 1
        found = self._next
        self._at += 1
        return found

    def _substitution(self, quote: str) -> Substitution:
        start = self._at
        self._depth += 1
        name = _NAME.match(self._text, start + 2)
        if name is None or self._depth > _DEEPEST:
            raise InexpressibleError(
                f"has a substitution that cannot be read: {self._shown(start)}"
            )
        self._at = name.end()
        operands = []
        while self._next.isspace():
            self._at += 1
            if self._next.isspace() or self._next == ")":
                continue
            operands.append(self._operand(quote))
        if self._next != ")":
            raise InexpressibleError(f"has a substitution without an end: {self._shown(start)}")
        self._at += 1
        self._depth -= 1
        return Substitution(name[0], tuple(operands))

    def _shown(self, start: int) -> str:
        return f"'{self._text[start : start + 60]}'"

    def _operand(self, quote: str) -> Pieces:
        mark = self._next
        if not quote and mark in ("'", '"'):
            self._at += 1
            found = self.template(mark)
            if self._next != mark:
                raise InexpressibleError("has a quote without an end")
            self._at += 1
            return found
        pieces: list[Piece] = []
        literal: list[str] = []
        while self._next and not self._next.isspace() and self._next != ")":
            if self._text.startswith("$(", self._at):
                self._flush(pieces, literal)
                pieces.append(self._substitution(quote))
            else:
                literal.append(self._character())
        self._flush(pieces, literal)
        return tuple(pieces)
