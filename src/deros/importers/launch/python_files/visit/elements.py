"""Elements as they are handed over: plain data."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from deros.importers.launch.python_files.visit.texts import text, words

Made = dict[str, Any]
"""``tag``, ``line``, ``attributes`` by name, ``children``, ``text``: as in an XML file."""


def element(
    tag: str,
    line: int,
    attributes: Mapping[str, Any] | None = None,
    children: Iterable[Made] = (),
    content: str = "",
    commands: Mapping[str, Iterable[Any]] | None = None,
) -> Made:
    """Return an element.

    Args:
        tag: its name.
        line: of the launch file; 0 if that is not known.
        attributes: their values; one that is ``None`` is left out.
        children: the elements in it.
        content: the text in it, as it is written.
        commands: attributes that are command lines, by their words; one without words is left out.
    """
    said = {name: text(value) for name, value in (attributes or {}).items() if value is not None}
    said |= {name: words(each) for name, each in (commands or {}).items() if each}
    found = {"tag": tag, "line": line, "attributes": said, "children": list(children)}
    return {**found, "text": content}
