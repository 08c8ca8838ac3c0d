"""The text of a launch file in XML."""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Iterator

from deros.generators.system.frontends.elements import Comment, Element, ReadAsYaml, Value
from deros.generators.system.script.standalone.command_line import yaml
from deros.generators.text.python import LINE_LENGTH
from deros.generators.text.yaml import is_plain_text

_ENTITIES = {"&": "&amp;", "<": "&lt;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;"}


def print_xml(root: Element, head: str) -> str:
    """Return the text of a launch file.

    Args:
        root: the element ``launch``.
        head: what the file is, for a comment.
    """
    declaration = '<?xml version="1.0" encoding="UTF-8"?>'
    return "\n".join([declaration, *_comment(head, ""), *_lines(root, ""), ""])


def _lines(found: Element | Comment, margin: str) -> Iterator[str]:
    if isinstance(found, Comment):
        yield from _comment(found.text, margin)
        return
    inside = (*found.details, *(found.children or ()))
    yield from _start(found, margin, ">" if inside else "/>")
    for each in inside:
        yield from _lines(each, f"{margin}  ")
    if inside:
        yield f"{margin}</{found.tag}>"


def _start(found: Element, margin: str, end: str) -> Iterator[str]:
    written = [f"{name}={_quoted(_text(value))}" for name, value in found.attributes]
    line = f"{margin}{' '.join((f'<{found.tag}', *written))}{end}"
    if len(line) <= LINE_LENGTH or len(written) < 2:
        yield line
        return
    yield f"{margin}<{found.tag}"
    yield from (f"{margin}    {each}" for each in written[:-1])
    yield f"{margin}    {written[-1]}{end}"


def _text(value: Value) -> str:
    """Return a value as launch_xml, or YAML in an attribute of it, reads it."""
    if isinstance(value, ReadAsYaml):
        return value.text if is_plain_text(value.text) else yaml(value.text)
    if isinstance(value, str):
        return value
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)  # it is read by float()
    return yaml(value)


def _quoted(text: str) -> str:
    """Return the text of an attribute between the quotes of which it has fewer."""
    inside = re.sub("[&<\t\n\r]", lambda found: _ENTITIES[found[0]], text)
    if text.count('"') > text.count("'"):
        return "'" + inside.replace("'", "&apos;") + "'"
    return '"' + inside.replace('"', "&quot;") + '"'


def _comment(text: str, margin: str) -> Iterator[str]:
    """Yield a comment, which has no ``--`` in it."""
    inside = re.sub("-(?=-|$)", "- ", text).rstrip()
    first, after = f"{margin}<!-- ", f"{margin}     "
    yield from textwrap.wrap(
        f"{inside} -->", LINE_LENGTH, initial_indent=first, subsequent_indent=after
    )
