"""Topics with the states of bound actions."""

from __future__ import annotations

from collections.abc import Set
from typing import Any

import pytest

pytest.importorskip("rclpy")
std_msgs = pytest.importorskip("std_msgs.msg")

from rclpy.serialization import deserialize_message  # noqa: E402

from deros.generators.runtime.python.deros_runtime.states import StateTopic  # noqa: E402


class Published:
    """A topic of two actions, and its messages."""

    def __init__(self, stamped: bool = False) -> None:
        """Start with both inactive."""
        self.messages: list[Any] = []
        self.made = 0
        self.topic = StateTopic(
            {"stop", "slow"}, self.message, self.messages.append, stamped=stamped
        )
        self.topic.begin(frozenset({"another"}))

    def message(self, active: Set[str]) -> Any:
        """Create the message, and count the calls."""
        self.made += 1
        return std_msgs.String(data=" ".join(sorted(active)))

    @property
    def texts(self) -> list[str]:
        """Return the texts of the messages."""
        return [
            deserialize_message(each, std_msgs.String).data
            if isinstance(each, bytes)
            else each.data
            for each in self.messages
        ]


def test_each_change_is_published() -> None:
    """Activation, second activation, deactivation, and repetition on request."""
    it = Published()
    it.topic.show("stop", True)
    it.topic.show("slow", True)
    it.topic.show("stop", False)
    it.topic.publish()
    assert it.texts == ["stop", "slow stop", "slow", "slow"]


def test_next_message_is_prepared_in_advance() -> None:
    """When an action becomes active, the bytes exist already."""
    it = Published()
    made = it.made
    it.topic.show("stop", True)
    assert it.made == made
    it.topic.prepare()
    made = it.made
    it.topic.show("slow", True)
    assert it.made == made
    assert all(isinstance(message, bytes) for message in it.messages)


def test_number_of_messages_is_bounded() -> None:
    """Repeated changes reuse the messages."""
    it = Published()
    for _ in range(100):
        for action in ("stop", "slow"):
            for active in (True, False):
                it.topic.show(action, active)
                it.topic.prepare()
    assert it.made <= 4


def test_stamped_message_is_created_each_time() -> None:
    """Its stamp is the time of publication."""
    it = Published(stamped=True)
    it.topic.show("stop", True)
    it.topic.prepare()
    it.topic.publish()
    assert it.made == 2
    assert it.texts == ["stop", "stop"]


def test_latched_actions_are_published_at_the_start() -> None:
    """Only the actions of this topic count."""
    it = Published()
    it.topic.begin(frozenset({"stop", "another"}))
    it.topic.publish()
    assert it.texts == ["stop"]
