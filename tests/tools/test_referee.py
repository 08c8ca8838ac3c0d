"""Parts of the campaign: rounds can be replayed, and the referee detects every violation."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from tests.support.chaos.links import BY_NAME, GATE, PLANT, SAFETY
from tests.support.chaos.record import Message
from tests.support.chaos.referee import Referee, Verdict
from tests.support.chaos.rules import broken_rules
from tests.support.chaos.schedule import KINDS, PROVOCATIONS, WINDOW, Schedule, draw

pytest.importorskip("rclpy")

END = 5.0


def say(topic: str, value: Any) -> bytes:
    """Return a serialized message with this value."""
    from rclpy.serialization import serialize_message

    message = BY_NAME[topic].message_type()()
    if topic == "/odometry":
        message.twist.twist.linear.x = value
    elif topic == "/scan":
        message.ranges = [value]
    elif topic.endswith(("/command", "/joystick")):
        message.linear.x = value
    elif topic == "/imu":
        message.orientation.w = 1.0
    else:
        message.data = value
    return bytes(serialize_message(message))


Value = Callable[[float], Any]


def stream(
    place: Any, domain: str, topic: str, value: Value, *, begin: float = -1.0, end: float = END
) -> Iterator[Message]:
    """Yield the messages of a topic, ten per second; there is none where the value is ``None``."""
    for number in range(round((end - begin) * 10)):
        now = begin + number / 10
        if (said := value(now)) is not None:
            yield Message(now, place, domain, topic, say(topic, said))


CONTACTS = ("stop_button", "front_bumper", "rear_bumper", "feeding_arm")


def robot(**replaced: Value) -> list[Message]:
    """Return a round of a compliant robot, with some of its streams replaced."""
    streams: dict[str, tuple[Any, str, str, Value]] = {
        "imu": ("arrived", SAFETY, "/imu", lambda _: 0.0),
        "speed": ("arrived", SAFETY, "/odometry", lambda _: 0.4),
        "scan": ("arrived", SAFETY, "/scan", lambda _: 20.0),
        "mode": ("arrived", SAFETY, "/plc/mode", lambda _: 2),
        **{
            name: ("arrived", SAFETY, f"/plc/{name}", lambda _: False)
            for name in (*CONTACTS, "engine_running")
        },
        "plc": ("arrived", SAFETY, "/plc/keep_alive", lambda t: round(t * 10) + 100),
        "mission": ("arrived", SAFETY, "/controller/keep_alive", lambda t: round(t * 10) + 100),
        "beat": ("sent", SAFETY, "/safety/heartbeat", lambda t: round(t * 10) + 100),
        "says_off": ("sent", SAFETY, "/safety/motor_stop", lambda _: False),
        "says_stop": ("sent", SAFETY, "/safety/stop", lambda _: False),
        "beat_arrives": ("arrived", GATE, "/safety/heartbeat", lambda t: round(t * 10) + 100),
        "stop_arrives": ("arrived", GATE, "/safety/stop", lambda _: False),
        "slow_arrives": ("arrived", GATE, "/safety/low_speed", lambda _: False),
        "command": ("arrived", GATE, "/controller/command", lambda _: 0.4),
        "passed": ("sent", GATE, "/actuators/command", lambda _: 0.4),
        "passed_arrives": ("arrived", PLANT, "/actuators/command", lambda _: 0.4),
        "pedal": ("sent", PLANT, "/actuators/pedal", lambda _: 0.27),
    }
    for name, value in replaced.items():
        streams[name] = (*streams[name][:3], value)
    messages = [message for each in streams.values() for message in stream(*each)]
    return sorted(messages, key=lambda message: message.time)


def judge(messages: Sequence[Message], whole: bool = True) -> Verdict:
    """Judge a round without delays of the observer."""
    return Referee(messages, [], 0.0, END, whole).judge()


def after(moment: float, then: Any, before: Any) -> Value:
    """Return a value that changes at a given time."""
    return lambda now: then if now >= moment else before


def duties(verdict: Verdict) -> set[str]:
    """Return the parts that have failed."""
    return {violation.duty for violation in verdict.violations}


def stopped_at(moment: float) -> dict[str, Value]:
    """Return the responses of the parts to a stop that is due at a given time."""
    return {
        "says_stop": after(moment, True, False),
        "says_off": after(moment, True, False),
        "stop_arrives": after(moment, True, False),
        "passed": after(moment, 0.0, 0.4),
        "passed_arrives": after(moment, 0.0, 0.4),
        "pedal": after(moment, 0.0, 0.27),
    }


# The referee --------------------------------------------------------------------------------------


def test_compliant_robot_has_no_violations() -> None:
    """No rule is broken, and the robot moves."""
    verdict = judge(robot())
    assert (verdict.broken, verdict.violations, verdict.moved) == ([], [], True)


def test_restart_without_a_zero_command_is_detected() -> None:
    """The robot stood for a second, and the controller never commanded zero."""
    stood: Value = lambda now: 0.0 if 2.0 <= now < 3.0 else 0.4  # noqa: E731
    pedal: Value = lambda now: 0.0 if 1.9 <= now < 3.0 else 0.27  # noqa: E731
    moves = {"passed": stood, "passed_arrives": stood, "pedal": pedal}
    verdict = judge(robot(**moves))
    assert duties(verdict) == {"gate"}
    assert "nobody has commanded zero" in verdict.violations[0].reason
    assert not judge(robot(**moves, command=stood)).violations


def test_restart_without_a_reset_is_detected() -> None:
    """The heartbeat was lost, and a zero of the controller does not replace the reset."""
    stood: Value = lambda now: 0.0 if 2.0 <= now < 3.5 else 0.4  # noqa: E731
    pedal: Value = lambda now: 0.0 if 1.9 <= now < 3.5 else 0.27  # noqa: E731
    beats: Value = lambda now: None if 2.0 < now < 3.0 else round(now * 10) + 100  # noqa: E731
    moves = {"passed": stood, "passed_arrives": stood, "pedal": pedal, "command": stood}
    verdict = judge(robot(**moves, beat_arrives=beats))
    assert duties(verdict) == {"gate"}
    assert "nobody has reset it" in verdict.violations[0].reason


@pytest.mark.parametrize(
    ("name", "broken", "rule", "due"),
    [
        ("scan", 1.5, "stop zone", 2.0),
        ("scan", 0.5, "collision zone", 2.0),
        ("speed", 1.2, "forward limit", 2.0),
        ("speed", -0.5, "backward limit", 2.0),
        ("front_bumper", True, "front_bumper", 2.0),
        ("scan", math.nan, "nearest cannot be told", 2.0),
        ("scan", None, "nearest is silent", 2.4),
        ("mission", None, "controller is silent", 2.4),
    ],
)
def test_broken_rules_are_dated_correctly(name: str, broken: Any, rule: str, due: float) -> None:
    """Times are those of receipt; a silence counts from the last message."""
    before = {"scan": 20.0, "speed": 0.4, "front_bumper": False, "mission": 1}[name]
    verdict = judge(robot(**{name: after(2.0, broken, before)}, **stopped_at(due + 0.1)))
    first = verdict.broken[0]
    assert (first.rule, round(first.begin, 3)) == (rule, due)
    assert verdict.violations == []
    assert verdict.slowest <= 0.11


def test_rule_with_a_duration_is_broken_after_it() -> None:
    """Above nominal speed for four seconds, with an interruption that restarts them."""
    messages = robot(speed=after(0.5, 0.6, 0.4))
    assert [(e.rule, e.begin) for e in broken_rules(messages, END)] == [("nominal speed", 4.5)]
    broken = robot(speed=lambda now: 0.4 if now < 0.5 or 3.0 < now < 3.15 else 0.6)
    assert broken_rules(broken, END) == []


def test_limits_do_not_apply_without_supervision() -> None:
    """In manual mode a person drives."""
    assert broken_rules(robot(mode=lambda _: 0, speed=lambda _: 1.2), END) == []


PLANTED: dict[str, tuple[dict[str, Value], set[str]]] = {
    "a blind safety node": ({}, {"safety node", "robot"}),
    "a safety node that forgets the stop": (
        {**stopped_at(2.1), "says_stop": lambda now: 2.1 <= now < 3.5},
        {"safety node"},
    ),
    "a safety node that is late": ({**stopped_at(3.0)}, {"safety node"}),
    "a gate that ignores the stop": (
        {"says_stop": after(2.1, True, False), "stop_arrives": after(2.1, True, False)},
        {"gate", "robot"},
    ),
    "an arbiter that does not stop": (
        {**stopped_at(2.1), "pedal": lambda _: 0.27},
        {"arbiter", "robot"},
    ),
}


@pytest.mark.parametrize("planted", PLANTED)
def test_planted_violations_are_detected(planted: str) -> None:
    """With an obstacle in the stop zone and one failing part, the referee names the part."""
    replaced, expected = PLANTED[planted]
    verdict = judge(robot(scan=after(2.0, 1.5, 20.0), **replaced))
    assert duties(verdict) == expected


def test_gate_that_passes_commands_after_the_heartbeat_is_detected() -> None:
    """The heartbeat may stop, or repeat its last count."""
    gone = robot(beat=after(2.0, None, 1), beat_arrives=after(2.0, None, 1))
    assert duties(judge(robot(beat_arrives=after(2.0, None, 1)))) == {"gate"}
    assert duties(judge(gone)) == {"gate"}
    assert duties(judge(robot(beat_arrives=lambda now: min(round(now * 10) + 100, 120)))) == {
        "gate"
    }


def test_gate_that_passes_late_or_unlimited_commands_is_detected() -> None:
    """A late command is a lost one, and a limit must be respected."""
    assert duties(judge(robot(command=after(2.0, None, 0.4)))) == {"gate"}
    assert duties(judge(robot(slow_arrives=after(2.0, True, False)))) == {"gate"}


def test_restarted_heartbeat_is_a_new_run() -> None:
    """A restarted node starts counting again, and does not know earlier events."""

    def restarted(now: float) -> int:
        return round(now * 10) + 100 if now < 3.0 else round((now - 3.0) * 10)

    seen = robot(
        scan=lambda now: 1.5 if 1.0 <= now < 2.5 else 20.0,
        beat=lambda now: restarted(now) if not 2.0 < now < 3.0 else None,
        beat_arrives=lambda now: restarted(now) if not 2.0 < now < 3.0 else None,
        says_stop=lambda now: 1.1 <= now < 2.5,
        stop_arrives=lambda now: 1.1 <= now < 2.5,
        passed=after(1.1, 0.0, 0.4),
        passed_arrives=after(1.1, 0.0, 0.4),
        pedal=after(1.1, 0.0, 0.27),
    )
    assert judge(seen).violations == []


def test_undelivered_messages_are_not_held_against_a_part() -> None:
    """A stop delayed by the network is not the safety node's fault: it has published the stop."""
    held_back = robot(scan=after(2.0, 1.5, 20.0), says_stop=after(2.1, True, False))
    assert judge(held_back, whole=False).violations == []
    assert duties(judge(held_back, whole=True)) == {"robot"}


