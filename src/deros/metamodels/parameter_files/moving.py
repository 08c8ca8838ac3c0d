"""Parameter files whose keys are moved below a namespace.

They are read as ROS 2 reads the file with its text under one more key, which is what a node gets
when the system is started.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from deros.diagnostics import Span
from deros.metamodels.parameter_files.events import NotReadable
from deros.metamodels.parameter_files.reading import Overrides
from deros.models.parameter_files import Document, Event, LoadedFile, Unmovable


def moved_below(document: Document, namespace: str) -> LoadedFile:
    """Return a file with all of its keys below a namespace.

    An :class:`Unmovable` is returned where ROS 2 would refuse the file then.
    """
    steps = tuple(_below(document.events, namespace))
    overrides: Overrides[None] = Overrides()
    try:
        overrides.read(steps, None)
    except NotReadable as refused:
        place = refused.fault.span.start
        above = [e for e in _absolute_keys(document.events) if e.span.start <= place]
        return _unmovable(above[-1], namespace) if above else refused.fault
    sections = tuple(slot.section() for slot in overrides.slots)
    return Document(document.source, document.path, steps, sections, namespace)


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


def _below(events: Iterable[Event], namespace: str) -> Iterator[Event]:
    """Yield the steps of a file with all that stands at its top under a key."""
    depth = 0
    for event in events:
        start = Span(event.span.source, event.span.start, event.span.start)
        if depth == 0:
            yield Event("mapping", start)
            yield Event("scalar", start, namespace)
        yield event
        if event.kind != "scalar":
            depth += -1 if event.kind.startswith("end") else 1
        if depth == 0:
            yield Event("end of mapping", start)
