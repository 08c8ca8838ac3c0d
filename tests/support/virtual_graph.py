"""A ROS 2 graph in virtual time: nodes of one process, without middleware and without waiting.

Generated nodes run here unchanged, but for their base class: publishers, subscriptions, services,
timers and parameters are plain objects. Messages are serialized as on the wire. As in rclpy's
EventsExecutor, all work of a node passes through one queue, and an event of the middleware takes
two turns in it. What the middleware and the machine add to that is tested on the real ones.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from types import SimpleNamespace
from typing import Any

from rclpy.clock import JumpThreshold
from rclpy.clock_type import ClockType
from rclpy.parameter import Parameter
from rclpy.qos import (
    DurabilityPolicy,
    QoSCompatibility,
    QoSProfile,
    qos_check_compatible,
)
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.time import Time

from tests.support.clockwork import Timer, VirtualClock

SECOND = 1_000_000_000
WALL = 1_700_000_000 * SECOND
"""By how much the wall clock is ahead of the steady clock."""


class Graph:
    """All nodes, and the steady clock that they share.

    Attributes:
        clock: the steady clock.
        nodes: the nodes whose endpoints others know.
        events_are_late: whether subscriptions learn of a publisher after its first messages.
    """

    def __init__(self) -> None:
        """Begin without nodes, 1000 s after the start of the machine."""
        self.events_are_late = False
        self._late: list[VirtualSubscription] = []
        self.clock = VirtualClock(1000 * SECOND)
        self.nodes: list[VirtualNode] = []
        self._timers: list[Timer] = []

    @property
    def now(self) -> int:
        """Return the steady time, in nanoseconds."""
        return self.clock.now

    def later(self, seconds: float, callback: Callable[[], object]) -> None:
        """Call back once, a time from now, whatever the nodes do."""

        def expire() -> None:
            self._timers.remove(timer)
            callback()

        timer = Timer(self.clock, expire, round(seconds * SECOND))
        timer.reset()
        self._timers.append(timer)

    def run(self, seconds: float, until: Callable[[], object] = lambda: False) -> bool:
        """Run all nodes for a time, or until something is true; return whether it became true."""
        end = self.now + round(seconds * SECOND)
        while not until():
            if self.turn():
                continue
            timer = min(self._running(), key=lambda each: each[0], default=None)
            if timer is None or timer[0] > end:
                self.clock.now = end
                return bool(until())
            self.clock.now = max(self.now, timer[0])
            timer[1].call()
        return True

    def until(self, condition: Callable[[], object], seconds: float = 60.0) -> None:
        """Run until something is true.

        Raises:
            AssertionError: if it does not become true in so many seconds of virtual time.
        """
        assert self.run(seconds, condition), "the awaited event did not come"

    def turn(self) -> bool:
        """Take one turn of each queue; return whether there was one."""
        while self._late:
            self._late.pop(0).matched()
        busy = [node for node in self.nodes if node.queue and node.is_running]
        for node in busy:
            if node.queue and node.is_running:
                node.queue.popleft()()
        return bool(busy)

    def _running(self) -> Iterator[tuple[int, Timer]]:
        """Yield the timers that will expire, with the steady time of that."""
        nodes = [timer for node in self.nodes if node.is_running for timer in node.timers]
        for timer in (*self._timers, *nodes):
            if timer.expires is None:
                continue
            if timer.clock is self.clock:
                yield timer.expires, timer
            elif timer.expires <= timer.clock.now:
                yield self.now, timer

    # Endpoints

    def publishers(self, topic: str, viewer: VirtualNode) -> list[VirtualPublisher]:
        """Return the publishers of a topic that a node knows of."""
        nodes = [node for node in self.nodes if viewer in (node.known_to or self.nodes)]
        return [each for n in nodes for each in n.publishers if each.topic_name == topic]

    def subscriptions(self, topic: str) -> list[VirtualSubscription]:
        """Return the subscriptions of a topic."""
        return [each for n in self.nodes for each in n.subscriptions if each.topic_name == topic]

    def connect(self, end: VirtualPublisher | VirtualSubscription, appears: bool = True) -> None:
        """Let an endpoint appear to the others, or disappear."""
        if isinstance(end, VirtualPublisher):
            known_to = end.node.known_to or self.nodes
            subscriptions = self.subscriptions(end.topic_name)
            pairs = [(end, each) for each in subscriptions if each.node in known_to]
        else:
            pairs = [(each, end) for each in self.publishers(end.topic_name, end.node)]
        for publisher, subscription in pairs:
            if publisher.fits(subscription):
                if self.events_are_late:
                    self._late.append(subscription)
                else:
                    subscription.matched()
                if appears and publisher.last is not None and subscription.is_latched:
                    subscription.receive(publisher.last)

    def call(self, service: str, request: Any, seconds: float = 10.0) -> Any:
        """Call a service and return its response."""
        responses: list[Any] = []
        node, kind, handle = next(
            (n, *n.services[service]) for n in self.nodes if service in n.services
        )
        node.queue.append(lambda: responses.append(handle(request, kind.Response())))
        self.until(lambda: responses, seconds)
        return responses[0]


class VirtualPublisher:
    """A publisher; it is its own handle.

    Attributes:
        last: the last message, serialized, which late subscriptions get if both ends latch.
    """

    def __init__(self, node: VirtualNode, msg_type: Any, topic: str, qos: QoSProfile) -> None:
        """Be unknown to the others yet."""
        self.node, self.msg_type, self.topic_name, self.qos_profile = node, msg_type, topic, qos
        self.last: bytes | None = None
        self.handle = self

    def fits(self, subscription: VirtualSubscription) -> bool:
        """Return whether the middleware connects the two."""
        compatible, _ = qos_check_compatible(self.qos_profile, subscription.qos_profile)
        return self.msg_type is subscription.msg_type and compatible != QoSCompatibility.ERROR

    def get_subscription_count(self) -> int:
        """Return how many subscriptions the middleware connects it to."""
        return sum(map(self.fits, self.node.graph.subscriptions(self.topic_name)))

    def publish(self, msg: Any) -> None:
        """Deliver a message, serialized or not, to all matching subscriptions."""
        data = msg if isinstance(msg, bytes) else serialize_message(msg)
        if self.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL:
            self.last = data
        for subscription in self.node.graph.subscriptions(self.topic_name):
            if self.fits(subscription):
                subscription.receive(data)

    publish_raw = publish


class VirtualSubscription:
    """A subscription; it is its own handle."""

    callback_group = None

    def __init__(
        self,
        node: VirtualNode,
        msg_type: Any,
        topic: str,
        callback: Callable[[Any], None],
        qos: QoSProfile,
        raw: bool,
    ) -> None:
        """Be unknown to the others yet."""
        self.node, self.msg_type, self.topic_name, self.qos_profile = node, msg_type, topic, qos
        self.handle = self
        self.handlers: list[MatchedHandler] = []
        self.is_latched = qos.durability == DurabilityPolicy.TRANSIENT_LOCAL
        self._callback = callback
        self._raw = raw
        self._waiting: deque[bytes] = deque(maxlen=qos.depth)

    def get_publisher_count(self) -> int:
        """Return how many publishers the middleware connects it to."""
        known = self.node.graph.publishers(self.topic_name, self.node)
        return sum(each.fits(self) for each in known)

    def receive(self, data: bytes) -> None:
        """Take a message; the oldest that waits is lost if there is no room."""
        if len(self._waiting) < self.qos_profile.depth:
            self.node.queue.append(self._take)
        self._waiting.append(data)

    def matched(self) -> None:
        """Take note that a publisher has appeared or disappeared, two turns from now."""
        for handler in self.handlers:
            self.node.queue.append(partial(self.node.queue.append, handler.call))

    def _take(self) -> None:
        data = self._waiting.popleft()
        self._callback(data if self._raw else deserialize_message(data, self.msg_type))


class MatchedHandler:
    """What rclpy's EventHandler is for the publishers of a subscription."""

    def __init__(
        self,
        *,
        callback: Callable[[None], None],
        parent_impl: VirtualSubscription,
        **_: object,
    ) -> None:
        """Wait for Node.add_waitable()."""
        self.subscription = parent_impl
        self._callback = callback

    def call(self) -> None:
        """Handle the event."""
        self._callback(None)


