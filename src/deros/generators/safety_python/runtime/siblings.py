"""A second node of the same name on another machine."""

from __future__ import annotations

from collections.abc import Callable
import time

from rclpy.node import Node

from .instance import Refusal

EARLY = 5_000_000_000  # ns; who finds another one within this time of its start gives way


class Siblings:
    """Looks whether somebody else publishes the heartbeat of a node."""

    def __init__(self, node: Node, heartbeat: str, report: Callable[[str, str], None]) -> None:
        """Prepare; report takes the topic and what is wrong with it, empty if nothing is."""
        self._node = node
        self._heartbeat = heartbeat
        self._report = report
        self._give_way_until = time.monotonic_ns() + EARLY

    def look(self) -> None:
        """Look now; raises Refusal if there is one and this node has just started."""
        if self._node.count_publishers(self._heartbeat) <= 1:
            self._report(self._heartbeat, '')
            return
        text = 'another node publishes this heartbeat: whoever heeds it cannot tell them apart'
        if time.monotonic_ns() < self._give_way_until:
            raise Refusal(f'{self._heartbeat}: {text}; this one started last and ends now')
        self._report(self._heartbeat, text)
