"""The table of ``deros watch``: every node, action and rule, and the last events."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from datetime import datetime
from typing import TYPE_CHECKING, NamedTuple

from deros.live.changes import duration, silence, terms, why

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

    from deros.live.watched import WatchedAction, WatchedEvent, WatchedNode, WatchedRule

HEADER = ("NODE", "STATE", "WHY", "SINCE")
EVENT_HEADER = ("TIME", "EVENT", "TEXT")

_TEXTS = ("WHY", "TEXT")
"""The columns with whole sentences."""

_LEAST = 40
"""Percentage of the width that these have at least, before names are cut off for them."""

_STYLES = {
    "ok": "green",
    "false": "green",
    "warning": "yellow",
    "active": "yellow",
    "true": "yellow",
    "unknown": "magenta",
    "error": "red",
    "silent": "red",
    "true, acted on": "red",
}
_WALL_CLOCK_NS = 10**18
"""ROS times from the year 2001 on are taken for wall time: simulated time begins at 0."""


class Row(NamedTuple):
    """A row of the table.

    Attributes:
        cells: the texts.
        is_quiet: whether it may be left out where there is too little room: a rule that is false,
            or an action that is inactive.
    """

    cells: tuple[str, str, str, str]
    is_quiet: bool = False


def rows(nodes: Iterable[WatchedNode]) -> list[Row]:
    """Return the rows: each node, with its actions and rules below it."""
    found = []
    for node in nodes:
        found.append(_node_row(node))
        is_silent = node.silent_s is not None
        found += [_action_row(action, is_silent) for action in node.actions]
        found += [_rule_row(rule, is_silent) for rule in node.rules]
    return found


def fitted(every: Sequence[Row], room: int) -> list[tuple[str, str, str, str]]:
    """Return the cells of as many rows as there is room for.

    Quiet rows are left out first, the last ones before others; a last row says how many rows are
    not shown.
    """
    if len(every) <= room:
        return [row.cells for row in every]
    excess = len(every) - max(room - 1, 1)
    quiet = [number for number, row in enumerate(every) if row.is_quiet]
    dropped = set(quiet[max(len(quiet) - excess, 0) :])
    kept = [row for number, row in enumerate(every) if number not in dropped]
    kept = kept[: max(room - 1, 1)]
    missing = len(every) - len(kept)
    return [*(row.cells for row in kept), (f"  ... {missing} more", "", "", "")]


def event_rows(events: Sequence[WatchedEvent]) -> list[tuple[str, str, str]]:
    """Return the rows of events, the oldest first; the node is named if there are several."""
    several = len({event.node for event in events}) > 1
    return [
        (
            ros_time(event.ros_time_ns),
            event.kind,
            f"{event.node}: {event.message}" if several else event.message,
        )
        for event in events
    ]


def ros_time(time_ns: int | None) -> str:
    """Return a time of ROS: the local time of day, or seconds of simulated time."""
    if time_ns is None:
        return ""
    if time_ns < _WALL_CLOCK_NS:
        return f"{time_ns / 1e9:.3f} s"
    moment = datetime.fromtimestamp(time_ns / 1e9).astimezone()
    return f"{moment:%H:%M:%S}.{moment.microsecond // 1000:03}"


def picture(
    nodes: Sequence[WatchedNode],
    events: Sequence[WatchedEvent],
    width: int | None,
    height: int | None,
) -> RenderableType:
    """Return what is drawn.

    Args:
        nodes: to show.
        events: to show, the oldest first.
        width: columns that there are; ``None`` for as many as are needed.
        height: lines that there are; ``None`` for as many as are needed.
    """
    from rich.console import Group

    every = rows(nodes)
    last = event_rows(events)
    if height is None:
        shown = [row.cells for row in every]
    else:
        last = last[len(last) - min(len(last), height // 3) :]
        below = len(last) + 2 if last else 0  # an empty line and the header
        shown = fitted(every, max(height - 1 - below, 2))
    parts: list[RenderableType] = [_table(HEADER, shown, width)]
    if last:
        parts += ["", _table(EVENT_HEADER, last, width)]
    return Group(*parts)


def _table(header: Sequence[str], cells: Sequence[Sequence[str]], width: int | None) -> Table:
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False)
    for name, columns in zip(header, _widths(header, cells, width), strict=True):
        table.add_column(name, no_wrap=True, overflow="ellipsis", width=columns)
    for row in cells:
        table.add_row(*(Text(cell, style=_STYLES.get(cell, "")) for cell in row))
    return table


def _widths(header: Sequence[str], cells: Sequence[Sequence[str]], width: int | None) -> list[int]:
    """Return the columns of each part of a row: texts give way first, then names.

    States and times are short, and are never cut off.
    """
    from rich.cells import cell_len

    needed = [max(map(cell_len, column)) for column in zip(header, *cells, strict=True)]
    if width is None:
        return needed
    free = width - 2 * (len(needed) - 1) - sum(needed)
    text = next(number for number, name in enumerate(header) if name in _TEXTS)
    if free < 0:
        given = min(-free, max(needed[text] - _LEAST * width // 100, 0))
        needed[text] -= given
        needed[0] = max(needed[0] + free + given, 8)
    return needed


def _node_row(node: WatchedNode) -> Row:
    if node.silent_s is not None:
        return Row((node.node, "silent", silence(node), duration(node.silent_s)))
    return Row((node.node, node.level, node.message, duration(node.since_s)))


def _action_row(action: WatchedAction, is_silent: bool) -> Row:
    state = f"was {action.message}" if is_silent else action.message
    name, since = f"  action {action.name}", duration(action.since_s)
    text = why(action) if action.is_active else ""
    return Row((name, state, text, "" if is_silent else since), not action.is_active)


def _rule_row(rule: WatchedRule, is_silent: bool) -> Row:
    state = "true, acted on" if rule.verdict == "true" and rule.is_blamed else rule.verdict
    if is_silent:
        return Row((f"  {rule.name}", f"was {rule.verdict}", "", ""), rule.verdict == "false")
    cells = (f"  {rule.name}", state, rule.cause or terms(rule), duration(rule.since_s))
    return Row(cells, rule.verdict == "false")
