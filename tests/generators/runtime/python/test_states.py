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
        self.created = 0
        self.topic = StateTopic(
            {"stop", "slow"}, self.message, self.messages.append, stamped=stamped
        )
        self.topic.begin(frozenset({"another"}))

    def message(self, active: Set[str]) -> Any:
        """Create the message, and count the calls."""
        self.created += 1
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
    published = Published()
    published.topic.show("stop", True)
    published.topic.show("slow", True)
    published.topic.show("stop", False)
    published.topic.publish()
    assert published.texts == ["stop", "slow stop", "slow", "slow"]


def test_next_message_is_prepared_in_advance() -> None:
    """When an action becomes active, the bytes exist already."""
    published = Published()
    created = published.created
    published.topic.show("stop", True)
    assert published.created == created
    published.topic.prepare()
    created = published.created
    published.topic.show("slow", True)
    assert published.created == created
    assert all(isinstance(message, bytes) for message in published.messages)


def test_number_of_messages_is_bounded() -> None:
    """Repeated changes reuse the messages."""
    published = Published()
    for _ in range(100):
        for action in ("stop", "slow"):
            for active in (True, False):
                published.topic.show(action, active)
                published.topic.prepare()
    assert published.created <= 4


def test_stamped_message_is_created_each_time() -> None:
    """Its stamp is the time of publication."""
    published = Published(stamped=True)
    published.topic.show("stop", True)
    published.topic.prepare()
    published.topic.publish()
    assert published.created == 2
    assert published.texts == ["stop", "stop"]


def test_latched_actions_are_published_at_the_start() -> None:
    """Only the actions of this topic count."""
    published = Published()
    published.topic.begin(frozenset({"stop", "another"}))
    published.topic.publish()
    assert published.texts == ["stop"]
