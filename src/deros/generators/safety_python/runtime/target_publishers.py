"""Who else publishes on the target of a gate: a second gate of its name, or a node past it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import time

from rclpy.node import Node
from rclpy.topic_endpoint_info import TopicEndpointInfo

from .instance import Refusal
from .publishers import listed, node_of

EARLY = 5_000_000_000  # ns; a gate that finds a second one within this time of its start gives way
LOOKS = 2  # in a row that have to find it: one that is just ending is not taken for it


class TargetPublishers:
    """Looks for publishers on the target of a gate beside its own."""

    def __init__(self, node: Node, target: str, report: Callable[[str, str], None]) -> None:
        """Prepare; report takes the topic and what is wrong with it, empty if nothing is."""
        self._node = node
        self._target = node.resolve_topic_name(target)
        self._report = report
        self._give_way_until = time.monotonic_ns() + EARLY
        self._found = 0  # looks in a row that have found a second gate

    def look(self) -> None:
        """Look now; raises Refusal if there is a second gate and this one has just started."""
        publishers = self._node.get_publishers_info_by_topic(self._target)
        self._report(self._target, '; '.join(self._faults(publishers)))

    def _faults(self, publishers: list[TopicEndpointInfo]) -> Iterator[str]:
        own = self._node.get_fully_qualified_name()
        others = [info for info in publishers if node_of(info) != own]
        is_second = len(publishers) - len(others) > 1
        self._found = self._found + 1 if is_second else 0
        if is_second:
            text = f'a second gate of the name {own} publishes on it'
            if self._found >= LOOKS and time.monotonic_ns() < self._give_way_until:
                raise Refusal(f'{self._target}: {text}; this one started last and ends now')
            yield text
        if others:
            yield f'published past the gate: {listed(others)}'
