"""Parameter files whose text is put under further keys: a namespace, or those of a plain file.

They are read as ROS 2 reads the file with its text there, which is what a node gets when the system
is started.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from deros.diagnostics import Span
from deros.metamodels.parameter_files.events import NotReadable
from deros.metamodels.parameter_files.reading import Overrides
from deros.models.parameter_files import MARK, Document, Event, Fault, LoadedFile, Unmovable


def put_under(document: Document, keys: tuple[str, ...]) -> LoadedFile:
    """Return what a file says with all of its text under keys, the outermost first.

    An :class:`Unmovable` is returned where ROS 2 would refuse a key then, a :class:`Fault` where a
    file that has names of nodes is read as a plain one.
    """
    if MARK in keys and (marked := _marked(document.events)):
        return Fault(f"'{MARK}' stands in a file that is read as a plain one", marked.span, _PLAIN)
    steps = tuple(_under(document.events, keys))
    overrides: Overrides[None] = Overrides()
    try:
        overrides.read(steps, None)
    except NotReadable as refused:
        place = refused.fault.span.start
        above = [e for e in _absolute_keys(document.events) if e.span.start <= place]
        is_moved = above and keys and MARK not in keys
        return _unmovable(above[-1], keys[0]) if is_moved else refused.fault
    sections = tuple(slot.section() for slot in overrides.slots)
    return replace(document, events=steps, sections=sections, keys=keys)


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
