"""Differences of a graph from a model, in the words and in the data that are reported."""

from __future__ import annotations

from typing import Any

from deros.diagnostics import encodable
from deros.interfaces.durations import NS_PER_S
from deros.live.observer import printable
from deros.live.verify.differences import Difference
from deros.live.verify.graces import Event


def line(found: Difference) -> str:
    """Return a difference as one line."""
    where = f"{found.node}, {found.subject}" if found.subject else found.node
    text = f"{found.kind.word} {where}"
    if found.expected and found.seen:
        text += f": {found.seen} in place of {found.expected}"
    elif found.expected or found.seen:
        text += f": {found.expected or found.seen}"
    if found.note:
        text += f"; {found.note}"
    return encodable(printable(f"{text}{_place(found)}"))


def _place(found: Difference) -> str:
    return "" if found.span is None else f"  ({found.span.file}:{found.span.line})"


def data(found: Difference) -> dict[str, Any]:
    """Return a difference as JSON has it (``docs/running-graph.md``)."""
    span = found.span
    return {
        "kind": found.kind.word,
        "severity": found.kind.severity,
        "node": found.node,
        "subject": found.subject,
        "expected": found.expected,
        "seen": found.seen,
        "note": found.note,
        "file": None if span is None else span.file,
        "line": None if span is None else span.line,
        "column": None if span is None else span.column,
    }


def event_line(event: Event) -> str:
    """Return a difference that began, or the end of one, as one line."""
    if not event.is_over:
        return line(event.difference)
    return f"back after {event.lasted_ns / NS_PER_S:.1f} s: {line(event.difference)}"


def event_data(event: Event) -> dict[str, Any]:
    """Return the same as JSON has it."""
    lasted = round(event.lasted_ns / NS_PER_S, 3)
    return {"event": "over" if event.is_over else "differs", "lasted": lasted} | data(
        event.difference
    )
