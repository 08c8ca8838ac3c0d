"""Other publishers of what only this node may publish."""

from __future__ import annotations

from collections.abc import Callable, Iterable
import itertools
import time

from rclpy.node import Node

from .instance import Refusal
from .publishers import listed, node_of

EARLY = 5_000_000_000  # ns; who finds another one within this time of its start gives way


class Siblings:
    """
    Looks whether somebody else publishes the heartbeat of a node, or the states of its actions.

    The first is a second node of its name, on another machine or without a common folder for
    temporary files; the second contradicts it.
    """

    def __init__(
        self,
        node: Node,
        heartbeat: str,
        states: Iterable[str],
        report: Callable[[str, str], None],
    ) -> None:
        """Prepare; report takes a topic and what is wrong with it, empty if nothing is."""
        self._node = node
        self._heartbeat = heartbeat
        self._states = itertools.cycle(states)
        self._report = report
        self._give_way_until = time.monotonic_ns() + EARLY

    def look(self) -> None:
        """Look now; raises Refusal if there is a second node and this one has just started."""
        self._look_at_heartbeat()
        topic = next(self._states, None)
        if topic is not None:
            others = self._others(topic)
            text = f'published by {others}, too: whoever obeys it cannot tell them apart'
            self._report(topic, text if others else '')

    def _look_at_heartbeat(self) -> None:
        if self._node.count_publishers(self._heartbeat) <= 1:
            self._report(self._heartbeat, '')
            return
        text = 'another node publishes this heartbeat: whoever heeds it cannot tell them apart'
        if time.monotonic_ns() < self._give_way_until:
            raise Refusal(f'{self._heartbeat}: {text}; this one started last and ends now')
        self._report(self._heartbeat, text)

    def _others(self, topic: str) -> str:
        """Return the names of the nodes that publish on a topic besides this one."""
        if self._node.count_publishers(topic) <= 1:
            return ''
        own = self._node.get_fully_qualified_name()
        infos = self._node.get_publishers_info_by_topic(topic)
        return listed([info for info in infos if node_of(info) != own])
