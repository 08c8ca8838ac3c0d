"""Parameter files whose text is put under further keys: a namespace, or those of a plain file.

They are read as ROS 2 reads the file with its text there, which is what a node gets when the system
is started.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import takewhile

from deros.diagnostics import Span
from deros.metamodels.parameter_files.events import NotReadable
from deros.metamodels.parameter_files.reading import Overrides
from deros.models.parameter_files import (
    MARK,
    Document,
    Event,
    Fault,
    LoadedFile,
    Section,
    Unmovable,
)


def put_under(document: Document, keys: tuple[str, ...]) -> LoadedFile:
    """Return what a file says with all of its text under keys, the outermost first.

    An :class:`Unmovable` is returned where ROS 2 would refuse a key then or take it for another, a
    :class:`Fault` where a file that has names of nodes is read as a plain one.
    """
    if MARK in keys and (marked := _marked(document.events)):
        return Fault(f"'{MARK}' stands in a file that is read as a plain one", marked.span, _PLAIN)
    steps = tuple(_under(document.events, keys))
    try:
        sections = _read(steps)
        has_keys = any(event.kind == "mapping" for event in document.events[:1])
        strayed = _strayed(document.events, keys, sections) if keys and has_keys else None
    except NotReadable as refused:
        place = refused.fault.span.start
        above = [e for e in _absolute_keys(document.events) if e.span.start <= place]
        is_moved = above and keys and MARK not in keys
        return _unmovable(above[-1], keys[0]) if is_moved else refused.fault
    return strayed or replace(document, events=steps, sections=sections, keys=keys)


_PLAIN = "leave 'plain' out: this file says by itself for which nodes it is"


def _marked(events: Iterable[Event]) -> Event | None:
    return next((e for e in events if e.kind == "scalar" and e.text.startswith(MARK)), None)


def _unmovable(key: Event, namespace: str) -> Unmovable:
    joined = f"{namespace.rstrip('/')}/{key.text}"
    relative = key.text.lstrip("/")
    return Unmovable(
        f"'{key.text}' cannot be moved below '{namespace}': ROS 2 refuses the key '{joined}'",
        key.span,
        f"write it without the '/' at its start, '{relative}'" if relative else "",
    )


def _read(events: Iterable[Event]) -> tuple[Section, ...]:
    """Return what a file says; raise NotReadable if ROS 2 refuses it."""
    overrides: Overrides[None] = Overrides()
    overrides.read(events, None)
    return tuple(slot.section() for slot in overrides.slots)


def _strayed(
    events: tuple[Event, ...], keys: tuple[str, ...], sections: tuple[Section, ...]
) -> Unmovable | None:
    """Return the key behind which ROS 2 takes another one for a part of it.

    At the end of what is below a key, ROS 2 takes one name away from those that it has joined, and
    a key such as ``front/arm`` has joined two. At the top of a file it forgets all of them.
    """
    if MARK in keys:
        separator, start = ".", "".join(f"{key}." for key in keys[2:])
        wanted, found = _parameters(_read(_under(events, keys[:2]))), _parameters(sections)
    else:
        separator, start = "/", keys[0].rstrip("/") + "/"
        wanted, found = _nodes(_read(events)), _nodes(sections)
    differing = [span for span in found if span in wanted and found[span] != start + wanted[span]]
    if not differing:
        return None
    span = min(differing, key=lambda each: each.start)
    message = (
        f"'{wanted[span]}' cannot be moved below '{start[:-1] or '/'}': ROS 2 would read"
        f" '{found[span]}'"
    )
    key = next(_joined_before(events, span, separator), None)
    if key is None:
        return Unmovable(message, span)
    names = [f'"{n}"' if n.startswith("*") else n for n in key.text.split(separator) if n]
    nested = ": {".join(names) + ": …" + "}" * (len(names) - 1)
    hint = f"nest the names in it: '{nested}'" if names else ""
    return Unmovable(f"behind '{key.text}', {message}", key.span, hint)


def _parameters(sections: Iterable[Section]) -> dict[Span, str]:
    return {each.name_span: each.name for section in sections for each in section.values}


def _nodes(sections: Iterable[Section]) -> dict[Span, str]:
    return {span: section.key for section in sections for span in section.spans}


def _joined_before(events: Iterable[Event], place: Span, separator: str) -> Iterator[Event]:
    """Yield the keys of several names, with something below them, that end before a place."""
    above: list[Event] = []
    last: Event | None = None
    for event in takewhile(lambda each: each.kind != "scalar" or each.span != place, events):
        if event.kind == "mapping" and last is not None:
            above.append(last)
        elif event.kind == "end of mapping" and above:
            key = above.pop()
            is_parameter = separator == "/" and any(each.text.startswith(MARK) for each in above)
            if separator in key.text and not is_parameter:
                yield key
        last = event


def _absolute_keys(events: Iterable[Event]) -> Iterator[Event]:
    """Yield the keys at the top of a file that begin with ``/``."""
    depth = 0
    is_key = True
    for event in events:
        if event.kind.startswith("end"):
            depth -= 1
        elif event.kind != "scalar":
            depth += 1
        elif depth == 1 and is_key and event.text.startswith("/"):
            yield event
        if depth == 1:  # keys and values take turns; a mapping begins with a key
            is_key = event.kind == "mapping" or not is_key


def _under(events: Iterable[Event], keys: tuple[str, ...]) -> Iterator[Event]:
    """Yield the steps of a file with all that stands at its top under keys."""
    depth = 0
    for event in events:
        start = Span(event.span.source, event.span.start, event.span.start)
        if depth == 0:
            for key in keys:
                yield Event("mapping", start)
                yield Event("scalar", start, key)
        yield event
        if event.kind != "scalar":
            depth += -1 if event.kind.startswith("end") else 1
        if depth == 0:
            for _ in keys:
                yield Event("end of mapping", start)
