"""The table of ``deros watch``, drawn from reports: widths, heights, words without colour."""

from __future__ import annotations

import io
import re
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from rich.cells import cell_len
from rich.console import Console

from deros.cli.commands.watching.table import Row, event_rows, fitted, picture, ros_time, rows
from deros.live.watched import Watched, WatchedEvent
from tests.support.drawn_diagnostics import Drawn, status
from tests.support.watched_robot import (
    GATE,
    GUARD,
    OK,
    REPORT,
    START,
    TRIGGER,
    WARN,
    Clock,
    watched,
)

PAGE = Path(__file__).resolve().parents[4] / "docs" / "safety-node.md"


@pytest.fixture(autouse=True)
def _utc(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Times of day are those of UTC."""
    monkeypatch.setenv("TZ", "UTC")
    time.tzset()
    yield
    monkeypatch.undo()
    time.tzset()


def drawn(found: Watched, width: int | None = 80, height: int | None = None) -> list[str]:
    """Return the lines of the table, as a terminal without colours shows them."""
    out = io.StringIO()
    events = found.events("/guard")
    Console(file=out, width=width or 1000, no_color=True, emoji=False).print(
        picture(found.nodes(), events, 5, width, height)
    )
    return [line.rstrip() for line in out.getvalue().splitlines()]


def test_documented_table_is_the_one_that_is_drawn() -> None:
    """The page shows the table of the drawn robot, in 100 columns."""
    shown = re.search(r"```console\n\$ deros watch\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    assert shown
    assert shown[1].splitlines() == drawn(watched(Clock()), width=100)


@pytest.mark.parametrize("width", [20, 40, 80, 132, 300])
def test_lines_fit_the_width(width: int) -> None:
    """Nothing is wrapped; below 80 columns names and texts are cut, states are not."""
    long: Drawn = ("/a" * 40, WARN, "x" * 500, {"refused": "", "since_ns": "", "since": "1 s ago"})
    found = watched(Clock(), REPORT, REPORT, (GATE, long))
    lines = drawn(found, width)
    assert len(lines) == 1 + 10
    assert max(map(cell_len, lines)) <= max(width, 40)
    if width >= 40:
        assert [line.split()[1] for line in lines[1:3]] == ["warning", "warning"]


@pytest.mark.parametrize(("width", "is_shown"), [(100, True), (95, True), (80, False)])
def test_what_comes_next_gives_way_to_names_and_reasons(width: int, is_shown: bool) -> None:
    """Where there is little room, the column is left out as a whole."""
    lines = drawn(watched(Clock()), width)
    assert ("NEXT" in lines[0]) is is_shown
    assert any("(unknown in 0.4 s)" in line for line in lines) is is_shown
    assert any("body.near" in line for line in lines)


def test_interval_that_runs_comes_before_silence() -> None:
    """Only what needs silence is in parentheses."""
    cells = {row.cells[0].strip(): row.cells[4] for row in rows(watched(Clock()).nodes())}
    assert cells["body.near"] == "false in 2.3 s"
    assert cells["drive.fast"] == "(unknown in 0.4 s)"
    assert cells["motor.hot"] == ""


def test_without_a_width_nothing_is_cut() -> None:
    """As for a file."""
    long: Drawn = ("/gate", WARN, "x" * 500, {"refused": "", "since_ns": ""})
    assert f"/gate  warning  {'x' * 500}" in drawn(watched(Clock(), (long,)), None)


def test_wide_characters_take_two_columns() -> None:
    """A terminal gives them two."""
    wide: Drawn = ("/gate", WARN, "停" * 100, {"refused": "", "since_ns": ""})
    assert max(map(cell_len, drawn(watched(Clock(), (wide,))))) <= 80


@pytest.mark.parametrize(
    "markup", ["[red]", "[/]", "[bold", ":warning:", "[link=http://x]y[/link]"]
)
def test_markup_is_shown_as_it_is(markup: str) -> None:
    """Limits of gates have brackets; anybody may write others."""
    gate: Drawn = ("/gate", WARN, f"a {markup} b", {"refused": "", "since_ns": ""})
    rule: Drawn = (f"/guard: {markup}", OK, "true: ", {"cause": markup})
    lines = drawn(watched(Clock(), (gate, GUARD, rule), (GUARD,)))
    assert f"a {markup} b" in lines[1]
    assert lines[3].split() == [markup, "true", markup]


def test_verdicts_of_a_silent_node_are_past() -> None:
    """What was true when it fell silent is not shown as if it were so now, colour or not."""
    clock = Clock()
    found = watched(clock)
    clock.now += 7.25
    lines = drawn(found, 100)
    assert lines[2].split()[:2] == ["/guard", "silent"]
    assert "no report for 7.2 s; the last: watching 3 rules" in lines[2]
    assert [line.strip() for line in lines[3:10]] == [
        "action stop  was active    near: body.near: ahead 0.2 < 0.3 m",
        "body.near    was true",
        "drive.fast   was false",
        "motor.hot    was unknown",
        "input ahead  was received",
        "input speed  was received",
        "input heat   was never",
    ]


def test_node_without_report_says_so() -> None:
    """It is in the graph, and nothing else is known of it."""
    clock = Clock()
    found = watched(clock, (GATE,))
    found.expect({"/hung"})
    clock.now += 65
    assert any("runs, but has not reported for 1 min 5 s" in line for line in drawn(found))


def _row(name: str, *, is_quiet: bool = False) -> Row:
    return Row((name, "", "", "", ""), is_quiet)


@pytest.mark.parametrize(
    ("room", "names"),
    [
        (6, ["a", "q1", "b", "q2", "q3", "c"]),
        (5, ["a", "q1", "b", "c", "  ... 2 more"]),
        (4, ["a", "b", "c", "  ... 3 more"]),
        (3, ["a", "b", "  ... 4 more"]),
        (2, ["a", "  ... 5 more"]),
    ],
)
def test_quiet_rows_give_way_first(room: int, names: Sequence[str]) -> None:
    """A rule that is true is never hidden for one that is false."""
    quiet = {"q1", "q2", "q3"}
    every = [_row(name, is_quiet=name in quiet) for name in ("a", "q1", "b", "q2", "q3", "c")]
    assert [row.cells[0] for row in fitted(every, room)] == names


def test_quiet_rows_are_false_rules_inactive_actions_and_inputs() -> None:
    """An unknown rule is not: the robot may be stopped for it."""
    assert [row.cells[0].strip() for row in rows(watched(Clock()).nodes()) if row.is_quiet] == [
        "drive.fast",
        "input ahead",
        "input speed",
        "input heat",
    ]


@pytest.mark.parametrize("height", [3, 5, 9, 24])
def test_picture_fits_the_height(height: int) -> None:
    """Events give way to rules, but the last ones stay where there is room for three."""
    found = watched(Clock())
    for _ in range(50):
        found.take_event("/guard", status(*TRIGGER))
    lines = drawn(found, 80, height)
    assert len(lines) <= height
    if height >= 9:
        assert any("trigger" in line for line in lines)
        assert any("body.near" in line for line in lines)


def test_equal_events_in_a_row_are_one_with_their_number() -> None:
    """An action that is run at each message leaves room for other events."""
    found = watched(Clock())
    for _ in range(20):
        found.take_event("/guard", status(*TRIGGER))
    assert [row[1:] for row in event_rows(found.events("/guard"))] == [
        ("start", START[2]),
        ("trigger", f"21 x {TRIGGER[2]}"),
    ]


def test_only_the_last_events_are_shown() -> None:
    """As many as are wanted; with none, not even their header."""
    found, out = watched(Clock()), io.StringIO()
    events = found.events("/guard")
    for count in (1, 0):
        Console(file=out, width=80).print(picture((), events, count, 80, None))
    assert out.getvalue().count("EVENT") == 1
    assert "start" not in out.getvalue()


def test_events_name_their_node_if_there_are_several() -> None:
    """Otherwise it is clear."""
    events = [WatchedEvent(node, "start", "ok", "up", None, ()) for node in ("/a", "/b")]
    out = io.StringIO()
    Console(file=out, width=80).print(picture((), events, 5, 80, None))
    assert "/a: up" in out.getvalue()


def test_time_of_an_event_is_wall_time_or_simulated() -> None:
    """Simulated time begins at zero."""
    assert ros_time(1_795_808_461_579_784_035) == "19:41:01.579"
    assert ros_time(12_345_000_000) == "12.345 s"
    assert ros_time(None) == ""
