"""The table of ``deros watch``: every node, action and rule, and the last events."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from datetime import datetime
from itertools import groupby
from typing import TYPE_CHECKING, NamedTuple

from deros.live.changes import duration, outlook, silence, terms, why

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

    from deros.live.watched import (
        WatchedAction,
        WatchedEvent,
        WatchedInput,
        WatchedNode,
        WatchedRule,
    )

HEADER = ("NODE", "STATE", "WHY", "SINCE", "NEXT")
EVENT_HEADER = ("TIME", "EVENT", "TEXT")

_TEXTS = ("WHY", "TEXT")
"""The columns with whole sentences."""

_LEAST = 40
"""Percentage of the width that these have at least, before names are cut off for them."""

_LEAST_NAME = 8
"""Columns that names have at least, before texts are cut off further."""

_LEAST_HEIGHT = 9
"""Lines below which events are left out."""

_STYLES = {
    "ok": "green",
    "false": "green",
    "warning": "yellow",
    "active": "yellow",
    "true": "yellow",
    "unknown": "magenta",
    "never": "magenta",
    "error": "red",
    "silent": "red",
}
_WALL_CLOCK_NS = 10**18
"""ROS times from the year 2001 on are taken for wall time: simulated time begins at 0."""


Cells = tuple[str, str, str, str, str]


class Row(NamedTuple):
    """A row of the table.

    Attributes:
        cells: the texts.
        is_quiet: whether it may be left out where there is too little room: a rule that is false,
            an action that is inactive, or an input.
        style: of the state; empty for the one that its word has.
    """

    cells: Cells
    is_quiet: bool = False
    style: str = ""


def rows(nodes: Iterable[WatchedNode]) -> list[Row]:
    """Return the rows: each node, with its actions, rules and inputs below it."""
    found = []
    for node in nodes:
        found.append(_node_row(node))
        is_silent = node.silent_s is not None
        found += [_action_row(action, is_silent) for action in node.actions]
        found += [_rule_row(rule, is_silent) for rule in node.rules]
        found += [_input_row(each, is_silent) for each in node.inputs]
    return found


def fitted(every: Sequence[Row], room: int) -> list[Row]:
    """Return as many rows as there is room for.

    Quiet rows are left out first, the last ones before others; a last row says how many rows are
    not shown.
    """
    if len(every) <= room:
        return list(every)
    excess = len(every) - max(room - 1, 1)
    quiet = [number for number, row in enumerate(every) if row.is_quiet]
    dropped = set(quiet[max(len(quiet) - excess, 0) :])
    kept = [row for number, row in enumerate(every) if number not in dropped]
    kept = kept[: max(room - 1, 1)]
    missing = len(every) - len(kept)
    return [*kept, Row((f"  ... {missing} more", "", "", "", ""))]


def event_rows(events: Sequence[WatchedEvent]) -> list[tuple[str, str, str]]:
    """Return the rows of events, the oldest first; the node is named if there are several.

    Equal events one after the other are one row, with the time of the last and their number: some
    behaviours run an action at each message.
    """
    several = len({event.node for event in events}) > 1
    found = []
    for (node, kind, message), equal in groupby(events, key=_words):
        *_, last = times = [event.ros_time_ns for event in equal]
        text = f"{node}: {message}" if several else message
        found.append((ros_time(last), kind, f"{len(times)} x {text}" if len(times) > 1 else text))
    return found


def _words(event: WatchedEvent) -> tuple[str, str, str]:
    return event.node, event.kind, event.message


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
    count: int,
    width: int | None,
    height: int | None,
) -> RenderableType:
    """Return what is drawn.

    Args:
        nodes: to show.
        events: the oldest first.
        count: rows of events that are shown, the last ones.
        width: columns that there are; ``None`` for as many as are needed.
        height: lines that there are; ``None`` for as many as are needed.
    """
    from rich.console import Group

    every = rows(nodes)
    last = _last(event_rows(events), count)
    if height is None:
        shown = every
    else:
        room = height // 3 if height >= _LEAST_HEIGHT else 0
        last = _last(last, room)
        below = len(last) + 2 if last else 0  # an empty line and the header
        shown = fitted(every, max(height - 1 - below, 2))
    styles = [row.style or _STYLES.get(row.cells[1], "") for row in shown]
    header, cells = _with_room(HEADER, [row.cells for row in shown], width)
    parts: list[RenderableType] = [_table(header, cells, styles, width)]
    if last:
        parts += ["", _table(EVENT_HEADER, last, [""] * len(last), width)]
    return Group(*parts)


def _with_room(
    header: Sequence[str], cells: Sequence[Sequence[str]], width: int | None
) -> tuple[Sequence[str], Sequence[Sequence[str]]]:
    """Return the columns that there is room for: names are not cut off for what comes next."""
    if width is not None:
        needed = _needed(header, cells)
        needed[header.index("WHY")] = _LEAST * width // 100
        if sum(needed) + 2 * (len(needed) - 1) > width:
            return header[:-1], [each[:-1] for each in cells]
    return header, cells


def _needed(header: Sequence[str], cells: Sequence[Sequence[str]]) -> list[int]:
    """Return the columns that the widest text of each part of a row takes."""
    from rich.cells import cell_len

    return [max(map(cell_len, column)) for column in zip(header, *cells, strict=True)]


def _last(rows: list[tuple[str, str, str]], count: int) -> list[tuple[str, str, str]]:
    return rows[max(len(rows) - count, 0) :]


def _table(
    header: Sequence[str], cells: Sequence[Sequence[str]], styles: Sequence[str], width: int | None
) -> Table:
    """Return a table; styles are those of the second cell of each row."""
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False)
    for name, columns in zip(header, _widths(header, cells, width), strict=True):
        table.add_column(name, no_wrap=True, overflow="ellipsis", width=columns)
    for (name, state, *others), style in zip(cells, styles, strict=True):
        table.add_row(Text(name), Text(state, style), *map(Text, others))
    return table


def _widths(header: Sequence[str], cells: Sequence[Sequence[str]], width: int | None) -> list[int]:
    """Return the columns of each part of a row: texts give way first, then names.

    States and times are short, and are never cut off.
    """
    needed = _needed(header, cells)
    if width is None:
        return needed
    text = next(number for number, name in enumerate(header) if name in _TEXTS)
    gaps = 2 * (len(needed) - 1)
    for number, least in ((text, _LEAST * width // 100), (0, _LEAST_NAME), (text, 1)):
        excess = sum(needed) + gaps - width
        needed[number] -= max(min(excess, needed[number] - least), 0)
    return needed


def _node_row(node: WatchedNode) -> Row:
    if node.silent_s is not None:
        return Row((node.node, "silent", silence(node), duration(node.silent_s), ""))
    return Row((node.node, node.level, node.message, duration(node.since_s), ""))


def _action_row(action: WatchedAction, is_silent: bool) -> Row:
    state = f"was {action.message}" if is_silent else action.message
    name, since = f"  action {action.name}", duration(action.since_s)
    text = why(action) if action.is_active else ""
    return Row((name, state, text, "" if is_silent else since, ""), not action.is_active)


def _rule_row(rule: WatchedRule, is_silent: bool) -> Row:
    if is_silent:
        return Row((f"  {rule.name}", f"was {rule.verdict}", "", "", ""), rule.verdict == "false")
    why, since = rule.cause or terms(rule), duration(rule.since_s)
    cells = (f"  {rule.name}", rule.verdict, why, since, outlook(rule))
    return Row(cells, rule.verdict == "false", "red" if rule.is_blamed else "")


def _input_row(each: WatchedInput, is_silent: bool) -> Row:
    state = "received" if each.is_received else "never"
    shown = f"was {state}" if is_silent else state
    return Row((f"  input {each.name}", shown, "", duration(each.age_s), ""), is_quiet=True)
