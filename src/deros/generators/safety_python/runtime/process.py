"""The program around a node that must not be late: one thread, which waits for nothing else."""

from __future__ import annotations

from collections.abc import Callable
import gc
import sys
from typing import Any

import rclpy
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import ok, try_shutdown

from .instance import Refusal
from .machine import never_wait_for_readers, sharpen_timers
from .waker import StopSignals, Waker

WAIT = 1.0  # seconds; a wait without a limit is not woken by events in every release


def run(
    node_class: Callable[[], Node],
    args: list[str] | None = None,
    end: Callable[[Any], None] = lambda _: None,
) -> None:
    """
    Run the node until SIGINT or SIGTERM, call end with it, and end without an error.

    All callbacks run in the calling thread. An exception of one of them ends the program: a node
    that does not watch any more must not go on saying that it does. A Refusal ends it with its
    text and exit code 1.
    """
    never_wait_for_readers()
    sharpen_timers()  # before any thread of the middleware starts, so that it inherits them
    signals = StopSignals()
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    try:
        _spin(node_class, signals, end)
    except Refusal as refusal:
        sys.exit(str(refusal))
    finally:
        try_shutdown()


def _spin(
    node_class: Callable[[], Node], signals: StopSignals, end: Callable[[Any], None]
) -> None:
    node = node_class()
    executor = EventsExecutor()
    executor.add_node(node)
    with Waker(node):
        # What is there now stays for good: no later collection has to look through it.
        gc.collect()
        gc.freeze()
        while ok() and not signals.came:
            executor.spin_once(timeout_sec=WAIT)
        if ok():
            end(node)
