"""The steps in which a YAML parser reads a file, with positions.

ROS 2 reads parameter files with libyaml. PyYAML has that library inside; where it was built without
it, its own parser in Python follows the same rules.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from deros.diagnostics import SourceFile, Span
from deros.models.parameter_files import Event, Fault

_STRING_TAG = "tag:yaml.org,2002:str"
_KINDS = {
    "SequenceStartEvent": "list",
    "SequenceEndEvent": "end of list",
    "MappingStartEvent": "mapping",
    "MappingEndEvent": "end of mapping",
}
_MOST_EVENTS = 200_000
DEEPEST = 100
"""Levels of nesting: hand-written files stay below ten."""


class NotReadable(Exception):  # noqa: N818 - it carries a fault of the file
    """The file is no YAML, or ROS 2 refuses it; ``fault`` says why."""

    def __init__(self, fault: Fault) -> None:
        super().__init__(fault.message)
        self.fault = fault


def events(source: SourceFile) -> tuple[Event, ...]:
    """Return the steps in which a file is read.

    Raises:
        NotReadable: it is no YAML, or has an alias, which ROS 2 refuses.
    """
    return tuple(_events(source))


def _events(source: SourceFile) -> Iterator[Event]:
    import yaml

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    depth = count = braces = 0
    try:
        for event in yaml.parse(source.text, Loader=loader):
            found = _event(event, source, is_in_braces=braces > 0)
            if found is None:
                continue
            depth += {"list": 1, "mapping": 1}.get(found.kind, 0)
            depth -= found.kind.startswith("end")
            if braces or getattr(event, "flow_style", False):  # what is inside is written so, too
                braces += {"list": 1, "mapping": 1}.get(found.kind, 0)
                braces -= found.kind.startswith("end")
            count += 1
            if depth > DEEPEST or count > _MOST_EVENTS:
                what = f"nested more than {DEEPEST} levels deep"
                what = what if depth > DEEPEST else "longer than any parameter file"
                raise NotReadable(Fault(f"this file is {what}", found.span))
            yield found
    except yaml.YAMLError as error:
        raise NotReadable(yaml_fault(error, source)) from error


def _event(event: Any, source: SourceFile, *, is_in_braces: bool) -> Event | None:
    """Return an event, without those of documents and of the stream."""
    name = type(event).__name__
    if name == "AliasEvent":
        message = f"ROS 2 does not read aliases, and '*{event.anchor}' is one"
        hint = "write the value itself in each place"
        raise NotReadable(Fault(message, span_of(event, source), hint))
    if name == "ScalarEvent":
        is_quoted = event.style in ('"', "'")
        is_text = is_quoted or event.tag == _STRING_TAG
        span = span_of(event, source)
        return Event("scalar", span, event.value, is_text, is_quoted, is_in_braces)
    if name not in _KINDS:
        return None
    return Event(_KINDS[name], span_of(event, source))  # type: ignore[arg-type]


def span_of(event: Any, source: SourceFile) -> Span:
    """Return the place of an event."""
    start, end = event.start_mark.index, event.end_mark.index
    # A block text ends with the line breaks behind it; and an empty place is pointed at, too.
    end = start + len(source.text[start:end].rstrip())
    return Span(source, start, max(end, start))


def yaml_fault(error: Any, source: SourceFile) -> Fault:
    """Return where and why a file is no YAML, in the parser's words."""
    marks = [getattr(error, name, None) for name in ("problem_mark", "context_mark")]
    said = [getattr(error, name, None) for name in ("context", "problem")]
    positions = [_index(mark, source) for mark in marks if mark is not None]
    # What is not closed is missed at the end of the file: it begins where it is to be corrected.
    inside = [each for each in positions if each < len(source.text.rstrip())]
    position = next(iter((*inside, *positions)), getattr(error, "position", 0))
    position = min(position, len(source.text))
    text = " ".join(filter(None, said)) or "a character that has no place in it"
    span = Span(source, position, min(position + 1, len(source.text)))
    return Fault(f"this is not YAML: {text}", span, "correct it: ROS 2 ends a node that reads it")


def _index(mark: Any, source: SourceFile) -> int:
    """Return the offset of a mark; libyaml's in errors have line and column only."""
    line, column = int(mark.line), int(mark.column)
    lines = source.text.split("\n")
    if line >= len(lines):
        return len(source.text)
    return sum(len(each) + 1 for each in lines[:line]) + min(column, len(lines[line]))
