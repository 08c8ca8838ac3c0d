"""Topics that carry the states of bound actions."""

from __future__ import annotations

from collections.abc import Callable, Set
from typing import Any

from rclpy.serialization import serialize_message


class StateTopic:
    """
    A topic on which some actions show whether they are active.

    A message without a time stamp is made before it is needed, so that all that is left to do when
    an action becomes active is to hand over bytes.
    """

    def __init__(
        self,
        actions: Set[str],
        message: Callable[[Set[str]], Any],
        publish: Callable[[Any], None],
        stamped: bool = False,
    ) -> None:
        """
        Prepare; begin() comes before anything else.

        The message of a set of active actions must always be the same unless it is stamped.
        """
        self.active: frozenset[str] = frozenset()
        self._actions = actions
        self._message = message
        self._publish = publish
        self._stamped = stamped
        self._made: dict[frozenset[str], bytes] = {}

    def begin(self, active: Set[str]) -> None:
        """Begin anew with some actions active; nothing is published yet."""
        self.active = frozenset(active & self._actions)
        self.prepare()

    def show(self, action: str, active: bool) -> None:
        """Publish that an action is active, or not; call prepare() when there is time."""
        self.active = self.active | {action} if active else self.active - {action}
        self.publish()

    def publish(self) -> None:
        """Publish the present state."""
        if self._stamped:
            self._publish(self._message(self.active))
            return
        self._publish(self._made.get(self.active) or self._make(self.active))

    def prepare(self) -> None:
        """Make the messages that can be next."""
        if self._stamped:
            return
        for action in self._actions:
            for state in (self.active | {action}, self.active - {action}):
                if state not in self._made:
                    self._make(state)

    def _make(self, state: frozenset[str]) -> bytes:
        made: bytes = serialize_message(self._message(state))
        self._made[state] = made
        return made
