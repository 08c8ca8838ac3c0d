"""The lines of a formatted text: indentation, blanks between tokens, and comments."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from deros.formatting.breaks import line_ends
from deros.formatting.pieces import Piece
from deros.formatting.spacing import touches
from deros.metamodels.tokens import SyntaxToken

STEP = 2
"""Columns by which each block and each section is indented."""

_OPENING = frozenset({"(", "["})
_CLOSING = frozenset({")", "]"})


@dataclass(slots=True)
class Line:
    """A line of a formatted text.

    Attributes:
        indent: how many columns it is indented.
        pieces: what is in it.
        is_spaced: whether a blank line is before it.
    """

    indent: int
    pieces: list[Piece] = field(default_factory=list)
    is_spaced: bool = False

    @property
    def remark(self) -> Piece | None:
        """The comment at its end, after a token."""
        *before, last = self.pieces
        return last if before and last.token is None else None

    @property
    def last_token(self) -> str:
        """The text of its last token, empty if there is none."""
        tokens = (piece.text for piece in reversed(self.pieces) if piece.token is not None)
        return next(tokens, "")

    @property
    def code(self) -> str:
        """Its text up to the remark."""
        pieces = self.pieces if self.remark is None else self.pieces[:-1]
        text = " " * self.indent
        for place, piece in enumerate(pieces):
            before = pieces[place - 1] if place else None
            blank = "" if before is None or _touch(before, piece) else " "
            text += blank + (piece.text if place or piece.token else moved(piece, self.indent))
        return text


def _touch(before: Piece, after: Piece) -> bool:
    if before.token is not None and after.token is not None:
        return touches(before.token, after.token)
    return before.text in _OPENING or after.text in (*_CLOSING, ",", ";")


def moved(comment: Piece, column: int) -> str:
    """Return a comment that begins in a column; its other lines move with the first one."""
    first, *others = comment.text.split("\n")
    shift = column - comment.column
    return "\n".join([first, *(_shifted(each, shift) for each in others)])


def _shifted(line: str, by: int) -> str:
    blanks = len(line) - len(line.lstrip(" "))
    return " " * max(0, blanks + by) + line[blanks:] if line else ""


def lines_of(pieces: Sequence[Piece]) -> list[Line]:
    """Return the lines of a formatted text."""
    layout = _Layout(pieces)
    for place in range(len(pieces)):
        layout.add(place)
    return layout.lines


class _Layout:
    def __init__(self, pieces: Sequence[Piece]) -> None:
        self._pieces = pieces
        self._ends = line_ends(pieces)
        self._brackets: list[int] = []  # how much is indented in those that end their line, else 0
        self._statement = (
            0  # the indentation of the last line with which a statement begins or ends
        )
        self.lines: list[Line] = []

    def add(self, place: int) -> None:
        """Add the piece at a place; those before it have been added."""
        piece = self._pieces[place]
        if self._ends[place] or not place:
            if self.lines and self.lines[-1].last_token in _OPENING:
                self._brackets[-1] = self.lines[-1].indent + STEP
            self.lines.append(Line(self._indent(place), is_spaced=self._ends[place] > 1))
        self.lines[-1].pieces.append(piece)
        if piece.token is None:
            return
        if piece.text in _OPENING:
            self._brackets.append(0)
        elif piece.text in _CLOSING:
            self._brackets.pop()

    def _indent(self, place: int) -> int:
        piece = self._pieces[place]
        if piece.token is None:
            return self._indent_of_comment(place)
        indent = self._indent_of_token(piece.token, place)
        if piece.token.starts or piece.text == "}":
            self._statement = indent
        return indent

    def _indent_of_token(self, token: SyntaxToken, place: int) -> int:
        block = token.level * STEP
        if token.starts or token.text in ("{", "}") or _is_then(token):
            return block
        contents = next(filter(None, reversed(self._brackets)), 0)
        if not contents:
            return block + STEP
        if self._brackets[-1]:
            if token.text in _CLOSING:
                return contents - STEP
            if self._token_before(place) in ("(", "[", ","):
                return contents
        return contents + STEP

    def _token_before(self, place: int) -> str:
        return next(each.text for each in reversed(self._pieces[:place]) if each.token is not None)

    def _indent_of_comment(self, place: int) -> int:
        """Return how much a comment is indented: as what follows it, or what it comes last in."""
        if place and self._ends[place] == 1 and self._is_alone(place - 1):
            return self.lines[-1].indent
        after = place + 1
        while after < len(self._pieces) and self._is_alone(after) and self._ends[after] == 1:
            after += 1
        indent, ends_block = 0, True
        for following in range(after, len(self._pieces)):
            token = self._pieces[following].token
            if token is not None:
                ends_block = token.text == "}"
                indent = self._indent_of_token(token, following)
                indent += STEP if token.text in ("}", *_CLOSING) else 0
                break
        is_last = ends_block or self._ends[after] > 1
        return max(indent, self._statement) if is_last and self._ends[place] == 1 else indent

    def _is_alone(self, place: int) -> bool:
        """Return whether a comment stands at a place, and no token before it in its line."""
        return self._pieces[place].token is None and (not place or self._ends[place] > 0)


def _is_then(token: SyntaxToken) -> bool:
    """Return whether a token is the word that is below the condition of a behaviour."""
    return token.within == "Behaviour" and token.text == "then"
