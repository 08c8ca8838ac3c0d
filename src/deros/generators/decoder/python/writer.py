"""The lines of one decoder as they come."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from deros.generators.decoder.python.module import Parts, group_lines
from deros.generators.text.document import LINE, Document, concat, group, if_broken, render_lines
from deros.generators.text.python import LINE_LENGTH, filled
from deros.generators.text.unique_names import UniqueNames


class Writer:
    """Collects the lines of one decoder, and the readers of its groups of fields.

    Attributes:
        lines: the body of the function.
        groups: the lines of each reader of a group.
        parts: what the module needs for it.
        names: of the function's variables.
    """

    def __init__(
        self, names: UniqueNames, parts: Parts, constant: str, constants: UniqueNames
    ) -> None:
        """Begin with no lines; ``constant`` is what the readers of groups are named after."""
        self.lines: list[str] = []
        self.groups: list[list[str]] = []
        self.parts = parts
        self.names = names
        self._constant = constant
        self._constants = constants
        self._depth = 1

    @property
    def has_lengths(self) -> bool:
        """Whether a length is read from the data."""
        return any("UINT32[" in line for line in self.lines)

    def line(self, text: str, comment: str = "") -> None:
        """Add a line, with a comment behind it, or above it where the line gets too long."""
        above = if_broken(concat("# ", comment, LINE)) if comment else ""
        behind = if_broken("", f"  # {comment}") if comment else ""
        self.add(group(above, text, behind))

    def assign(self, names: Sequence[str], value: str) -> None:
        """Add the assignment of several values at once."""
        self.add(filled(if_broken("("), names, concat(if_broken(")"), f" = {value}")))

    def add(self, document: Document) -> None:
        """Add the lines of a document."""
        self.lines += render_lines(document, LINE_LENGTH, 4 * self._depth)

    def group(self, letters: str, fields: list[str]) -> str:
        """Return the constant that reads a group of fields."""
        name = self._constants.new(self._constant)
        self.parts.helpers.add("both")
        self.groups.append(group_lines(name, letters, fields))
        return name

    @contextmanager
    def indented(self, header: str, comment: str = "") -> Iterator[None]:
        """Add a line and indent those that follow within."""
        self.line(header, comment)
        self._depth += 1
        yield
        self._depth -= 1
