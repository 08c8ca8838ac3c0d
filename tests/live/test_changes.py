"""Which changes ``deros watch`` prints, and how."""

from __future__ import annotations

import json
from collections.abc import Iterable

import pytest

from deros.live.changes import Change, Changes, as_object, duration
from deros.live.watched import Watched
from tests.support.drawn_diagnostics import Drawn, array, status
from tests.support.watched_robot import (
    FAST,
    GATE,
    GUARD,
    HOT,
    NEAR,
    OK,
    STOP,
    STOP_RESET,
    TRIGGER,
    WARN,
    Clock,
    watched,
)

NEAR_NO_MORE: Drawn = ("/guard: body.near", OK, "false: near: ahead < 0.3 m;", {"ahead": "2.5"})
FASTER: Drawn = (FAST[0], OK, FAST[2], {"speed": "0.42", "max_speed": "0.5"})


def lines(changes: Iterable[Change]) -> list[str]:
    """Return the changes as they are printed."""
    return [change.line() for change in changes]


def take(found: Watched, *report: Drawn) -> None:
    """Take a message."""
    found.take(array(*report))


def test_first_look_gives_everything() -> None:
    """Each node, action and rule has a line, with its cause or its values."""
    assert lines(Changes(5).states(watched(Clock()).nodes())) == [
        "/gate  warning  stop: zero (robot.deros:24); waits for a reset",
        "/guard  ok  watching 3 rules",
        "/guard  action stop  active  near: body.near: ahead 0.2 < 0.3 m",
        "/guard  rule body.near  true  ahead 0.2 < 0.3 m",
        "/guard  rule drive.fast  false  speed 0.31, max_speed 0.5",
        "/guard  rule motor.hot  unknown  heat unknown",
    ]


def test_only_what_has_changed_is_given_again() -> None:
    """Values differ in each report, and are no change; a verdict, a state and a level are."""
    found, changes = watched(Clock()), Changes(5)
    list(changes.states(found.nodes()))
    take(found, GUARD, STOP, NEAR, FASTER, HOT)
    assert lines(changes.states(found.nodes())) == []
    take(found, GUARD, STOP_RESET, NEAR_NO_MORE)
    take(found, ("/gate", OK, "commands pass", {"refused": "0", "since_ns": "2"}))
    assert lines(changes.states(found.nodes())) == [
        "/gate  ok  commands pass",
        "/guard  action stop  inactive  near",
        "/guard  rule body.near  false  ahead 2.5",
    ]


def test_silence_and_its_end_are_changes() -> None:
    """It is one line, however long it lasts; verdicts of a silent node are not given."""
    clock = Clock()
    found, changes = watched(clock), Changes(5)
    list(changes.states(found.nodes()))
    take(found, NEAR_NO_MORE)
    clock.now += 3.0
    take(found, GATE)
    silent = ["/guard  silent  no report for 3.0 s; the last: watching 3 rules"]
    assert lines(changes.states(found.nodes())) == silent
    clock.now += 2.0
    assert lines(changes.states(found.nodes())) == []
    take(found, GUARD)
    assert lines(changes.states(found.nodes())) == [
        "/guard  ok  watching 3 rules",
        "/guard  rule body.near  false  ahead 2.5",
    ]


def test_events_are_given_once_and_only_the_last_of_those_before() -> None:
    """What is dropped because there are too many new ones at once cannot be given."""
    found, changes = watched(Clock()), Changes(1)

    def given() -> list[str]:
        total = found.event_total("/guard")
        return [change.name for change in changes.events("/guard", found.events("/guard"), total)]

    assert given() == ["trigger"]
    assert given() == []
    found.take_event("/guard", status("/guard", WARN, "", {"kind": "refused"}))
    found.take_event("/guard", status("/guard", OK, "", {"kind": "reset"}))
    assert given() == ["refused", "reset"]
    for _ in range(1500):
        found.take_event("/guard", status(*TRIGGER))
    assert len(given()) == 1000


def test_no_event_from_before_is_given_if_none_is_wanted() -> None:
    """Those that come later are."""
    found, changes = watched(Clock()), Changes(0)
    assert list(changes.events("/guard", found.events("/guard"), 2)) == []
    found.take_event("/guard", status(*TRIGGER))
    (event,) = changes.events("/guard", found.events("/guard"), 3)
    assert event.line() == f"/guard  event trigger  {TRIGGER[2]}"


def test_objects_have_all_that_is_known() -> None:
    """JSON has values by term, and the values of an event by key."""
    found = watched(Clock())
    by_name = {change.name: change.as_object() for change in Changes(5).states(found.nodes())}
    fast = json.loads(json.dumps(by_name["drive.fast"]))
    assert fast == {
        "node": "/guard",
        "what": "rule",
        "name": "drive.fast",
        "verdict": "false",
        "is_blamed": False,
        "text": "fast: speed > max_speed;",
        "values": {"speed": "0.31", "max_speed": "0.5"},
        "cause": "",
        "since_s": 95.0,
        "next": [{"condition": "no message comes", "verdict": "unknown", "in_s": 0.48}],
    }
    (_, event) = Changes(5).events("/guard", found.events("/guard"), 2)
    assert event.as_object()["values"]["action"] == "stop"
    guard = as_object(found.nodes()[1])
    assert [rule["verdict"] for rule in guard["rules"]] == ["true", "false", "unknown"]
    assert guard["actions"][0]["because"] == "body.near: ahead 0.2 < 0.3 m"
    assert guard["inputs"][1:] == [
        {"name": "speed", "is_received": True, "age_s": 0.02},
        {"name": "heat", "is_received": False, "age_s": None},
    ]


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (None, ""),
        (0.04, "0.0 s"),
        (59.99, "59.9 s"),
        (60.0, "1 min 0 s"),
        (3599.9, "59 min 59 s"),
        (7260.0, "2 h 1 min"),
    ],
)
def test_durations(seconds: float | None, text: str) -> None:
    """They are cut, not rounded: a minute is one once it is over."""
    assert duration(seconds) == text
