"""Heartbeats and states as a gate takes them: from the safety node, and from no other."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from rclpy.event_handler import EventHandler, QoSSubscriptionEventType
from rclpy.node import Node
from rclpy.subscription import Subscription

from .endpoints import node_of
from .gate_logic import Gate
from .publishers import matched_publishers, node_names

TURNS = 3  # of the executor's queue, which deals with an event in two


class SafetySource:
    """
    Passes heartbeats and states to the logic of a gate if only the safety node can have sent them.

    The safety node is the node of the heartbeat's only publisher; for a gate without a line about
    the heartbeat, it is the node of the only publishers of the states. rclpy does not report the
    sender of a message, so it follows from the graph and from the middleware's events:

    * When a publisher of a topic appears or disappears, all that was received on it is discarded.
    * A message that would release the robot, or for which it waits before it moves, waits until
      the graph shows the safety node as the only publisher of the topic, and until all earlier
      events have been handled. A publisher is in the graph before its first message can arrive,
      and the event of its appearance precedes that of its disappearance: a publisher that
      appeared, sent a message and disappeared in the meantime is detected by the one or the other.

    A message that stops the robot stops it without waiting.
    """

    def __init__(
        self,
        node: Node,
        now: Callable[[], int],
        settled: Callable[[], None],
        report: Callable[[str, str], None],
        gate: Gate,
    ) -> None:
        """Set up; settled is called after each call of the gate."""
        self._node = node
        self._gate = gate
        self._now = now
        self._settled = settled
        self._report = report
        self._heartbeat: Subscription | None = None
        self._states: dict[str, tuple[Subscription, tuple[str, ...]]] = {}  # with their actions
        self._is_sure = False  # that the heartbeat has one publisher
        self._changes = 0  # of the publishers of the heartbeat
        self._waiting: dict[str, Mapping[str, bool]] = {}  # states that are not trusted yet
        self._handlers: list[EventHandler] = []

    # Setup

    def add_heartbeat(self, topic: str) -> None:
        """Observe the publishers of the heartbeat."""
        self._heartbeat = self._subscription(topic)
        self._watch(self._heartbeat, self._on_heartbeat_change)

    def add_state(self, topic: str, actions: tuple[str, ...]) -> None:
        """Observe the publishers of a topic with the states of actions."""
        subscription = self._subscription(topic)
        self._states[topic] = subscription, actions
        self._watch(subscription, lambda: self._on_state_change(topic))

    # Messages

    def take_heartbeat(self, counter: int | None) -> None:
        """Handle a heartbeat; None is one that could not be read."""
        if counter is None:
            self._gate.on_no_safety_node(self._now())
        elif self._is_sure:
            self._gate.on_heartbeat(self._now(), counter)
        elif self._safety_node():
            changes = self._changes
            self._after_events(lambda: self._on_sure(changes))
        self._settled()

    def take_state(self, topic: str, active: Mapping[str, bool]) -> None:
        """Handle the states of a topic: active ones at once, others when they are trusted."""
        if self._gate.on_state(self._now(), active, False):
            self._waiting.pop(topic, None)
        elif self._waiting.get(topic) != active and self._is_of_safety_node(topic):
            self._waiting[topic] = active
            self._after_events(lambda: self._on_trusted(topic, active))
        self._settled()

    # Trust

    def _after_events(self, callback: Callable[[], None], turns: int = TURNS) -> None:
        """Call back when all that the executor has queued up to now is handled."""
        executor = self._node.executor
        assert executor is not None
        if turns > 1:
            executor.create_task(lambda: self._after_events(callback, turns - 1))
        else:
            executor.create_task(callback)

    def _on_sure(self, changes: int) -> None:
        self._is_sure = changes == self._changes

    def _on_trusted(self, topic: str, active: Mapping[str, bool]) -> None:
        if self._waiting.get(topic) is active:
            del self._waiting[topic]
            self._gate.on_state(self._now(), active, True)
            self._settled()

    def _on_heartbeat_change(self) -> None:
        """Discard all when a publisher of the heartbeat has appeared or disappeared."""
        self._changes += 1
        self._is_sure = False
        self._waiting.clear()
        self._gate.on_no_safety_node(self._now())
        self._settled()

    def _on_state_change(self, topic: str) -> None:
        """Treat all actions of a topic as active when its publishers have changed."""
        self._waiting.pop(topic, None)
        _, actions = self._states[topic]
        self._gate.on_state(self._now(), dict.fromkeys(actions, True), False)
        self._settled()

    # The graph

    def _safety_node(self) -> str:
        """Return the name of the safety node; empty if it is not known, or there are several."""
        heard = [self._heartbeat] if self._heartbeat else [s for s, _ in self._states.values()]
        publishers = [matched_publishers(self._node, each) for each in heard]
        nodes = {node_of(info) for infos in publishers for info in infos}
        return nodes.pop() if len(nodes) == 1 and max(map(len, publishers)) == 1 else ''

    def _is_of_safety_node(self, topic: str) -> bool:
        subscription, _ = self._states[topic]
        safety_node = self._safety_node()
        found = matched_publishers(self._node, subscription)
        nodes = [node_of(info) for info in found]
        is_stranger = safety_node and len(nodes) == 1 and nodes[0] not in ('', safety_node)
        text = f'{node_names(found)} publishes it, not the safety node {safety_node}'
        self._report(f'state on {subscription.topic_name}', text if is_stranger else '')
        return bool(safety_node) and nodes == [safety_node]

    def _subscription(self, topic: str) -> Subscription:
        name = self._node.resolve_topic_name(topic)
        return next(each for each in self._node.subscriptions if each.topic_name == name)

    def _watch(self, subscription: Subscription, changed: Callable[[], None]) -> None:
        handler = EventHandler(
            callback_group=subscription.callback_group,
            callback=lambda _: changed(),
            event_type=QoSSubscriptionEventType.RCL_SUBSCRIPTION_MATCHED,
            parent_impl=subscription.handle,
        )
        self._handlers.append(handler)
        self._node.add_waitable(handler)
