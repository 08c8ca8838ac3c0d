"""Publishes the states of bound actions."""

from __future__ import annotations

from collections.abc import Callable, Set
from typing import Any

from rclpy.serialization import serialize_message


class _State:
    """A set of active actions, its serialized message, and the states that can follow."""

    __slots__ = ('active', 'after', 'message')

    def __init__(self, active: frozenset[str], message: bytes) -> None:
        self.active = active
        self.message = message
        self.after: dict[tuple[str, bool], _State] = {}


class StateTopic:
    """
    Publishes the states of some actions on one topic.

    Messages without a time stamp are serialized in advance, so that all that is left to do when an
    action becomes active is to look one up and publish it.
    """

    def __init__(
        self,
        actions: Set[str],
        message: Callable[[Set[str]], Any],
        publish: Callable[[bytes], None],
        stamped: bool = False,
    ) -> None:
        """
        Create the topic; call begin() before anything else.

        message returns the message of a set of active actions, which is always the same unless it
        is stamped; publish takes it serialized.
        """
        self.actions = actions
        self._message = message
        self._publish = publish
        self._stamped = stamped
        self._states: dict[frozenset[str], _State] = {}
        self._state = self._get(frozenset())

    @property
    def active(self) -> frozenset[str]:
        """Return the actions that are active."""
        return self._state.active

    def begin(self, active: Set[str]) -> None:
        """Start again with some actions active, without publishing anything."""
        self._state = self._get(frozenset(active & self.actions))
        self.prepare()

    def show(self, action: str, active: bool) -> None:
        """Publish that an action is active, or not; call prepare() later, when there is time."""
        state = self._state = self._state.after.get((action, active)) or self._next(action, active)
        self._publish(state.message or self._serialized(state.active))

    def publish(self) -> None:
        """Publish the current state."""
        self._publish(self._state.message or self._serialized(self._state.active))

    def prepare(self) -> None:
        """Serialize the messages that can follow."""
        for action in self.actions:
            for active in (True, False):
                self._next(action, active)

    def _next(self, action: str, active: bool) -> _State:
        now = self._state.active
        state = self._get(now | {action} if active else now - {action})
        self._state.after[action, active] = state
        return state

    def _get(self, active: frozenset[str]) -> _State:
        state = self._states.get(active)
        if state is None:
            state = _State(active, b'' if self._stamped else self._serialized(active))
            self._states[active] = state
        return state

    def _serialized(self, active: frozenset[str]) -> bytes:
        data: bytes = serialize_message(self._message(active))
        return data
