"""The elements of a launch file in Python, as if it were one in XML."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from deros.diagnostics import SourceFile, Span
from deros.generators.text.prose import printable_line
from deros.importers.launch.python_files.running import visited
from deros.importers.readers import source_of
from deros.metamodels.launch_files.elements import Element


class Unsaid(NamedTuple):
    """What a launch file makes that is no element: what it is, why, and its line."""

    what: str
    why: str
    line: int


def elements_of(path: Path, values: Mapping[str, str]) -> tuple[Element, tuple[Unsaid, ...]]:
    """Return the root of a launch file, which is run, and what is not in it.

    Raises:
        UnreadableError: it cannot be read or run.
    """
    source = source_of(path)
    return root_of(source, visited(path, values))


def root_of(source: SourceFile, made: Mapping[str, Any]) -> tuple[Element, tuple[Unsaid, ...]]:
    """Return the root of what a launch file has made, as :mod:`visit` writes it."""
    starts = [0]
    for line in source.text.split("\n"):
        starts.append(starts[-1] + len(line) + 1)
    children = list(_elements(source, starts, made["actions"]))
    unsaid = tuple(
        Unsaid(printable_line(what), printable_line(why), line)
        for what, why, line in made["unsaid"]
    )
    return Element("launch", Span(source, 0, 0), {}, children), unsaid


def _elements(
    source: SourceFile, starts: list[int], made: Iterable[Mapping[str, Any]]
) -> Iterable[Element]:
    for each in made:
        # What is made elsewhere stands at the beginning.
        start = starts[min(max(each["line"], 1), len(starts) - 1) - 1]
        children = list(_elements(source, starts, each["children"]))
        texts = [each["text"]] if each["text"] else []
        span = Span(source, start, start)
        yield Element(each["tag"], span, each["attributes"], children, True, texts)
