"""The referee of the gate that uses every line: it names each violation that is planted."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from tests.support.chaos.lines import LinesReferee
from tests.support.chaos.links import GATE, JOYSTICK
from tests.support.chaos.record import Message
from tests.support.chaos.schedule import WITH_JOYSTICK, draw
from tests.tools.test_referee import END, Value, after, robot, stream

pytest.importorskip("rclpy")

RULED = {"passed": lambda _: 0.3, "passed_arrives": lambda _: 0.3}
"""What a gate passes of 0.4 m/s that keeps to the standing limit."""


def reasons(joystick: Value | None = None, ok: Value | None = None, **replaced: Value) -> str:
    """Return of what the gate is accused in a round, with some streams replaced or added."""

    def added() -> Iterator[Message]:
        if joystick is not None:
            yield from stream("arrived", GATE, JOYSTICK.name, joystick)
        yield from stream("arrived", GATE, "/safety/controller_ok", ok or (lambda _: True))

    messages = [*robot(**{**RULED, **replaced}), *added()]
    verdict = LinesReferee(sorted(messages, key=lambda m: m.time), [], 0.0, END, False).judge()
    return "; ".join(each.reason for each in verdict.violations if each.duty == "gate")


def ramp(begin: float, rate: float) -> Value:
    """Return a speed that falls from 0.3 m/s."""
    return lambda now: 0.3 if now < begin else max(0.3 - rate * (now - begin), 0.0)


def steered(now: float) -> Any:
    """Return the command of a joystick that is let go after two seconds."""
    return 0.2 if 1.0 <= now < 2.0 else None


def test_gate_that_does_all_as_it_should_is_not_accused() -> None:
    """It passes, ramps, hands over after a zero, and is silent without a heartbeat."""
    assert reasons() == ""
    assert reasons(stop_arrives=after(2.0, True, False), passed=ramp(2.0, 1.0)) == ""
    handed_over = {"command": lambda now: 0.0 if 2.5 < now < 3.0 else 0.4}
    passed: Value = lambda now: 0.0 if 2.3 < now < 3.0 else 0.2 if 1.0 <= now < 2.3 else 0.3  # noqa: E731
    assert reasons(steered, passed=passed, **handed_over) == ""
    beats: Value = lambda now: None if now > 2.0 else round(now * 10) + 100  # noqa: E731
    assert reasons(beat_arrives=beats, passed=after(2.3, None, 0.3)) == ""


@pytest.mark.parametrize(
    ("planted", "reason"),
    [
        ({"passed": lambda _: 0.4}, "above the limit that stands"),
        ({"stop_arrives": after(2.0, True, False)}, "after the stop has arrived"),
        (
            {"stop_arrives": after(2.0, True, False), "passed": ramp(2.0, 0.3)},
            "after the stop has arrived",
        ),
        (
            {"slow_arrives": after(2.0, True, False), "passed": after(3.0, 0.3, 0.1)},
            "is to hold 0.10 m/s",
        ),
        ({"command": after(2.0, None, 0.4)}, "after a command"),
        ({"joystick": steered}, "the mission has not commanded zero"),
        (
            {"passed": after(2.0, 0.3, 0.0), "ok": after(1.9, True, False)},
            "nobody has warned for 0.3 s",
        ),
        (
            {
                "beat_arrives": lambda now: None if 2.0 < now < 3.0 else round(now * 10) + 100,
                "passed": after(2.3, 0.0, 0.3),
            },
            "it is not silent",
        ),
    ],
)
def test_planted_violation_is_named(planted: dict[str, Any], reason: str) -> None:
    """Each line of the gate is broken once."""
    assert reason in reasons(**planted)


def test_joystick_is_drawn() -> None:
    """An operator takes over in some of the rounds."""
    rounds = [draw(1, number, provocations=WITH_JOYSTICK) for number in range(100)]
    assert {schedule.provocation.kind for schedule in rounds} == set(WITH_JOYSTICK)
