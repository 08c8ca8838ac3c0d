"""Where the lines of a formatted text end: as they were written, with blocks opened and closed."""

from __future__ import annotations

from collections.abc import Sequence

from deros.formatting.pieces import Piece, bound_lines

_SAME_LINE, _NEW_LINE, _BLANK_LINE = range(3)


def line_ends(pieces: Sequence[Piece]) -> list[int]:
    """Return how many line ends are before each piece: 2 make a blank line.

    A block that was written in several lines has a line for ``{`` and one for ``}``.
    """
    opening, closing = _block_borders(pieces)
    bound = bound_lines(pieces)
    ends = [_SAME_LINE]
    for place in range(1, len(pieces)):
        before, after = pieces[place - 1], pieces[place]
        written = min(after.line - before.end_line, _BLANK_LINE)
        if bound.isdisjoint({before.end_line, after.line}):
            written = _changed(pieces, place, written, opening, closing)
        ends.append(written)
    return ends


def _changed(
    pieces: Sequence[Piece], place: int, written: int, opening: set[int], closing: set[int]
) -> int:
    """Return how many line ends are before a piece if all of them may change."""
    before, after = pieces[place - 1], pieces[place]
    if after.token is not None and before.token is not None:
        if after.text in ("{", ";") or (before.text == "{" and after.text == "}"):
            return _SAME_LINE
    elif place - 1 in opening and written == _SAME_LINE and _ends_line(pieces, place):
        return _SAME_LINE
    return _NEW_LINE if place - 1 in opening or place in closing else written


def _ends_line(pieces: Sequence[Piece], place: int) -> bool:
    """Return whether the piece at a place is the last one of its line."""
    return place + 1 == len(pieces) or pieces[place + 1].line > pieces[place].end_line


def _block_borders(pieces: Sequence[Piece]) -> tuple[set[int], set[int]]:
    """Return the places of ``{`` and of ``}`` of the blocks that were written in several lines."""
    opening: set[int] = set()
    closing: set[int] = set()
    opened: list[int] = []
    for place, piece in enumerate(pieces):
        if piece.token is None:
            continue
        if piece.text == "{":
            opened.append(place)
        elif piece.text == "}":
            begin = opened.pop()
            if pieces[begin].line < piece.line:
                opening.add(begin)
                closing.add(place)
    return opening, closing
