"""Topics that carry the states of bound actions."""

from __future__ import annotations

from collections.abc import Set
from typing import Any

import pytest

pytest.importorskip("rclpy")
std_msgs = pytest.importorskip("std_msgs.msg")

from rclpy.serialization import deserialize_message  # noqa: E402

from deros.generators.runtime.python.deros_runtime.states import StateTopic  # noqa: E402


class Published:
    """A topic of two actions, and what went out on it."""

    def __init__(self, stamped: bool = False) -> None:
        """Begin with both inactive."""
        self.messages: list[Any] = []
        self.made = 0
        self.topic = StateTopic(
            {"stop", "slow"}, self.message, self.messages.append, stamped=stamped
        )
        self.topic.begin(frozenset({"another"}))

    def message(self, active: Set[str]) -> Any:
        """Make the message, and count how often."""
        self.made += 1
        return std_msgs.String(data=" ".join(sorted(active)))

    @property
    def texts(self) -> list[str]:
        """What the messages say."""
        return [
            deserialize_message(each, std_msgs.String).data
            if isinstance(each, bytes)
            else each.data
            for each in self.messages
        ]


def test_each_change_is_published() -> None:
    """Active, active as well, no more active; and again whenever it is asked for."""
    it = Published()
    it.topic.show("stop", True)
    it.topic.show("slow", True)
    it.topic.show("stop", False)
    it.topic.publish()
    assert it.texts == ["stop", "slow stop", "slow", "slow"]


def test_the_next_message_is_made_in_advance() -> None:
    """When an action becomes active, bytes are at hand."""
    it = Published()
    made = it.made
    it.topic.show("stop", True)
    assert it.made == made
    it.topic.prepare()
    made = it.made
    it.topic.show("slow", True)
    assert it.made == made
    assert all(isinstance(message, bytes) for message in it.messages)


def test_messages_are_not_made_for_ever() -> None:
    """However often the states change, there are only so many messages."""
    it = Published()
    for _ in range(100):
        for action in ("stop", "slow"):
            for active in (True, False):
                it.topic.show(action, active)
                it.topic.prepare()
    assert it.made <= 4


def test_a_stamped_message_is_made_each_time() -> None:
    """Its time is that of its publication."""
    it = Published(stamped=True)
    it.topic.show("stop", True)
    it.topic.prepare()
    it.topic.publish()
    assert it.made == 2
    assert it.texts == ["stop", "stop"]


def test_it_begins_with_what_is_latched() -> None:
    """The states of its own actions, whatever else is active."""
    it = Published()
    it.topic.begin(frozenset({"stop", "another"}))
    it.topic.publish()
    assert it.texts == ["stop"]
