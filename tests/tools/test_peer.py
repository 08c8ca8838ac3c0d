"""The peer of the tests: its limits count the time in which it could look, and no other."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable

import pytest

from tests.support.ros import Peer

pytestmark = pytest.mark.ros


def _true_at(turn: int, pause: float) -> Callable[[], bool]:
    """Return a condition that becomes true at a turn; the machine holds the one before it up."""
    turns = itertools.count(1)

    def condition() -> bool:
        number = next(turns)
        if number == turn - 1:
            time.sleep(pause)
        return number >= turn

    return condition


def test_machine_that_holds_the_test_up_does_not_use_up_the_limit(ros_peer: Peer) -> None:
    """After a pause longer than the limit, the event that came meanwhile is still seen."""
    ros_peer.until(_true_at(3, pause=0.6), limit=0.4)
    assert ros_peer.held_up > 0.4


def test_event_that_does_not_come_uses_up_the_limit(ros_peer: Peer) -> None:
    """A wait ends with an error after the limit, and not before."""
    began = time.monotonic()
    with pytest.raises(AssertionError, match="did not come"):
        ros_peer.until(lambda: False, limit=0.3)
    assert time.monotonic() - began >= 0.3
