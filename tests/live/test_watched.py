"""What ``deros watch`` collects: verdicts, actions, events and silence, from drawn messages."""

from __future__ import annotations

import pytest

from deros.live.watched import WatchedAction, WatchedInput, WatchedNext, WatchedNode, WatchedRule
from tests.support.drawn_diagnostics import Drawn, array, status
from tests.support.watched_robot import (
    ERROR,
    FAST,
    GATE,
    GUARD,
    HOT,
    INPUTS,
    NEAR,
    OK,
    REPORT,
    STALE,
    START,
    STOP,
    STOP_RESET,
    TRIGGER,
    TRIGGER_NS,
    Clock,
    watched,
)


def guard_of(nodes: tuple[WatchedNode, ...]) -> WatchedNode:
    """Return the safety node."""
    return next(node for node in nodes if node.node == "/guard")


def test_report_gives_verdicts_values_and_causes() -> None:
    """The keys of since and line are no terms; a rule that is not true has no cause."""
    guard = guard_of(watched(Clock()).nodes())
    assert guard == WatchedNode(
        node="/guard",
        kind="safety node",
        level="ok",
        message="watching 3 rules",
        since_s=None,
        silent_s=None,
        actions=(
            WatchedAction("stop", True, "active", "near", "body.near: ahead 0.2 < 0.3 m", 2.15),
        ),
        rules=(
            WatchedRule(
                "body.near",
                "true",
                True,
                "near: ahead < 0.3 m;",
                (("ahead", "0.2"),),
                "ahead 0.2 < 0.3 m",
                2.15,
                (
                    WatchedNext("values stay", "false", 2.35),
                    WatchedNext("no message comes", "unknown", 0.38),
                ),
            ),
            WatchedRule(
                "drive.fast",
                "false",
                False,
                "fast: speed > max_speed;",
                (("speed", "0.31"), ("max_speed", "0.5")),
                "",
                95.0,
                (WatchedNext("no message comes", "unknown", 0.48),),
            ),
            WatchedRule(
                "motor.hot", "unknown", False, "hot: heat > 80;", (("heat", "unknown"),), "", None
            ),
        ),
        inputs=(
            WatchedInput("ahead", True, 0.12),
            WatchedInput("speed", True, 0.02),
            WatchedInput("heat", False, None),
        ),
    )


def test_input_named_cause_is_a_term_of_a_rule_that_is_false() -> None:
    """Only of a true rule the node reports a cause under that key."""
    rule: Drawn = ("/guard: a.b", OK, "false: b: cause > 1;", {"cause": "0.5"})
    guard = guard_of(watched(Clock(), (GUARD, rule), (GUARD,)).nodes())
    assert (guard.rules[0].values, guard.rules[0].cause) == ((("cause", "0.5"),), "")


def test_times_go_on_between_reports() -> None:
    """A state is as old as the node said, and by the time since then."""
    clock = Clock()
    found = watched(clock)
    clock.now += 0.75
    gate, guard = found.nodes()
    assert gate.since_s == pytest.approx(2.85)
    assert guard.actions[0].since_s == pytest.approx(2.9)
    assert guard.rules[2].since_s is None


def test_what_comes_next_comes_nearer_and_ages_grow_between_reports() -> None:
    """What is overdue has not come about, so a message has come: it is shown no more."""
    clock = Clock()
    found = watched(clock)
    clock.now += 0.4
    guard = guard_of(found.nodes())
    (then,) = guard.rules[0].next
    assert (then.condition, then.verdict) == ("values stay", "false")
    assert then.in_s == pytest.approx(1.95)
    assert guard.rules[1].next[0].in_s == pytest.approx(0.08)
    assert [each.age_s for each in guard.inputs] == [pytest.approx(0.52), pytest.approx(0.42), None]


def test_silent_node_foretells_nothing_and_knows_no_ages() -> None:
    """Nobody evaluates the rules, and the messages may come."""
    clock = Clock()
    slow: Drawn = (
        "/guard: a.b",
        OK,
        "false: b: x for 60 sec;",
        {"if values stay": "true in 9.0 s"},
    )
    found = watched(clock, (GUARD, slow, INPUTS), (GUARD, slow, INPUTS))
    assert guard_of(found.nodes()).rules[0].next
    clock.now += 3.5
    guard = guard_of(found.nodes())
    assert guard.rules[0].next == ()
    assert [(each.is_received, each.age_s) for each in guard.inputs] == [
        (True, None),
        (True, None),
        (False, None),
    ]


@pytest.mark.parametrize("hostile", ["maybe in 1.0 s", "true in nan s", "true", "true in -1.0 s"])
def test_what_cannot_be_read_is_not_foretold(hostile: str) -> None:
    """Values are texts of another process; the key is no term all the same."""
    rule: Drawn = ("/guard: a.b", OK, "false: b: x;", {"if values stay": hostile})
    (shown,) = guard_of(watched(Clock(), (GUARD, rule), (GUARD,)).nodes()).rules
    assert (shown.next, shown.values) == ((), ())


def test_node_is_silent_after_the_time_without_report_and_until_the_next() -> None:
    """Each of the two is judged by its own last report."""
    clock = Clock()
    found = watched(clock)
    clock.now += 2.0
    found.take(array(GATE))
    clock.now += 0.9
    assert [node.silent_s for node in found.nodes()] == [None, None]
    clock.now += 0.1
    assert [node.silent_s for node in found.nodes()] == [None, pytest.approx(3.0)]
    found.take(array(GUARD))
    assert [node.silent_s for node in found.nodes()] == [None, None]


