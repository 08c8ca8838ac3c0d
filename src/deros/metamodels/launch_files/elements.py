"""The elements of a launch file, whether it is written in XML or YAML."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from deros.diagnostics import Span
from deros.models.parameter_files import Fault

MOST = 200_000
"""Elements and attributes of one file."""


class NotALaunchFile(Exception):  # noqa: N818 - it carries a fault of the file
    """The file is none that launch reads; ``fault`` says why."""

    def __init__(self, message: str, span: Span, hint: str = "") -> None:
        super().__init__(message)
        self.fault = Fault(message, span, hint)


class NotRead(Exception):  # noqa: N818 - it is not a fault of the file
    """The file may be one that launch reads, but what is in it is not looked at here."""


@dataclass(frozen=True, slots=True)
class Element:
    """One element: an action, or what belongs to one.

    Attributes:
        tag: its name, with ``_`` for ``-``, as launch takes both.
        span: of its name.
        attributes: by name.
        children: the elements in it.
        is_whole: whether all in it is known.
        texts: between its tags, of XML; of YAML, an item of a list that is no mapping.
    """

    tag: str
    span: Span
    attributes: Mapping[str, str]
    children: list[Element] = field(default_factory=list)
    is_whole: bool = True
    texts: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        """All between its tags that belongs to no other element."""
        return "".join(self.texts)

    def below(self) -> Iterator[Element]:
        """Yield all elements in it, without those in an ``include``."""
        waiting = list(reversed(self.children))
        while waiting:
            found = waiting.pop()
            yield found
            if found.tag != "include":
                waiting.extend(reversed(found.children))