def test_reset_ends_the_duty() -> None:
    """Manual mode is the reset; without it the stop stays, whatever the scanner measures."""
    brief = {"scan": lambda now: 1.5 if 1.0 <= now < 2.0 else 20.0}
    forgets = {"says_stop": lambda now: 1.1 <= now < 3.0}
    switched = {"mode": lambda now: 0 if 2.5 <= now < 3.0 else 2}
    assert duties(judge(robot(**brief, **forgets), whole=False)) == {"safety node"}
    assert judge(robot(**brief, **forgets, **switched), whole=False).violations == []


def test_reset_between_heartbeat_and_states_is_not_a_failure() -> None:
    """With manual mode for less than 0.1 s, the stop ends and is published again."""
    close: dict[str, Value] = {
        "scan": after(1.0, 1.5, 20.0),
        "says_stop": after(1.1, True, False),
    }
    manual = Message(2.52, "arrived", SAFETY, "/plc/mode", say("/plc/mode", 0))
    ended = Message(2.53, "sent", SAFETY, "/safety/stop", say("/safety/stop", False))

    def judged(*further: Message) -> Verdict:
        return judge(sorted([*robot(**close), *further], key=lambda each: each.time), whole=False)

    assert judged(manual, ended).violations == []
    assert duties(judged(ended)) == {"safety node"}


