"""Messages with a time stamp."""

from __future__ import annotations

from deros.generators.safety_node.messages import is_stamped
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType

STORE = InterfaceStore()


def test_messages_with_a_header_are_stamped() -> None:
    """Only a header of std_msgs counts."""
    assert is_stamped(STORE, InterfaceType("geometry_msgs", "msg", "TwistStamped"))
    assert not is_stamped(STORE, InterfaceType("geometry_msgs", "msg", "Twist"))
    assert not is_stamped(STORE, InterfaceType("no_such", "msg", "Thing"))
