"""The current state of a safety node on /diagnostics."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import repeat
from types import MappingProxyType, SimpleNamespace
from typing import Any, NamedTuple

import pytest

pytest.importorskip("rclpy")
pytest.importorskip("diagnostic_msgs.msg")

from deros.generators.runtime.python.deros_runtime.diagnostics import CHUNK, Diagnostics
from deros.generators.runtime.python.deros_runtime.look_ahead import SILENT, STAYING, NextVerdict
from deros.generators.runtime.python.deros_runtime.report_types import Behaviour, EventKind
from tests.support.clockwork import Clockwork

OK, WARN, ERROR, STALE = range(4)


class Rule(NamedTuple):
    """The state of a rule, as explained by the monitor."""

    name: str
    value: bool | None
    line: int = 1
    text: str = "fast: speed > 1;"
    since: int = 0
    reads: tuple[tuple[str, Any], ...] = (("speed", 2.0),)
    causes: tuple[str, ...] = ()


class Explanation(NamedTuple):
    """The explanation of a monitor."""

    rules: tuple[Rule, ...] = ()
    causes: Mapping[str, tuple[str, ...]] = MappingProxyType({})


class Event(NamedTuple):
    """An event of the monitor."""

    kind: EventKind
    action: str
    behaviour: str = "stopping"
    t: int = 5_000_000_000
    arguments: tuple[Any, ...] = ()
    line: int = 1
    holding: tuple[str, ...] = ()
    unknown: tuple[str, ...] = ()
    coming: tuple[str, ...] = ()


class PublishedDiagnostics:
    """Diagnostics of a node with some rules, and their messages.

    Attributes:
        ahead: what becomes of the rules, by their places; ``None`` while no time passes.
        looks: how many steps it takes to find that.
        received: when the last message of each input came.
    """

    def __init__(
        self, *rules: Rule, holding: tuple[str, ...] = (), named: tuple[str, ...] = ()
    ) -> None:
        """Start publishing."""
        self.messages: list[Any] = []
        self.clockwork = Clockwork(1_000_000_000)
        self.node = self.clockwork.node
        self.node.get_fully_qualified_name.return_value = "/safety"
        self.node.get_clock.return_value.now.return_value.to_msg = _no_time
        behaviours = {"stopping": Behaviour("robot.deros:7", "drive.fast", named)}
        actions = {"stop": True, "beep": False}
        self.diagnostics = Diagnostics(
            self.node,
            self.clockwork.clock,
            behaviours,
            actions,
            self.messages.append,
            1.0,
            lambda: 0,
        )
        self.not_ready = ""
        self.ahead: dict[int, dict[str, NextVerdict]] | None = {}
        self.looks = 0
        self.received: dict[str, int | None] = {}
        explained = Explanation(rules, dict.fromkeys(behaviours, ("why",)))
        self.diagnostics.begin(
            lambda: explained,
            lambda: holding,
            Clockwork(6_000_000_000).clock,
            lambda: self.not_ready,
            self._look_ahead,
            lambda: self.received,
        )

    def _look_ahead(self) -> Any:
        if self.ahead is None:
            return None
        return SimpleNamespace(found=self.ahead, steps=lambda: repeat(None, self.looks))

    def publish(self) -> dict[str, Any]:
        """Publish now, and return the statuses by the last part of their names."""
        self.diagnostics._timer.fire()
        return {each.name.rpartition(": ")[2]: each for each in self.messages[-1].status}

    @property
    def wait(self) -> float:
        """Return the seconds until the next message is due."""
        due: int = self.diagnostics._timer.due
        return (due - self.clockwork.now) / 1e9


def _no_time() -> Any:
    from builtin_interfaces.msg import Time

    return Time()


@pytest.mark.parametrize(
    ("value", "holding", "level"),
    [
        (False, (), OK),
        (True, (), WARN),
        (True, ("stopping",), ERROR),
        (None, (), STALE),
        (None, ("stopping",), STALE),
    ],
)
def test_level_of_a_rule_follows_its_effect(
    value: bool | None, holding: tuple[str, ...], level: int
) -> None:
    """Red for a rule that holds the robot, stale for an unknown one."""
    shown = PublishedDiagnostics(
        Rule("drive.fast", value), holding=holding, named=("drive.fast",)
    ).publish()
    assert shown["drive.fast"].level[0] == level


def test_only_true_rules_are_errors() -> None:
    """Of 'a or b', the false one does not hold the robot."""
    rules = (Rule("a.a", True), Rule("b.b", False))
    shown = PublishedDiagnostics(*rules, holding=("stopping",), named=("a.a", "b.b")).publish()
    assert [shown[name].level[0] for name in ("a.a", "b.b")] == [ERROR, OK]


def test_negated_rule_is_an_error_if_false() -> None:
    """Of 'not ready', the false rule holds the robot."""
    rule = Rule("self.ready", False)
    shown = PublishedDiagnostics(rule, holding=("stopping",), named=("self.ready",)).publish()
    assert shown["self.ready"].level[0] == ERROR


def test_rules_of_a_behaviour_that_does_not_hold_are_no_errors() -> None:
    """Of 'a or b', one unknown: the monitor explains why it refuses a reset; no robot is held."""
    rules = (Rule("a.a", None), Rule("b.b", False))
    shown = PublishedDiagnostics(*rules, named=("a.a", "b.b")).publish()
    assert [shown[name].level[0] for name in ("a.a", "b.b")] == [STALE, OK]
    shown = PublishedDiagnostics(Rule("a.a", True), named=("a.a",)).publish()
    assert shown["a.a"].level[0] == WARN, "true, of a behaviour that is on its way"


def test_action_shows_cause_and_start() -> None:
    """Another trigger does not change the start."""
    shown = PublishedDiagnostics()
    why = Explanation((), {"stopping": ("a.a: speed 2.0 > 1", "b.b: lidar.missing()")})
    shown.diagnostics.update(Event(EventKind.TRIGGER, "stop"), why)
    shown.diagnostics.update(Event(EventKind.TRIGGER, "stop", "another", 5_500_000_000), why)
    status = shown.publish()["action stop"]
    values = {value.key: value.value for value in status.values}
    assert (status.level[0], status.message) == (WARN, "active")
    assert values == {
        "runs": "2",
        "cause": "stopping",
        "because": "a.a: speed 2.0 > 1; b.b: lidar.missing()",
        "since": "1.000 s ago",
        "since_ns": "5000000000",
    }
    shown.diagnostics.update(Event(EventKind.REFUSED, "stop"), Explanation())
    assert shown.publish()["action stop"].message == "active"
    shown.diagnostics.update(Event(EventKind.RESET, "stop"), Explanation())
    assert shown.publish()["action stop"].message == "inactive"


def test_true_rule_shows_its_true_parts() -> None:
    """They are listed next to all values that it reads."""
    rule = Rule("drive.fast", True, causes=("speed 2.0 > 1", "lidar.missing()"))
    values = {
        value.key: value.value
        for value in PublishedDiagnostics(rule).publish()["drive.fast"].values
    }
    assert values["speed"] == "2.0"
    assert values["cause"] == "speed 2.0 > 1; lidar.missing()"


def test_fault_is_an_error_until_it_ends() -> None:
    """It is in the node's own status; only changes are reported as such."""
    shown = PublishedDiagnostics()
    assert shown.diagnostics.fault("/imu", "is not received")
    assert not shown.diagnostics.fault("/imu", "is not received")
    status = shown.publish()["/safety"]
    assert (status.level[0], status.message) == (ERROR, "is not received")
    assert shown.diagnostics.fault("/imu", "")
    assert not shown.diagnostics.fault("/imu", "")
    shown.not_ready = "starting"
    assert shown.publish()["/safety"].level[0] == WARN


