"""Detects other publishers of topics that only this node may publish."""

from __future__ import annotations

from collections.abc import Callable, Iterable
import itertools

from rclpy.node import Node

from .endpoints import node_of
from .instance import Refusal
from .publishers import node_names, unmatched_subscriptions
from .start_order import StartOrder


class DuplicateInstanceDetector:
    """
    Detects other publishers of a node's heartbeat, and of the states of its actions.

    The former is a second node of its name, on another machine or without a common folder for
    temporary files; the latter contradicts it. Subscriptions of these topics that do not match are
    reported, too.
    """

    def __init__(
        self,
        node: Node,
        heartbeat: str,
        states: Iterable[str],
        report: Callable[[str, str], None],
        now: Callable[[], int],
    ) -> None:
        """
        Set up; report is called with a topic and its problem, empty if it has none.

        now returns a steady time in nanoseconds.
        """
        self._node = node
        self._heartbeat = heartbeat
        own = list(states)
        self._states = itertools.cycle(own)
        self._offered = itertools.cycle([heartbeat, *own])
        self._report = report
        self._now = now
        self._order = StartOrder(now())

    def check(self) -> None:
        """Check now; raises Refusal if there is a second node and this one started last."""
        self._check_heartbeat()
        topic = next(self._states, None)
        if topic is not None:
            others = self._others(topic)
            text = f'published by {others}, too: its subscribers cannot tell them apart'
            self._report(topic, text if others else '')
        topic = next(self._offered)
        self._report(f'readers of {topic}', unmatched_subscriptions(self._node, topic))

    def _check_heartbeat(self) -> None:
        has_double = self._node.count_publishers(self._heartbeat) > 1
        text = 'another node publishes this heartbeat: its subscribers cannot tell them apart'
        if self._order.gives_way(has_double, self._now()):
            raise Refusal(f'{self._heartbeat}: {text}; this one started last and ends now')
        self._report(self._heartbeat, text if has_double else '')

    def _others(self, topic: str) -> str:
        """Return the names of the nodes that publish on a topic besides this one."""
        if self._node.count_publishers(topic) <= 1:
            return ''
        own = self._node.get_fully_qualified_name()
        infos = self._node.get_publishers_info_by_topic(topic)
        return node_names([info for info in infos if node_of(info) != own])