def test_forgotten_latch_is_detected() -> None:
    """The action was never published, or was undone by a restart."""
    bumped = {**stopped_at(2.1), "front_bumper": lambda now: 2.0 <= now < 3.0}
    assert judge(robot(**bumped)).violations == []
    never = robot(**{**bumped, "says_off": lambda _: False})
    undone = robot(**{**bumped, "says_off": lambda now: 2.1 <= now < 4.0})
    assert duties(judge(never)) == duties(judge(undone)) == {"safety node"}


def test_delays_of_the_observer_are_discounted() -> None:
    """A part is not late by the time during which the observer was delayed."""
    late = robot(scan=after(2.0, 1.5, 20.0), **stopped_at(3.0))
    assert duties(judge(late)) == {"safety node"}
    assert Referee(late, [(2.6, 0.6)], 0.0, END).judge().violations == []


# The schedules ------------------------------------------------------------------------------------


def test_round_is_determined_by_seed_and_number(tmp_path: Path) -> None:
    """The same numbers give the same round, and a file stores it."""
    first = [draw(5, number) for number in range(50)]
    assert first == [draw(5, number) for number in range(50)]
    assert first != [draw(6, number) for number in range(50)]
    for schedule in first:
        schedule.save(tmp_path / "round.json")
        assert Schedule.load(tmp_path / "round.json") == schedule


def test_every_fault_and_provocation_is_drawn() -> None:
    """Each round has two faults, all within its time."""
    rounds = [draw(1, number) for number in range(400)]
    faults = [fault for schedule in rounds for fault in schedule.faults]
    assert {fault.kind for fault in faults} == set(KINDS)
    assert {schedule.provocation.kind for schedule in rounds} == set(PROVOCATIONS)
    assert all(len(schedule.faults) == 2 for schedule in rounds)
    assert all(fault.begin + fault.duration < WINDOW for fault in faults)
