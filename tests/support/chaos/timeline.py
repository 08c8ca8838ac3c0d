"""A round in a few lines of text, a character for each tenth of a second."""

from __future__ import annotations

from collections.abc import Sequence

from tests.support.chaos.links import (
    COMMAND,
    GATE,
    HEARTBEAT,
    LET_THROUGH,
    LOW_SPEED,
    MOTOR_STOP,
    PEDAL,
    PLANT,
    SAFETY,
    STOP,
    Topic,
)
from tests.support.chaos.record import Message, of_topic
from tests.support.chaos.rules import NAMES

STEP = 0.1

_ROWS: Sequence[tuple[str, str, Topic]] = (
    ("sent", SAFETY, HEARTBEAT),
    ("sent", SAFETY, STOP),
    ("sent", SAFETY, MOTOR_STOP),
    ("arrived", GATE, HEARTBEAT),
    ("arrived", GATE, STOP),
    ("arrived", GATE, LOW_SPEED),
    ("arrived", GATE, COMMAND),
    ("sent", GATE, LET_THROUGH),
    ("sent", PLANT, PEDAL),
)


def timeline(messages: Sequence[Message], begin: float, end: float) -> str:
    """Return a row for each topic that matters: ``.`` for silence, ``#`` for what is not zero."""
    steps = range(int((end - begin) / STEP) + 1)
    rows = [f"{'seconds':36}{''.join(f'{step // 10:<10}' for step in steps if step % 10 == 0)}"]
    shown = [(place, domain, topic.name) for place, domain, topic in _ROWS]
    shown += [("arrived", SAFETY, name) for name in NAMES]
    rows += [_row(messages, *each, begin, len(steps)) for each in shown]
    return "\n".join(rows)


def _row(
    messages: Sequence[Message], place: str, domain: str, topic: str, begin: float, steps: int
) -> str:
    """Say of each step what the last message in it said."""
    marks = ["."] * steps
    for message in of_topic(messages, place, domain, topic):
        step = int((message.time - begin) // STEP)
        if 0 <= step < steps:
            # After the header of four bytes, all zeros is false, zero or a command to stand.
            marks[step] = "#" if any(message.data[4:]) else "0"
    return f"{domain:7} {place:7} {topic:20} {''.join(marks)}"
