"""Checks the target of a gate: other publishers, and subscriptions that do not match."""

from __future__ import annotations

from collections.abc import Callable

from rclpy.node import Node
from rclpy.topic_endpoint_info import TopicEndpointInfo

from .endpoints import node_of
from .instance import Refusal
from .one_shot_timer import OneShotTimer, steady_clock
from .publishers import node_names, unmatched_subscriptions
from .start_order import StartOrder, YOUNG

PERIOD = 100_000_000  # ns between checks while a second gate may appear
EARLY = 2 * YOUNG  # ns after its start; a gate that met it while young has given way by then


class TargetPublisherCheck:
    """Checks for publishers besides the gate's own, and for subscriptions that do not match."""

    def __init__(self, node: Node, target: str, report: Callable[[str, str], None]) -> None:
        """Set up; report is called with the topic and its problem, empty if it has none."""
        self._node = node
        self._target = node.resolve_topic_name(target)
        self._report = report
        clock = steady_clock(node)
        self._now = clock.now
        started = self._now()
        self._order = StartOrder(started)
        self._early_until = started + EARLY
        self._early = OneShotTimer(clock, self._check_early)
        self._early.schedule(0)

    def check(self) -> None:
        """Check now; raises Refusal if there is a second gate and this one started last."""
        others, second = self._found()
        faults = [second] if second else []
        if others:
            faults.append(f'published past the gate: {node_names(others)}')
        self._report(self._target, '; '.join(faults))
        self._report(
            f'readers of {self._target}', unmatched_subscriptions(self._node, self._target)
        )

    def _check_early(self) -> None:
        if self._early.due < self._early_until:
            self._early.repeat(PERIOD)
        self._found()

    def _found(self) -> tuple[list[TopicEndpointInfo], str]:
        """Return the publishers of other nodes, and a message about a second gate."""
        publishers = self._node.get_publishers_info_by_topic(self._target)
        own = self._node.get_fully_qualified_name()
        others = [info for info in publishers if node_of(info) != own]
        has_double = len(publishers) - len(others) > 1
        text = f'a second gate of the name {own} publishes on it'
        if self._order.gives_way(has_double, self._now()):
            raise Refusal(f'{self._target}: {text}; this one started last and ends now')
        return others, text if has_double else ''
