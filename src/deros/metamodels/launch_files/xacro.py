"""What a file for xacro says of itself: the arguments that it takes, and the files it includes.

xacro declares an argument by ``<xacro:arg name="…" default="…"/>``, and takes any other as well:
``$(arg NAME)`` is then what is given, and an error if nothing is. What stands in a condition or a
macro may not be looked at. Source: ``eval_all`` and ``process_include`` of xacro 2.1 (Jazzy).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from deros.diagnostics import Span
from deros.metamodels.launch_files.elements import Element

_USED = re.compile(r"(?<!\$)\$\(\s*arg\s+([^\s()]+)\s*\)|\barg\(\s*['\"]([^'\"]*)['\"]\s*\)")
_ANY_USED = re.compile(r"\barg\(\s*(?!['\"][^'\"]*['\"]\s*\))")
"""An argument whose name is computed."""
_NAMED = re.compile(r"[^$*?\[\]{}()]+")
"""The name of an included file in which nothing is computed, and that is no pattern."""
_MAYBE = frozenset({"xacro:if", "xacro:unless", "xacro:macro"})


@dataclass(slots=True)
class XacroContents:
    """What stands in one file.

    Attributes:
        arguments: that it declares, by name, each with its place.
        used: names of arguments that it uses.
        needed: of these, those that are looked at whenever the file is read.
        includes: the names of files that it includes, those of which nothing is computed.
        is_complete: whether all else that it includes and uses is known.
    """

    arguments: dict[str, Span] = field(default_factory=dict)
    used: set[str] = field(default_factory=set)
    needed: dict[str, Span] = field(default_factory=dict)
    includes: list[str] = field(default_factory=list)
    is_complete: bool = True


def xacro_contents(root: Element) -> XacroContents:
    """Return what the elements of a file say; ``-`` in their tags has become ``_``."""
    found = XacroContents()
    for element, is_sure in _elements(root, True):
        name = element.attributes.get("name", "")
        if element.tag == "xacro:arg" and name:
            if "$" in name:
                found.is_complete = False
            found.arguments.setdefault(name, element.span)
        elif element.tag == "xacro:include":
            filename = element.attributes.get("filename", "")
            if _NAMED.fullmatch(filename):
                found.includes.append(filename)
            else:
                found.is_complete = False
        for text in (*element.attributes.values(), element.text):
            for use in _USED.finditer(text):
                used = use[1] or use[2]
                found.used.add(used)
                if is_sure and use[1] and "$" not in used:
                    found.needed.setdefault(used, element.span)
            if _ANY_USED.search(text):
                found.is_complete = False
    return found


def _elements(element: Element, is_sure: bool) -> Iterator[tuple[Element, bool]]:
    """Yield all elements in the order written, and whether each is looked at in any case."""
    waiting = [(element, is_sure)]
    while waiting:
        found, sure = waiting.pop()
        yield found, sure
        inside = sure and found.tag not in _MAYBE
        waiting.extend((each, inside) for each in reversed(found.children))