class RosClock:
    """The clock of a node: system time, or that of /clock.

    Attributes:
        shown: the time that it shows; its timers expire by that.
    """

    def __init__(self, node: VirtualNode) -> None:
        """Show nothing of /clock yet."""
        self.shown = VirtualClock()
        self._node = node
        self._jumps: list[tuple[JumpThreshold, Callable[[Any], None]]] = []

    def now(self) -> Time:
        """Return the time."""
        is_simulated = self._node.get_parameter("use_sim_time").value
        shown = self.shown.now if is_simulated else self._node.graph.now + WALL
        return Time(nanoseconds=shown, clock_type=ClockType.ROS_TIME)

    def create_jump_callback(
        self, threshold: JumpThreshold, *, post_callback: Callable[[Any], None]
    ) -> object:
        """Call back after each step that exceeds the threshold."""
        self._jumps.append((threshold, post_callback))
        return post_callback

    def set(self, now: int) -> None:
        """Take a time from /clock."""
        step, self.shown.now = now - self.shown.now, now
        for timer in self._node.timers:
            if timer.clock is self.shown and step < 0 and timer.expires is not None:
                timer.expires = now + timer.timer_period_ns  # as rcl does
        jump = SimpleNamespace(delta=SimpleNamespace(nanoseconds=step))
        for threshold, callback in self._jumps:
            forward, backward = threshold.min_forward, threshold.min_backward
            if (forward is not None and step >= forward.nanoseconds) or (
                backward is not None and step <= backward.nanoseconds
            ):
                callback(jump)


