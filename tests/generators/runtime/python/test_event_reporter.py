"""Reports of events by a safety node, in its log and on its topic."""

from __future__ import annotations

from typing import Any, NamedTuple
from unittest.mock import Mock

import pytest

pytest.importorskip("rclpy")
pytest.importorskip("diagnostic_msgs.msg")
from diagnostic_msgs.msg import DiagnosticStatus

from deros.generators.runtime.python.deros_runtime.event_reporter import EventReporter
from deros.generators.runtime.python.deros_runtime.report_types import (
    Action,
    Behaviour,
    EventKind,
    RuleMetadata,
)


class Event(NamedTuple):
    """An event of the monitor."""

    kind: EventKind
    t: int = 5
    action: str = "stop"
    behaviour: str = ""
    arguments: tuple[Any, ...] = ()
    line: int = 3
    holding: tuple[str, ...] = ()
    unknown: tuple[str, ...] = ()
    coming: tuple[str, ...] = ()


class Rule(NamedTuple):
    """The state of a rule, as explained by the monitor."""

    name: str
    value: bool | None
    reads: tuple[tuple[str, Any], ...]
    line: int = 1
    text: str = ""
    since: int = 0
    causes: tuple[str, ...] = ()


class Explanation(NamedTuple):
    """The explanation of a monitor."""

    rules: tuple[Rule, ...]
    causes: dict[str, tuple[str, ...]]


BEHAVIOURS = {
    "halt": Behaviour("robot.deros:7", "drive.fast or body.near", ("drive.fast", "body.near")),
    "back": Behaviour("robot.deros:9", "body.near", ("body.near",)),
}
METADATA = RuleMetadata(
    rules="robot.deros",
    rule_count=2,
    actions_file="",
    behaviours=BEHAVIOURS,
    actions={"stop": Action(lasts=True), "release": Action(lasts=False, is_release=True)},
)
RULES = (
    Rule("drive.fast", True, (("speed", 2.0),)),
    Rule("body.near", None, (("scan.nearest(-1, 1)", None),)),
)
LOGGED = {
    DiagnosticStatus.OK: "info",
    DiagnosticStatus.WARN: "warning",
    DiagnosticStatus.ERROR: "error",
}
HOLDING = Explanation(RULES, {"halt": ("drive.fast: speed 2.0 > 1", "body.near: x")})
REFUSING = Explanation(RULES, {**HOLDING.causes, "back": ("scan.nearest(-1, 1) is unknown",)})


def all_reported(*events: Event, after: Explanation = HOLDING) -> list[DiagnosticStatus]:
    """Return what is published of events of one node; its log is held against it."""
    node, published = Mock(), list[DiagnosticStatus]()
    node.get_fully_qualified_name.return_value = "/safety"
    node.get_clock.return_value.now.return_value.nanoseconds = 9
    clock: Any = Mock(origin=0)
    reporter = EventReporter(node, clock, METADATA, published.append)
    for event in events:
        reporter.report_monitor_event(event, 6, after)
    logged = [
        (name, arguments[0]) for name, arguments, _ in node.get_logger.return_value.mock_calls
    ]
    assert logged == [(LOGGED[each.level], each.message) for each in published]
    return published


def reported(event: Event, after: Explanation) -> tuple[str, dict[str, str]]:
    """Return the line in the log, and the values on the topic."""
    (status,) = all_reported(event, after=after)
    return status.message, {value.key: value.value for value in status.values}


def test_trigger_shows_its_cause() -> None:
    """The log shows it instead of the condition, the topic shows both."""
    line, values = reported(Event(EventKind.TRIGGER, behaviour="halt"), HOLDING)
    cause = "drive.fast: speed 2.0 > 1; body.near: x"
    assert line == f"stop, by halt (robot.deros:7): {cause}"
    assert (values["cause"], values["condition"]) == (cause, "drive.fast or body.near")
    assert (values["rule drive.fast"], values["value speed"]) == ("true", "2.0")


def test_trigger_of_a_past_cause_shows_its_condition() -> None:
    """The behaviour may have become true at a clock step, and false with the next message."""
    line, values = reported(Event(EventKind.TRIGGER, behaviour="halt"), Explanation(RULES, {}))
    assert line == "stop, by halt (robot.deros:7: if drive.fast or body.near)"
    assert values["cause"] == ""


CAUSE = "drive.fast: speed 2.0 > 1; body.near: x"


def levels(*events: Event) -> list[tuple[bytes, str]]:
    """Return the level and the text of each report."""
    return [(each.level, each.message) for each in all_reported(*events)]


def test_cause_is_told_once_for_all_actions_of_a_behaviour() -> None:
    """A text that accompanies a stop is no warning of its own."""
    stop = Event(EventKind.TRIGGER, behaviour="halt")
    says = Event(EventKind.TRIGGER, action="log_state", behaviour="halt", arguments=("too fast",))
    told = f"by halt (robot.deros:7): {CAUSE}"
    assert levels(stop, says) == [
        (DiagnosticStatus.WARN, f"stop, {told}"),
        (DiagnosticStatus.OK, "too fast, by halt"),
    ]
    assert levels(says, stop) == [
        (DiagnosticStatus.WARN, f"too fast, {told}"),
        (DiagnosticStatus.WARN, "stop, by halt"),
    ]
    later = says._replace(t=6)
    assert levels(stop, later)[1] == (DiagnosticStatus.WARN, f"too fast, {told}")
    assert levels(stop, says._replace(behaviour="back"))[1][0] == DiagnosticStatus.WARN


def test_release_is_no_warning() -> None:
    """Somebody asked for it; what refuses it is one."""
    (report,) = all_reported(Event(EventKind.TRIGGER, action="release", behaviour="halt"))
    assert (report.level, report.message) == (
        DiagnosticStatus.OK,
        f"release, by halt (robot.deros:7): {CAUSE}",
    )


def test_refused_reset_lists_holding_and_unknown_behaviours() -> None:
    """Each has its cause, or the terms without a value."""
    line, values = reported(
        Event(EventKind.REFUSED, holding=("halt",), unknown=("back",)), REFUSING
    )
    cause = "drive.fast: speed 2.0 > 1; body.near: x"
    assert line == (
        f"stop stays active, called for by halt (robot.deros:7): {cause}; not known to be false:"
        " back (robot.deros:9: scan.nearest(-1, 1) is unknown)"
    )
    assert (values["holding"], values["unknown"]) == ("halt", "back")
    assert values["cause halt"] == cause
    assert values["cause back"] == "scan.nearest(-1, 1) is unknown"
