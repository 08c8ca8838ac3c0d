"""The layout for Foxglove: panels, message paths, and a tree that holds each panel once."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any

from deros.live.foxglove import Layout, Subject, layout

GUARD = Subject(
    "/r/guard",
    states={"/stop": "/stop.data"},
    parts=("action stop", "body.near"),
)
OTHER = Subject("/other", "/other/diagnostics")
GATE = Subject("/gate", has_events=False)

PANELS = {
    "DiagnosticSummary": {
        "minLevel",
        "pinnedIds",
        "hardwareIdFilter",
        "topicToRender",
        "sortByLevel",
    },
    "DiagnosticStatusPanel": {"selectedHardwareId", "selectedName", "topicToRender"},
    "StateTransitions": {"paths", "isSynced"},
    "RawMessages": {
        "topicPath",
        "diffEnabled",
        "diffMethod",
        "diffTopicPath",
        "showFullMessageForDiff",
    },
}
"""The panels' types and the keys of their configurations, as in layouts that Foxglove ships."""


def leaves(part: Any) -> Iterator[str]:
    """Yield the panels of the window."""
    if isinstance(part, str):
        yield part
    else:
        assert part["direction"] in ("row", "column")
        assert 0 < part["splitPercentage"] < 100
        yield from leaves(part["first"])
        yield from leaves(part["second"])


def paths(made: Layout) -> dict[str, str]:
    """Return the message paths by their labels."""
    (panel,) = (c for name, c in made["configById"].items() if name.startswith("StateTransitions!"))
    return {path["label"]: path["value"] for path in panel["paths"]}


def test_each_panel_stands_in_the_window_once() -> None:
    """One that is not configured would be empty, and one that is not placed invisible."""
    for subjects in ([GUARD], [GATE], [GUARD, OTHER, GATE]):
        made = json.loads(json.dumps(layout(subjects)))
        placed = list(leaves(made["layout"]))
        assert sorted(placed) == sorted(made["configById"])
        for name, config in made["configById"].items():
            assert set(config) == PANELS[name.partition("!")[0]]


def test_paths_select_the_statuses_by_name() -> None:
    """States come from the topics of actions, levels from the diagnostics."""
    assert paths(layout([GUARD, OTHER])) == {
        "/stop": "/stop.data",
        "r/guard": '/diagnostics.status[:]{name=="/r/guard"}.level',
        "r/guard: action stop": '/diagnostics.status[:]{name=="/r/guard: action stop"}.level',
        "r/guard: body.near": '/diagnostics.status[:]{name=="/r/guard: body.near"}.level',
        "other": '/other/diagnostics.status[:]{name=="/other"}.level',
    }


def test_each_topic_of_diagnostics_and_of_events_has_a_panel() -> None:
    """A gate has no events."""
    panels = layout([GUARD, OTHER, GATE])["configById"].values()
    summaries = [panel["topicToRender"] for panel in panels if "minLevel" in panel]
    events = [panel["topicPath"] for panel in panels if "topicPath" in panel]
    assert summaries == ["/diagnostics", "/other/diagnostics"]
    assert events == ["/r/guard/events", "/other/events"]


def test_names_that_would_end_a_filter_are_left_out() -> None:
    """Anybody can publish a status with quotation marks in its name."""
    made = layout([Subject("/guard", parts=('a"}.level', "a.b", "x y", ""))])
    assert all(re.fullmatch(r'[^"]*("[^"]*")?[^"]*', path) for path in paths(made).values())
    assert set(paths(made)) == {"guard", "guard: a.b"}
