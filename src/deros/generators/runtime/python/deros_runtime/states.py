"""Topics that carry the states of bound actions."""

from __future__ import annotations

from collections.abc import Callable, Set
from typing import Any

from rclpy.serialization import serialize_message


class _State:
    """A set of active actions, its message if that is always the same, and what can be next."""

    __slots__ = ('active', 'after', 'message')

    def __init__(self, active: frozenset[str], message: bytes) -> None:
        self.active = active
        self.message = message
        self.after: dict[tuple[str, bool], _State] = {}


class StateTopic:
    """
    A topic on which some actions show whether they are active.

    A message without a time stamp is made before it is needed, so that all that is left to do when
    an action becomes active is to look it up and hand it over.
    """

    def __init__(
        self,
        actions: Set[str],
        message: Callable[[Set[str]], Any],
        publish: Callable[[bytes], None],
        stamped: bool = False,
    ) -> None:
        """
        Prepare; begin() comes before anything else.

        The message of a set of active actions must always be the same unless it is stamped.
        publish takes it serialized.
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
        """Begin anew with some actions active; nothing is published yet."""
        self._state = self._get(frozenset(active & self.actions))
        self.prepare()

    def show(self, action: str, active: bool) -> None:
        """Publish that an action is active, or not; call prepare() when there is time."""
        state = self._state = self._state.after.get((action, active)) or self._next(action, active)
        self._publish(state.message or self._made(state.active))

    def publish(self) -> None:
        """Publish the present state."""
        self._publish(self._state.message or self._made(self._state.active))

    def prepare(self) -> None:
        """Make the messages that can be next."""
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
            state = _State(active, b'' if self._stamped else self._made(active))
            self._states[active] = state
        return state

    def _made(self, active: frozenset[str]) -> bytes:
        made: bytes = serialize_message(self._message(active))
        return made