class VirtualNode:
    """What generated nodes use of rclpy's Node.

    Attributes:
        graph: the graph that it is in.
        queue: the work of its executor.
        is_running: whether it is neither frozen nor dead.
        known_to: once it was killed, the other nodes of that time: none that comes later hears of
            it.
        log: what it has logged.
    """

    def __init__(
        self, name: str, *, graph: Graph, parameters: dict[str, Any] | None = None
    ) -> None:
        """Appear in the graph."""
        self.graph, self._name = graph, name
        self.queue: deque[Callable[[], Any]] = deque()
        self.is_running = True
        self.known_to: list[VirtualNode] = []
        self.log: list[str] = []
        self.publishers: list[VirtualPublisher] = []
        self.subscriptions: list[VirtualSubscription] = []
        self.services: dict[str, tuple[Any, Callable[[Any, Any], Any]]] = {}
        self.timers: list[Timer] = []
        self.context: Any = SimpleNamespace(get_domain_id=lambda: 7)
        self.executor: Any = SimpleNamespace(create_task=self.queue.append)
        self._overrides = parameters or {}
        self._parameters: dict[str, Parameter] = {}
        self._checks: list[Callable[[list[Parameter]], Any]] = []
        self._applied: list[Callable[[list[Parameter]], None]] = []
        self._clock = RosClock(self)
        graph.nodes.append(self)
        self.declare_parameter("use_sim_time", False)
        if self.get_parameter("use_sim_time").value:
            from rosgraph_msgs.msg import Clock  # type: ignore[import-untyped]

            self.create_subscription(Clock, "/clock", self._on_clock, 1)

    def _on_clock(self, msg: Any) -> None:
        self._clock.set(msg.clock.sec * SECOND + msg.clock.nanosec)

    # What happens to processes

    def freeze(self) -> None:
        """Do nothing, as after SIGSTOP."""
        self.is_running = False

    def thaw(self) -> None:
        """Go on, as after SIGCONT."""
        self.is_running = True

    def kill(self, lease: float = 1.0) -> None:
        """End without a word: others know of the endpoints until the lease ends."""
        self.is_running = False
        self.queue.clear()
        self.timers.clear()
        self.known_to = [*self.graph.nodes]
        self.graph.later(lease, self.destroy_node)

    def destroy_node(self) -> None:
        """Disappear from the graph."""
        self.is_running = False
        for publisher in [*self.publishers]:
            self.destroy_publisher(publisher)
        self.graph.nodes.remove(self)

    # Names and parameters

    def get_name(self) -> str:
        """Return the name."""
        return self._name

    def get_fully_qualified_name(self) -> str:
        """Return the name with its namespace."""
        return f"/{self._name}"

    def resolve_topic_name(self, topic: str) -> str:
        """Return the full name of a topic."""
        return topic.replace("~", f"/{self._name}") if topic.startswith(("/", "~")) else f"/{topic}"

    def get_logger(self) -> Any:
        """Return a logger that keeps all."""
        take = self.log.append
        return SimpleNamespace(info=take, warning=take, error=take, fatal=take)

    def get_clock(self) -> Any:
        """Return the clock of the node."""
        return self._clock

    def declare_parameter(self, name: str, default: Any, _descriptor: Any = None) -> None:
        """Declare a parameter."""
        self._parameters[name] = Parameter(name, value=self._overrides.get(name, default))

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter."""
        return self._parameters[name]

    def add_on_set_parameters_callback(self, check: Callable[[list[Parameter]], Any]) -> None:
        """Check later changes of parameters."""
        self._checks.insert(0, check)

    def add_post_set_parameters_callback(self, applied: Callable[[list[Parameter]], None]) -> None:
        """Call back after changes of parameters."""
        self._applied.append(applied)

    def set_parameter(self, name: str, value: Any) -> str:
        """Change a parameter, and return why that was rejected."""
        changed = [Parameter(name, value=value)]
        for check in self._checks:
            result = check(changed)
            if not result.successful:
                return str(result.reason)
        self._parameters[name] = changed[0]
        for applied in self._applied:
            applied(changed)
        return ""

    # Ports and timers

    def create_publisher(self, msg_type: Any, topic: str, qos: QoSProfile | int) -> Any:
        """Publish on a topic."""
        publisher = VirtualPublisher(self, msg_type, self.resolve_topic_name(topic), _profile(qos))
        self.publishers.append(publisher)
        self.graph.connect(publisher)
        return publisher

    def destroy_publisher(self, publisher: VirtualPublisher) -> None:
        """Publish on a topic no more."""
        self.publishers.remove(publisher)
        self.graph.connect(publisher, appears=False)

    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[[Any], None],
        qos: QoSProfile | int,
        *,
        raw: bool = False,
    ) -> Any:
        """Subscribe to a topic."""
        name = self.resolve_topic_name(topic)
        subscription = VirtualSubscription(self, msg_type, name, callback, _profile(qos), raw)
        self.subscriptions.append(subscription)
        self.queue.append(lambda: self.graph.connect(subscription))  # once the node spins
        return subscription

    def add_waitable(self, handler: MatchedHandler) -> None:
        """Handle the events of a subscription."""
        handler.subscription.handlers.append(handler)

    def create_service(self, kind: Any, name: str, handle: Callable[[Any, Any], Any]) -> None:
        """Serve a service."""
        self.services[self.resolve_topic_name(name)] = kind, handle

    def create_timer(
        self,
        period: float,
        callback: Callable[[], None],
        clock: Any = None,
        autostart: bool = True,
    ) -> Timer:
        """Create a timer, on the steady clock or on that of the node."""
        shown = clock.shown if isinstance(clock, RosClock) else self.graph.clock
        timer = Timer(shown, callback, round(period * SECOND))
        self.timers.append(timer)
        if autostart:
            timer.reset()
        return timer

    # The graph

    def count_publishers(self, topic: str) -> int:
        """Return how many publishers a topic has."""
        return len(self.graph.publishers(topic, self))

    def count_subscribers(self, topic: str) -> int:
        """Return how many subscriptions a topic has."""
        return len(self.graph.subscriptions(topic))

    def get_publishers_info_by_topic(self, topic: str) -> list[Any]:
        """Return the publishers of a topic."""
        return _infos(self.graph.publishers(topic, self))

    def get_subscriptions_info_by_topic(self, topic: str) -> list[Any]:
        """Return the subscriptions of a topic."""
        return _infos(self.graph.subscriptions(topic))


def _profile(qos: QoSProfile | int) -> QoSProfile:
    return qos if isinstance(qos, QoSProfile) else QoSProfile(depth=qos)


def _infos(ends: Sequence[VirtualPublisher] | Sequence[VirtualSubscription]) -> list[Any]:
    return [
        SimpleNamespace(
            node_name=end.node.get_name(),
            node_namespace="/",
            topic_type=f"{end.msg_type.__module__.split('.')[0]}/msg/{end.msg_type.__name__}",
            qos_profile=end.qos_profile,
        )
        for end in ends
    ]
