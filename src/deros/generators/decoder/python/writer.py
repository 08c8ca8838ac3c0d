"""The writer of the lines of one decoder."""

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
        parts: the parts of the module that it uses.
        names: the names of the function's variables.
    """

    def __init__(
        self, names: UniqueNames, parts: Parts, constant: str, constants: UniqueNames
    ) -> None:
        """Start without lines; the names of the readers of groups start with ``constant``."""
        self.lines: list[str] = []
        self.groups: list[list[str]] = []
        self.parts = parts
        self.names = names
        self._constant = constant
        self._constants = constants
        self._depth = 1

    @property
    def has_lengths(self) -> bool:
        """Whether the lines read a length from the data."""
        return any("UINT32[" in line for line in self.lines)

    def line(self, text: str, comment: str = "") -> None:
        """Add a line with a comment at its end, or above it if the line would be too long."""
        above = if_broken(concat("# ", comment, LINE)) if comment else ""
        behind = if_broken("", f"  # {comment}") if comment else ""
        self.add(group(above, text, behind))

    def assign(self, names: Sequence[str], value: str) -> None:
        """Add an assignment of several values to as many names, or of all of them to one."""
        if len(names) == 1:  # which in brackets would be a tuple of one
            self.line(f"{names[0]} = {value}")
            return
        self.add(filled(if_broken("("), names, concat(if_broken(")"), f" = {value}")))

    def add(self, document: Document) -> None:
        """Add the lines of a document."""
        self.lines += render_lines(document, LINE_LENGTH, 4 * self._depth)

    def group(self, letters: str, fields: list[str]) -> str:
        """Add a constant that reads a group of fields, and return its name."""
        name = self._constants.new(self._constant)
        self.parts.helpers.add("both")
        self.groups.append(group_lines(name, letters, fields))
        return name

    @contextmanager
    def indented(self, header: str, comment: str = "") -> Iterator[None]:
        """Add a line, and indent the lines added within the context."""
        self.line(header, comment)
        self._depth += 1
        yield
        self._depth -= 1