def test_node_that_never_reports_is_silent_since_it_was_found() -> None:
    """One that leaves the graph before it has reported is forgotten."""
    clock = Clock()
    found = watched(clock, (GATE,))
    found.expect({"/gate", "/hung", "_NODE_NAMESPACE_UNKNOWN_/_NODE_NAME_UNKNOWN_"})
    clock.now += 2.0
    found.expect({"/gate", "/hung"})
    found.take(array(GATE))
    assert [node.node for node in found.nodes()] == ["/gate"]
    clock.now += 1.0
    hung = found.nodes()[1]
    assert (hung.node, hung.kind, hung.level) == ("/hung", None, "unknown")
    assert hung.silent_s == pytest.approx(3.0)
    found.expect({"/gate"})
    assert [node.node for node in found.nodes()] == ["/gate"]


def test_safety_node_is_complete_when_its_next_report_begins() -> None:
    """Until then a rule may be missing."""
    found = watched(Clock(), (NEAR, FAST), REPORT)  # the rest of a report that was missed, first
    assert (found.complete(), found.incomplete()) == (frozenset(), frozenset({"/guard"}))
    found.take(array(GUARD))
    assert (found.complete(), found.incomplete()) == (frozenset({"/guard"}), frozenset())


def test_rules_that_are_gone_after_a_restart_are_dropped() -> None:
    """What a whole report does not contain is no more; during a report nothing flickers."""
    found = watched(Clock(), REPORT, (GUARD, NEAR))
    assert len(guard_of(found.nodes()).rules) == 3
    found.take(array(GUARD))
    guard = guard_of(found.nodes())
    assert ([rule.name for rule in guard.rules], guard.actions) == (["body.near"], ())


def test_action_that_was_reset_is_inactive() -> None:
    """The last report counts."""
    found = watched(Clock(), REPORT, (GUARD, STOP_RESET))
    (stop,) = guard_of(found.nodes()).actions
    assert (stop.is_active, stop.message) == (False, "inactive")


def test_other_diagnostics_and_aggregated_ones_are_left_out() -> None:
    """Aggregators repeat statuses under names that no node can have."""
    found = watched(
        Clock(),
        (("/Robot/Other/ guard", OK, "watching", {"state": "watching"}), ("/motor", OK, "", {})),
        (("guard", OK, "watching", {"state": "watching"}), ("motor: temperature", ERROR, "", {})),
        (STOP,),
    )
    found.take(array(("/battery", OK, "charging", {"state": "charging"}), hardware_id="none"))
    assert found.nodes() == ()


@pytest.mark.parametrize("hostile", ["\x1b[2J", "\n", "\r", "\x07", "\u202e", "\x9b1m"])
def test_no_text_can_control_the_terminal(hostile: str) -> None:
    """Anybody can publish under the name of a safety node, whatever the place of the text."""
    text = f"a{hostile}b"
    rule: Drawn = (f"/guard: x{text}", STALE, f"true: {text}", {text: text, "cause": text})
    action: Drawn = (f"/guard: action {text}", OK, text, {"cause": text, "because": text})
    node: Drawn = ("/guard", OK, text, {"state": text})
    bad: Drawn = (f"/gu{hostile}ard", OK, "", {"state": ""})
    found = watched(Clock(), (node, action, rule, bad), (node,))
    found.take_event("/guard", status("/guard", OK, text, {"kind": text, text: text}))
    (guard,) = found.nodes()
    (event,) = found.events("/guard")
    shown = [guard.message, *guard.actions[0].__dict__.values(), *guard.rules[0].__dict__.values()]
    shown += [event.kind, event.message, *event.values[1], *guard.rules[0].values[0]]
    texts = [each for each in shown if isinstance(each, str)]
    assert sum("a?" in each for each in texts) >= 11
    assert all(each.isprintable() for each in texts)


def test_long_texts_are_cut() -> None:
    """A text of megabytes is neither kept nor shown."""
    node: Drawn = ("/gate", OK, "x" * 10**6, {"refused": "0", "since_ns": "1", "y" * 10**6: "z"})
    (gate,) = watched(Clock(), (node,)).nodes()
    assert len(gate.message) == 2000
    assert gate.message.endswith("x\N{HORIZONTAL ELLIPSIS}")


def test_malformed_times_are_unknown() -> None:
    """Values are texts of another process."""
    node: Drawn = ("/gate", OK, "", {"refused": "", "since_ns": "", "since": "nan s ago"})
    found = watched(Clock(), (node,))
    assert found.nodes()[0].since_s is None
    found.take_event("/gate", status("/gate", 255, "", {"ros_time_ns": "9" * 5000}))
    (event,) = found.events("/gate")
    assert (event.ros_time_ns, event.level) == (None, "stale")


def test_events_are_kept_in_order_and_counted() -> None:
    """As many are kept as the node keeps; those that are dropped count, too."""
    found = watched(Clock())
    assert [event.kind for event in found.events("/guard")] == ["start", "trigger"]
    assert found.events("/guard")[1].ros_time_ns == TRIGGER_NS
    for _ in range(1000):
        found.take_event("/guard", status(*TRIGGER))
    kinds = [event.kind for event in found.events("/guard")]
    assert (len(kinds), kinds[0], found.event_total("/guard")) == (1000, "trigger", 1002)
    assert START[3]["kind"] not in kinds


def test_level_of_the_rule_that_is_acted_on() -> None:
    """An error is how the node marks it; staleness is not."""
    guard = guard_of(watched(Clock()).nodes())
    assert {rule.name: rule.is_blamed for rule in guard.rules} == {
        "body.near": True,
        "drive.fast": False,
        "motor.hot": False,
    }
    assert HOT[1] == STALE
