"""A text with edits that maps its characters to their original positions."""

from __future__ import annotations

import re
from bisect import bisect_right
from typing import Any

from arpeggio import NonTerminal

_NOT_BLANK = re.compile(r"[^\t\n\r ]")


class RepairedText(str):
    """An edited text that parses, made from one that does not.

    Attributes:
        edits: of each edit that changes the length: where the text goes on behind it, and where
            the original does.
    """

    __slots__ = ("edits",)
    edits: tuple[tuple[int, int], ...]

    @classmethod
    def of(cls, text: str) -> RepairedText:
        """Return a text without edits."""
        repaired = cls(text)
        repaired.edits = ()
        return repaired

    def replaced(self, start: int, end: int, by: str) -> RepairedText:
        """Return the text with ``by`` in place of the characters from ``start`` to ``end``.

        Where only parentheses are put in, each character between them keeps its place.
        """
        put_in = _parentheses_put_in(self[start:end], by)
        if put_in and by not in ("(", ")"):
            text = self
            for offset, parenthesis in reversed(put_in):
                place = start + offset
                text = text.replaced(place, place, parenthesis)
            return text
        repaired = RepairedText(f"{self[:start]}{by}{self[end:]}")
        longer = len(by) - (end - start)
        if not longer:
            repaired.edits = self.edits
            return repaired
        before = [each for each in self.edits if each[0] <= start]
        after = [(here + longer, there) for here, there in self.edits if here >= end]
        resumed = (start + len(by), self.original(end))
        repaired.edits = (*before, resumed, *after)
        return repaired

    def blanked(self, start: int, end: int) -> RepairedText:
        """Return the text with blanks from ``start`` to ``end``; line ends stay."""
        blanks = _NOT_BLANK.sub(" ", self[start:end])
        return self.replaced(start, end, blanks)

    def original(self, offset: int) -> int:
        """Return the original position of a character.

        Of characters that were put in, it is where the original goes on behind them.
        """
        index = bisect_right(self.edits, (offset, 1 << 62))
        shift = 0
        if index:
            here, there = self.edits[index - 1]
            shift = there - here
        found = offset + shift
        return min(found, self.edits[index][1]) if index < len(self.edits) else found


def _parentheses_put_in(before: str, after: str) -> list[tuple[int, str]]:
    """Return the parentheses that a text has more than before, each with its place there.

    Blanks do not count. None, if anything else differs.
    """
    found: list[tuple[int, str]] = []
    place = 0
    for character in filter(_NOT_BLANK.match, after):
        while before[place : place + 1].isspace():
            place += 1
        if before[place : place + 1] == character:
            place += 1
        elif character in "()":
            found.append((place, character))
        else:
            return []
    return found if not before[place:].strip() else []


def restore_places(tree: Any, text: RepairedText) -> None:
    """Move every node of a parse tree to its place in the text as it was read.

    A token that was made longer at the end of the text begins earlier, so that it ends there.
    """
    length = text.original(len(text))
    pending = [tree]
    while pending:
        node = pending.pop()
        node.position = text.original(node.position)
        if isinstance(node, NonTerminal):
            pending += node
            continue
        node.position = max(0, min(node.position, length - len(node.value)))
        if hasattr(node.value, "start"):
            node.value.start = node.position
