"""A layout for Foxglove that shows safety nodes: diagnostics, states over time, events.

The format is that of the files that Foxglove exports and imports: each panel has an id of its type
and a suffix, its configuration stands below ``configById``, and ``layout`` is a tree that divides
the window.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

DIAGNOSTICS = "/diagnostics"
"""The common topic, which is the one of placeholders."""

_PART = re.compile(r"(?:action )?[A-Za-z_][A-Za-z0-9_.]*")
"""Parts of a node whose names need no quoting in a message path."""

Layout = dict[str, Any]


@dataclass(frozen=True)
class Subject:
    """A node of the layout.

    Attributes:
        node: its full name.
        diagnostics: the topic of its diagnostics.
        has_events: whether it publishes events, as safety nodes do.
        states: message paths of what its actions publish, by a label.
        parts: the names of its statuses: of actions and rules.
    """

    node: str
    diagnostics: str = DIAGNOSTICS
    has_events: bool = True
    states: Mapping[str, str] | None = None
    parts: tuple[str, ...] = ()


def layout(subjects: Sequence[Subject]) -> Layout:
    """Return the layout for some nodes, ready for JSON."""
    panels: Layout = {}
    left = _left(panels, subjects)
    right = _right(panels, subjects)
    return {
        "configById": panels,
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": _split("row", [left, right], 40),
    }


def _left(panels: Layout, subjects: Sequence[Subject]) -> Any:
    """Add the panels of diagnostics; return their part of the window."""
    topics = list(dict.fromkeys(each.diagnostics for each in subjects))
    ids = []
    for number, topic in enumerate(topics, 1):
        panels[f"DiagnosticSummary!deros{number}"] = {
            "minLevel": 0,
            "pinnedIds": [],
            "hardwareIdFilter": "",
            "topicToRender": topic,
            "sortByLevel": True,
        }
        ids.append(f"DiagnosticSummary!deros{number}")
    first = subjects[0]
    panels["DiagnosticStatusPanel!deros"] = {
        "selectedHardwareId": "",
        "selectedName": first.node,
        "topicToRender": first.diagnostics,
    }
    return _split("column", [*ids, "DiagnosticStatusPanel!deros"], 60)


def _right(panels: Layout, subjects: Sequence[Subject]) -> Any:
    """Add the panels of states over time and of events; return their part of the window."""
    paths = [path for each in subjects for path in _paths(each)]
    panels["StateTransitions!deros"] = {"paths": paths, "isSynced": True}
    ids = ["StateTransitions!deros"]
    for number, subject in enumerate((each for each in subjects if each.has_events), 1):
        panels[f"RawMessages!deros{number}"] = {
            "topicPath": f"{subject.node}/events",
            "diffEnabled": False,
            "diffMethod": "custom",
            "diffTopicPath": "",
            "showFullMessageForDiff": False,
        }
        ids.append(f"RawMessages!deros{number}")
    return _split("column", ids, 60)


def _paths(subject: Subject) -> list[Layout]:
    found = dict(subject.states or {})
    for part in ("", *subject.parts):
        if not part or _PART.fullmatch(part):
            name = f"{subject.node}: {part}" if part else subject.node
            label = name.removeprefix("/")
            found[label] = f'{subject.diagnostics}.status[:]{{name=="{name}"}}.level'
    return [
        {"value": path, "label": label, "enabled": True, "timestampMethod": "receiveTime"}
        for label, path in found.items()
    ]


def _split(direction: str, parts: Sequence[Any], percentage: int) -> Any:
    """Divide a part of the window: the first part gets its share, the others divide the rest."""
    if len(parts) == 1:
        return parts[0]
    second = _split(direction, parts[1:], 50)
    return {
        "direction": direction,
        "first": parts[0],
        "second": second,
        "splitPercentage": percentage,
    }
