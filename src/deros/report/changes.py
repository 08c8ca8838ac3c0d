"""Changes between two versions of models, as text and as JSON."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from deros.diagnostics import Span, encodable
from deros.diff.changes import Change
from deros.diff.models import FileChanges

_SIGNS = {"removed": "-", "added": "+", "changed": "~"}

ShownPath = Callable[[str], str]
"""Returns the path that users know a file of the old version by, given the one it was read from."""


def as_text(found: Sequence[FileChanges], shown: ShownPath) -> Iterator[str]:
    """Yield the lines of a report for people: one group for each file, and the numbers."""
    for file in found:
        yield encodable(_title(file))
        for change in file.changes:
            yield encodable(f"  {_line(change)}{_places(change, shown)}")
            if change.breaks:
                yield encodable(f"      breaking: {change.breaks}")
    yield _numbers(found)


def _numbers(found: Sequence[FileChanges]) -> str:
    changes = sum(len(each.changes) for each in found)
    if not changes:
        return "no change"
    words = "1 change" if changes == 1 else f"{changes} changes"
    return f"{words}, {sum(len(each.breaking) for each in found) or 'none'} breaking"


def _title(file: FileChanges) -> str:
    if file.old is None or file.new is None or file.old == file.new:
        return file.new or file.old or ""
    return f"{file.old} -> {file.new}"


def _line(change: Change) -> str:
    what = f"{_SIGNS[change.kind]} {change.part} {change.name}"
    if change.kind == "changed":
        return f"{what}, {change.aspect}: {change.old} -> {change.new}"
    about = change.new if change.old is None else change.old
    return f"{what}: {about}" if about else what


def _places(change: Change, shown: ShownPath) -> str:
    places = []
    if change.old_span is not None:
        places.append(f"{shown(change.old_span.file)}:{change.old_span.line}")
    if change.new_span is not None:
        places.append(f"{change.new_span.file}:{change.new_span.line}")
    return f"  ({' -> '.join(places)})" if places else ""


def as_json(found: Sequence[FileChanges], shown: ShownPath) -> str:
    """Return the report for programs, whose form is documented in ``docs/command-line.md``."""
    report = {
        "changes": sum(len(each.changes) for each in found),
        "breaking": sum(len(each.breaking) for each in found),
        "files": [
            {
                "old": file.old,
                "new": file.new,
                "changes": [_data(change, shown) for change in file.changes],
            }
            for file in found
        ],
    }
    return json.dumps(report, indent=2)


def _data(change: Change, shown: ShownPath) -> dict[str, Any]:
    return {
        "kind": change.kind,
        "part": change.part,
        "name": change.name,
        "aspect": change.aspect,
        "old": change.old,
        "new": change.new,
        "breaking": bool(change.breaks),
        "why": change.breaks,
        "old_place": _place(change.old_span, shown),
        "new_place": _place(change.new_span, lambda path: path),
    }


def _place(span: Span | None, shown: ShownPath) -> dict[str, Any] | None:
    if span is None:
        return None
    return {"file": shown(span.file), "line": span.line, "column": span.column}
