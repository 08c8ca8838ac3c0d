"""The text of a launch file in YAML."""

from __future__ import annotations

import itertools
import re
import textwrap
from collections.abc import Iterator

from deros.generators.system.frontends.elements import Comment, Element, ReadAsYaml, Value
from deros.generators.system.script.standalone.command_line import yaml
from deros.generators.text.python import LINE_LENGTH
from deros.generators.text.yaml import is_plain_text

_ONE_LINE = re.compile("[\x20-\x7e\xa0-\u2027\u202a-\ud7ff\ue000-\ufefe\uff00-\ufffd]*")


def print_yaml(root: Element, head: str) -> str:
    """Return the text of a launch file.

    Args:
        root: the element ``launch``.
        head: what the file is, for a comment.
    """
    assert root.children is not None
    return "\n".join(
        [
            *_comment(head, ""),
            "---",
            f"{root.tag}:{_nothing(root)}",
            *_actions(root.children, ""),
            "",
        ]
    )


def _nothing(found: Element) -> str:
    return "" if found.children and any(isinstance(e, Element) for e in found.children) else " []"


def _actions(found: tuple[Element | Comment, ...], margin: str) -> Iterator[str]:
    for each in found:
        if isinstance(each, Comment):
            yield from _comment(each.text, margin)
        elif each.children is not None and not each.attributes and not each.details:
            yield f"{margin}- {each.tag}:{_nothing(each)}"
            yield from _actions(each.children, f"{margin}    ")
        else:
            yield f"{margin}- {each.tag}:"
            yield from _inside(each, f"{margin}    ")


def _inside(found: Element, margin: str) -> Iterator[str]:
    for name, value in found.attributes:
        yield f"{margin}{name}: {_text(value)}"
    tags = dict.fromkeys(each.tag for each in found.details)
    for tag in tags:
        yield f"{margin}{tag}:"
        for each in (detail for detail in found.details if detail.tag == tag):
            marks = itertools.chain(["- "], itertools.repeat("  "))
            for mark, line in zip(marks, _inside(each, ""), strict=False):
                yield f"{margin}{mark}{line}"
    if found.children is not None:
        yield f"{margin}children:{_nothing(found)}"
        yield from _actions(found.children, margin)


def _text(value: Value) -> str:
    text = value.text if isinstance(value, ReadAsYaml) else value
    if not isinstance(text, str):
        return yaml(text)
    if is_plain_text(text):
        return text
    if _ONE_LINE.fullmatch(text) and ("\\" in text or '"' in text):
        return "'" + text.replace("'", "''") + "'"
    return yaml(text)


def _comment(text: str, margin: str) -> Iterator[str]:
    mark = f"{margin}# "
    yield from textwrap.wrap(text, LINE_LENGTH, initial_indent=mark, subsequent_indent=mark)
