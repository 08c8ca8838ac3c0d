"""The lines of a file of timelines, their cells, and the faults that are found in them."""

from __future__ import annotations

from dataclasses import dataclass

from deros import codes
from deros.diagnostics import Diagnostic, SourceFile, Span, report


class Fault(Exception):  # noqa: N818 - it carries a finding and is not an error of the program
    """A line cannot be interpreted; ``diagnostic`` says why."""

    def __init__(self, message: str, span: Span, hint: str = "") -> None:
        super().__init__(message)
        self.diagnostic: Diagnostic = report(codes.BAD_TIMELINE, message, span, hint)


@dataclass(frozen=True, slots=True)
class Cell:
    """The text of a cell without the spaces around it, and its place."""

    text: str
    span: Span

    def fault(self, message: str, hint: str = "") -> Fault:
        """Return the fault of this cell."""
        return Fault(message, self.span, hint)


@dataclass(frozen=True, slots=True)
class Line:
    """One line of a file, or the part of it that counts.

    Attributes:
        source: the file.
        number: of the line, from 1.
        start: the offset of its first character.
        text: without the spaces behind it.
    """

    source: SourceFile
    number: int
    start: int
    text: str

    @property
    def span(self) -> Span:
        """The place of the line."""
        return Span(self.source, self.start, self.start + len(self.text))

    @property
    def cells(self) -> list[Cell]:
        """The cells of a row of a table, between its bars."""
        found = []
        start = self.start
        for part in self.text.split("|"):
            indent = len(part) - len(part.lstrip())
            text = part.strip()
            place = start + (indent if text else 0)
            found.append(Cell(text, Span(self.source, place, place + len(text))))
            start += len(part) + 1
        return found[1:-1]

    @property
    def is_rule(self) -> bool:
        """Whether it is the line ``|---|---|`` below the head of a table."""
        cells = self.cells
        return bool(cells) and all("-" in each.text and not each.text.strip(":-") for each in cells)

    def part(self, start: int, end: int) -> Line:
        """Return a part of the line."""
        return Line(self.source, self.number, self.start + start, self.text[start:end])

    def fault(self, message: str, hint: str = "") -> Fault:
        """Return the fault of this line."""
        return Fault(message, self.span, hint)


def lines_of(source: SourceFile) -> list[Line]:
    """Return the lines of a file."""
    found = []
    start = 0
    for number, text in enumerate(source.text.split("\n"), 1):
        found.append(Line(source, number, start, text.rstrip()))
        start += len(text) + 1
    return found
