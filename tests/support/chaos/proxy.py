"""Carries messages from domain to domain, raw, and badly where a fault says so.

Each topic is subscribed to in the domain where it is published, and published in the others with
the QoS that its publisher has: reliable, with its durability and depth. The bytes stay as they
are. When the node behind a topic ends, so does its publisher here, and a new one takes over when
the node is back: who listens there sees what it would see without a proxy. What a foreign process
says to the safety node has arrived there, too: such topics are noted by a subscription over there.
"""

from __future__ import annotations

import random
import threading
import time
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from tests.support.chaos.links import (
    BY_NAME,
    CARRIED,
    DOMAINS,
    LINKS,
    PEDAL,
    SAFETY,
    Link,
    Topic,
)
from tests.support.chaos.record import Record
from tests.support.chaos.schedule import FOREIGN

_SHARED = frozenset(Link(name, domain) for name, domain in FOREIGN if domain == SAFETY)
"""Links into a domain where foreign nodes may publish, too."""

HISTORY = 50
"""Messages of a link that may be said again."""


@dataclass
class Line:
    """The end of a link: its publisher, and what is wrong with it at present."""

    link: Link
    publisher: Any
    faults: dict[str, float] = field(default_factory=dict)
    waiting: deque[tuple[float, bytes]] = field(default_factory=deque)
    history: deque[bytes] = field(default_factory=lambda: deque(maxlen=HISTORY))


class Proxy:
    """Nodes in all domains, each with a thread of its own, and one thread for late messages."""

    def __init__(self, domains: dict[str, int], record: Record, seed: int = 0) -> None:
        """Join the domains, whose numbers are given by name."""
        import rclpy
        from rclpy.context import Context
        from rclpy.experimental.events_executor import EventsExecutor
        from rclpy.node import Node

        self._record = record
        self._chance = random.Random(seed)
        self._lock = threading.RLock()
        self._ends = threading.Event()
        self._lines: dict[Link, Line] = {}
        self.nodes: dict[str, Any] = {}
        self._contexts: list[Any] = []
        self._executors: list[Any] = []
        self._threads: list[threading.Thread] = []
        for name in DOMAINS:
            context = Context()
            rclpy.init(context=context, domain_id=domains[name])
            node: Any = Node(f"chaos_{name}", context=context, enable_rosout=False)
            self._contexts.append(context)
            self.nodes[name] = node
        for link in LINKS:
            self._lines[link] = Line(link, self._publisher(link))
        for topic in (*CARRIED, PEDAL):
            self._subscribe(topic)
        for link in _SHARED:
            self._note_arrivals(link)
        for name, context in zip(DOMAINS, self._contexts, strict=True):
            executor = EventsExecutor(context=context)
            executor.add_node(self.nodes[name])
            self._executors.append(executor)
            self._run(name, lambda executor=executor: executor.spin_once(timeout_sec=0.1))
        self._run("late", self._send_late)

    def _run(self, name: str, work: Any) -> None:
        def loop() -> None:
            while not self._ends.is_set():
                work()

        thread = threading.Thread(target=loop, name=f"proxy {name}", daemon=True)
        thread.start()
        self._threads.append(thread)

    def _publisher(self, link: Link) -> Any:
        topic = BY_NAME[link.topic]
        return self.nodes[link.target].create_publisher(
            topic.message_type(), topic.name, _profile(topic, topic.depth)
        )

    def _subscribe(self, topic: Topic) -> None:
        def receive(data: bytes) -> None:
            self._record.add("sent", topic.source, topic.name, data)
            with self._lock:
                for target in topic.targets:
                    self._carry(self._lines[Link(topic.name, target)], data)

        self.nodes[topic.source].create_subscription(
            topic.message_type(), topic.name, receive, _profile(topic, 100), raw=True
        )

    def _note_arrivals(self, link: Link) -> None:
        topic = BY_NAME[link.topic]

        def receive(data: bytes) -> None:
            self._record.add("arrived", link.target, topic.name, data)

        self.nodes[link.target].create_subscription(
            topic.message_type(), topic.name, receive, _profile(topic, 100), raw=True
        )

    # What becomes of a message ------------------------------------------------------------------

    def _carry(self, line: Line, data: bytes) -> None:
        faults = line.faults
        if "drop" in faults and self._chance.random() < faults["drop"]:
            return
        line.history.append(data)
        copies = 1 + int(faults.get("duplicate", 0.0))
        words = [data] * copies
        if "replay" in faults:
            words.append(self._chance.choice(line.history))
        due = time.monotonic() + faults.get("delay", 0.0)
        for word in words:
            if "delay" in faults or line.waiting:  # none overtakes another
                line.waiting.append((max(due, line.waiting[-1][0] if line.waiting else 0.0), word))
            else:
                self._deliver(line, word)

    def _deliver(self, line: Line, data: bytes) -> None:
        if line.link not in _SHARED:
            self._record.add("arrived", line.link.target, line.link.topic, data)
        if line.publisher is not None:
            line.publisher.publish(data)

    def _send_late(self) -> None:
        self._ends.wait(0.005)
        now = time.monotonic()
        with self._lock:
            for line in self._lines.values():
                while line.waiting and line.waiting[0][0] <= now:
                    self._deliver(line, line.waiting.popleft()[1])

    # What the campaign does ---------------------------------------------------------------------

    def fault(self, link: Link, kind: str, amount: float) -> None:
        """Let a link be bad in some way from now on."""
        with self._lock:
            self._lines[link].faults[kind] = amount

    def heal(self, link: Link, kind: str) -> None:
        """Let it be good again in that way."""
        with self._lock:
            self._lines[link].faults.pop(kind, None)

    def heal_all(self) -> None:
        """Let all links be good, and forget what they have carried."""
        with self._lock:
            for line in self._lines.values():
                line.faults.clear()
                line.history.clear()

    def silence(self, topics: Sequence[Topic]) -> None:
        """Let the publishers of some topics go away, as those of a node that has ended."""
        with self._lock:
            for line in self._of(topics):
                if line.publisher is not None:
                    self.nodes[line.link.target].destroy_publisher(line.publisher)
                    line.publisher = None

    def revive(self, topics: Sequence[Topic]) -> None:
        """Let new ones take over, as those of a node that was started again."""
        with self._lock:
            for line in self._of(topics):
                if line.publisher is None:
                    line.publisher = self._publisher(line.link)

    def _of(self, topics: Sequence[Topic]) -> list[Line]:
        names = {topic.name for topic in topics}
        return [line for line in self._lines.values() if line.link.topic in names]

    def close(self) -> None:
        """Leave the domains."""
        self._ends.set()
        for thread in self._threads:
            thread.join()
        for executor, node in zip(self._executors, self.nodes.values(), strict=True):
            executor.shutdown()
            node.destroy_node()
        for context in self._contexts:
            context.try_shutdown()


def _profile(topic: Topic, depth: int) -> Any:
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    durability = DurabilityPolicy.TRANSIENT_LOCAL if topic.latched else DurabilityPolicy.VOLATILE
    return QoSProfile(depth=depth, reliability=ReliabilityPolicy.RELIABLE, durability=durability)
