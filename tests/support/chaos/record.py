"""What the campaign sees of the robot: each message at each place, with the steady time of it."""

from __future__ import annotations

import threading
import time
from bisect import bisect_left
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Message:
    """One message at one place.

    Attributes:
        time: steady, in s.
        place: ``sent`` where it was published, ``arrived`` where the proxy has put it.
        domain: in which domain that is.
        topic: its name.
        data: the serialized message.
    """

    time: float
    place: str
    domain: str
    topic: str
    data: bytes


class Record:
    """All messages of a round, in order of time, and when the recorder itself was held up."""

    TICK = 0.01
    """Seconds between two looks at the clock."""

    HELD_UP = 0.03
    """Seconds after which a late tick of the recorder counts as a delay."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self.messages: list[Message] = []
        self.delays: list[tuple[float, float]] = []
        self._changed = threading.Condition()
        self._ends = threading.Event()
        self._latest: dict[tuple[str, str, str], Message] = {}
        self._ticker = threading.Thread(target=self._tick, name="ticker", daemon=True)
        self._ticker.start()

    def add(self, place: str, domain: str, topic: str, data: bytes) -> None:
        """Note a message."""
        with self._changed:
            message = Message(time.monotonic(), place, domain, topic, data)
            self.messages.append(message)
            self._latest[place, domain, topic] = message
            self._changed.notify_all()

    def latest(self, place: str, domain: str, topic: str) -> Message | None:
        """Return the last message of a topic at a place."""
        return self._latest.get((place, domain, topic))

    def until(self, condition: Callable[[], Any], limit: float) -> bool:
        """Wait until a condition holds after some message; return whether it did in time."""
        with self._changed:
            return bool(self._changed.wait_for(condition, limit))

    def take(self, begin: float) -> tuple[list[Message], list[tuple[float, float]]]:
        """Hand over what came from ``begin`` on, and forget what was before."""
        with self._changed:
            first = bisect_left(self.messages, begin, key=lambda message: message.time)
            del self.messages[:first]
            self.delays = [each for each in self.delays if each[0] >= begin]
            return list(self.messages), list(self.delays)

    def close(self) -> None:
        """End the thread that looks at the clock."""
        self._ends.set()
        self._ticker.join()

    def _tick(self) -> None:
        before = time.monotonic()
        while not self._ends.wait(self.TICK):
            now = time.monotonic()
            if now - before - self.TICK > self.HELD_UP:
                self.delays.append((now, now - before - self.TICK))
            before = now


def of_topic(messages: Sequence[Message], place: str, domain: str, topic: str) -> Iterator[Message]:
    """Give the messages of one topic at one place."""
    for message in messages:
        if (message.topic, message.place, message.domain) == (topic, place, domain):
            yield message
