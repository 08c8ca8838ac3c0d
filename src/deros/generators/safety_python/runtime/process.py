"""The program around a node that must not be late: one thread, which waits for nothing else."""

from __future__ import annotations

from collections.abc import Callable
import contextlib
import gc
import signal

import rclpy
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.utilities import ok, try_shutdown

from .machine import sharpen_timers

WAIT = 1.0  # seconds; a wait without a limit is not woken by events in every release


def run(node_class: Callable[[], Node], args: list[str] | None = None) -> None:
    """
    Run the node until SIGINT or SIGTERM, and end without an error then.

    All callbacks run in the calling thread. An exception of one of them ends the program: a node
    that does not watch any more must not go on saying that it does.
    """
    sharpen_timers()  # before any thread of the middleware starts, so that it inherits them
    try:
        rclpy.init(args=args)
        try:
            _spin(node_class)
        except Exception:
            if ok():
                raise
            # Otherwise the signal came in the middle of something that needs ROS 2.
    except KeyboardInterrupt:
        pass
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # told twice, by terminal and launcher
        with contextlib.suppress(RuntimeError):  # the signal may do it at this very moment
            try_shutdown()


def _spin(node_class: Callable[[], Node]) -> None:
    node = node_class()
    executor = EventsExecutor()
    executor.add_node(node)
    # What is there now stays for good: no later collection has to look through it.
    gc.collect()
    gc.freeze()
    while ok():
        executor.spin_once(timeout_sec=WAIT)
