"""The elements of a launch file in YAML.

An alias stands for a part of the file elsewhere. It is not followed, so that nothing can grow; what
it stands for is not known.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from deros.diagnostics import SourceFile, Span
from deros.metamodels.launch_files.elements import MOST, Element, NotALaunchFile, NotRead
from deros.metamodels.parameter_files.events import DEEPEST, span_of, yaml_fault

_Value = str | list[Any] | dict[str, Any] | None
"""A scalar, a list of values with their spans, a mapping, or what is not known."""


def yaml_elements(source: SourceFile) -> Element:
    """Return the root of a file: its one key.

    Raises:
        NotALaunchFile: it is not YAML.
        NotRead: it is not read here.
    """
    import yaml

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        events = _checked(yaml.parse(source.text, Loader=loader))
        value, span = _value(next(events, None), events, source)
    except yaml.YAMLError as error:
        fault = yaml_fault(error, source)
        raise NotALaunchFile(fault.message, fault.span) from error
    whole = Span(source, 0, 0)
    if not isinstance(value, dict) or len(value) != 1:
        message = "a launch file in YAML is one key, 'launch', with a list of actions"
        raise NotALaunchFile(message, span or whole)
    ((tag, (inner, place)),) = value.items()
    return _element(tag, inner, place)


def _checked(events: Iterator[Any]) -> Iterator[Any]:
    """Yield the events that stand for values, and refuse too many of them."""
    depth = count = 0
    for event in events:
        kind = type(event).__name__
        if kind.startswith(("Stream", "Document")):
            continue
        depth += kind.endswith("StartEvent")
        depth -= kind.endswith("EndEvent")
        count += 1
        if depth > DEEPEST or count > MOST:
            raise NotRead
        yield event


def _value(event: Any, events: Iterator[Any], source: SourceFile) -> tuple[_Value, Span | None]:
    """Return the value that begins with an event, and the place where it begins."""
    kind = type(event).__name__
    if event is None or kind == "AliasEvent":
        return None, None
    span = span_of(event, source)
    if kind == "ScalarEvent":
        return str(event.value), span
    if kind == "SequenceStartEvent":
        items = []
        while type(event := next(events)).__name__ != "SequenceEndEvent":
            items.append(_value(event, events, source))
        return items, span
    found: dict[str, Any] = {}
    while type(event := next(events)).__name__ != "MappingEndEvent":
        key, place = _value(event, events, source)
        value, _ = _value(next(events), events, source)
        if isinstance(key, str) and place is not None:
            found[key] = value, place
    return found, span


def _element(tag: str, value: _Value, span: Span) -> Element:
    """Return what a key and its value stand for: texts are attributes, lists are elements."""
    found = Element(tag.replace("-", "_"), span, {})
    if value is None:
        return replace(found, is_whole=False)
    if isinstance(value, list):
        children = [child for item, _ in value for child in _children(item)]
        return replace(
            found, children=children, is_whole=all(isinstance(item, dict) for item, _ in value)
        )
    if not isinstance(value, dict):
        return replace(found, texts=[value])
    attributes: dict[str, str] = {}
    children = []
    is_whole = True
    for key, (inner, place) in value.items():
        if isinstance(inner, str):
            attributes[key] = inner
        elif isinstance(inner, list) and key != "children":
            # Of several elements with one name, the key is the name of each.
            children += [_element(key, item, place) for item, _ in inner]
        elif inner is None:
            is_whole = False
        else:
            children += _element(key, inner, place).children
    return replace(found, attributes=attributes, children=children, is_whole=is_whole)


def _children(item: _Value) -> Iterator[Element]:
    """Yield the actions in one item of a list of actions."""
    if isinstance(item, dict):
        for key, (inner, place) in item.items():
            yield _element(key, inner, place)