def test_change_is_published_soon() -> None:
    """Changes are published after 50 ms, otherwise every second."""
    shown = PublishedDiagnostics()
    shown.publish()
    assert shown.wait == 1.0
    shown.diagnostics.changed()
    assert shown.wait == 0.05


def test_many_rules_are_published_in_chunks() -> None:
    """A thousand statuses in one message would delay the rules by tens of ms."""
    rules = [Rule(f"e.r{number}", False) for number in range(3 * CHUNK)]
    shown = PublishedDiagnostics(*rules)
    shown.publish()
    while shown.wait < 0.5:
        shown.publish()
    assert max(len(message.status) for message in shown.messages) == CHUNK
    names = {each.name for message in shown.messages for each in message.status}
    assert len(names) == 3 * CHUNK + 3


def values_of(status: Any) -> dict[str, str]:
    """Return the values of a status."""
    return {pair.key: pair.value for pair in status.values}


def test_rule_tells_what_it_becomes_without_news() -> None:
    """The time is that from the report on, and never negative; who looks in vain says nothing."""
    shown = PublishedDiagnostics(Rule("a.a", False), Rule("b.b", True), Rule("c.c", None))
    shown.ahead = {
        0: {STAYING: NextVerdict(True, 7_300_000_000), SILENT: NextVerdict(None, 6_400_000_000)},
        1: {SILENT: NextVerdict(False, 5_999_999_999)},
    }
    found = shown.publish()
    first, second, third = (values_of(found[name]) for name in ("a.a", "b.b", "c.c"))
    assert first["if values stay"] == "true in 1.300 s"
    assert first["if no message comes"] == "unknown in 0.400 s"
    assert second["if no message comes"] == "false in 0.000 s"
    assert not {"if values stay", "if no message comes"} & {*third}


def test_looking_ahead_gives_way_to_messages() -> None:
    """After a few steps the node does what else there is to do; no empty message goes out."""
    shown = PublishedDiagnostics(Rule("a.a", False))
    shown.looks = 2 * CHUNK + 1
    for _ in range(3):
        shown.diagnostics._timer.fire()
        assert (shown.messages, shown.wait) == ([], 0.001)
    assert "a.a" in shown.publish()


def test_nothing_is_foretold_while_no_time_passes() -> None:
    """Before simulated time begins."""
    shown = PublishedDiagnostics(Rule("a.a", False))
    shown.ahead = None
    assert "if no message comes" not in values_of(shown.publish()["a.a"])


def test_inputs_show_the_age_of_their_last_message() -> None:
    """One that never sent is named; a message from after a step back of the clock is forgotten."""
    shown = PublishedDiagnostics()
    shown.received = {"scan": 5_880_000_000, "imu": 6_000_000_000}
    status = shown.publish()["inputs"]
    assert (status.level[0], status.message) == (OK, "all received")
    assert values_of(status) == {"scan": "0.120 s ago", "imu": "0.000 s ago"}
    shown.received = {"scan": None, "imu": 6_000_000_001}
    status = shown.publish()["inputs"]
    assert (status.level[0], status.message) == (OK, "never received: scan, imu")
    assert values_of(status) == {"scan": "never", "imu": "never"}
