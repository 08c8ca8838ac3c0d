"""A node that looks at a running graph, in the domain that the environment names.

rclpy is imported only when an observer starts: everything else of deros works without ROS 2.
"""

from __future__ import annotations

import itertools
import os
import time
from collections.abc import Callable
from types import TracebackType
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from deros.live.graph_events import GraphEvents

Result = TypeVar("Result")

TURN_S = 0.02
"""Seconds to wait for messages before a condition is looked at again.

Changes of the graph do not end the wait: a process that starts makes some hundred of them.
"""

SETTLED_S = 3.0
"""Seconds without a change after which the graph counts as discovered.

Processes whose first announcements were lost announce themselves again after that time.
"""


class RosUnavailableError(Exception):
    """ROS 2 cannot be used from this environment; the text says what to do."""


class Observer:
    """A hidden node of its own context, which spins only while it waits.

    Attributes:
        node: the node of rclpy.
    """

    def __init__(self, domain: int | None = None) -> None:
        """Start the node.

        Args:
            domain: of DDS; ``None`` for the one that the environment names.

        Raises:
            RosUnavailableError: if rclpy or a middleware is missing, or does not start.
        """
        try:
            import rclpy
            from rclpy.context import Context
            from rclpy.executors import SingleThreadedExecutor
            from rclpy.node import Node
        except ImportError as error:
            raise RosUnavailableError(
                f"rclpy, the Python library of ROS 2, cannot be imported ({error}): source the "
                "setup file of ROS 2, or install it with pip install 'deros[ros]'"
            ) from error
        self._context = Context()
        try:
            # Words of our command line, such as NAME:=VALUE, are not meant for rcl.
            rclpy.init(args=[], context=self._context, domain_id=domain)
            self.node: Any = Node(
                f"_deros_{os.getpid()}",
                context=self._context,
                use_global_arguments=False,
                enable_rosout=False,
                start_parameter_services=False,
            )
        except Exception as error:  # each middleware has errors of its own
            self._context.try_shutdown()
            raise RosUnavailableError(f"ROS 2 does not start: {error}") from error
        self._executor = SingleThreadedExecutor(context=self._context)
        self._graph_events = self._events_of_graph()
        self._looks = itertools.count()
        self._executor.add_node(self.node)

    def _events_of_graph(self) -> GraphEvents | None:
        """Return what counts the changes of the graph; ``None`` if rcl cannot be called."""
        from deros.live.graph_events import GraphEvents, GraphEventsMissingError

        try:
            return GraphEvents(self.node)
        except GraphEventsMissingError:
            return None

    def __enter__(self) -> Observer:
        """Return the observer, which leaves the graph when the block ends."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Leave the graph."""
        self._graph_events = None
        self._executor.remove_node(self.node)
        self.node.destroy_node()
        self._executor.shutdown()
        self._context.try_shutdown()

    @property
    def graph_version(self) -> int:
        """A number that is another one whenever the graph may have changed since.

        It has to be read before the graph is.
        """
        events = self._graph_events
        return next(self._looks) if events is None else events.count()

    def until(self, condition: Callable[[], Result], deadline: float) -> Result:
        """Spin until a condition is true or the deadline has passed; return its last result.

        Args:
            condition: called after each message, and at least every 20 ms.
            deadline: a time of :func:`time.monotonic`.
        """
        while not (result := condition()):
            left = deadline - time.monotonic()
            if left <= 0:
                break
            self._executor.spin_once(timeout_sec=min(TURN_S, left))
        return result

    def wait(self, seconds: float) -> None:
        """Spin for a time, and wake for messages alone."""
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0:
            self._executor.spin_once(timeout_sec=left)

    def settled(self, look: Callable[[], Result], deadline: float) -> Result:
        """Spin until ``look`` has returned the same for a while, and not nothing; return it."""
        seen, since = look(), time.monotonic()

        def is_settled() -> bool:
            nonlocal seen, since
            now = time.monotonic()
            if (current := look()) != seen:
                seen, since = current, now
            return bool(seen) and now - since >= SETTLED_S

        self.until(is_settled, deadline)
        return seen


def printable(text: str) -> str:
    """Return a text of another process without characters that would control the terminal."""
    return "".join(each if each.isprintable() else "?" for each in text)
