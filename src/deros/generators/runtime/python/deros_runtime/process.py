"""Runs a node that must not be late: in one thread, which waits for nothing else."""

from __future__ import annotations

from collections.abc import Callable
import contextlib
import gc
import os
import sys
import traceback
from typing import Any, NoReturn

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import ok, try_shutdown

from .instance import Refusal
from .realtime import make_output_nonblocking, minimize_timer_slack
from .waker import StopSignals, Waker

WAIT = 1.0  # seconds; a wait without a limit is not woken by events in every release


def run(
    node_class: Callable[[], Node],
    args: list[str] | None = None,
    end: Callable[[Any], None] = lambda _: None,
) -> None:
    """
    Run the node until SIGINT or SIGTERM, call end with it, and end without an error.

    All callbacks run in the calling thread. An exception of one of them, SystemExit included, ends
    the program with exit code 1: a node that no longer watches must not keep publishing that it
    does, nor look as if it had been asked to end. So does a shutdown of the context from within.
    Of a Refusal, only the text is printed.
    """
    make_output_nonblocking()
    minimize_timer_slack()  # before any thread of the middleware starts, so that it inherits them
    signals = StopSignals()
    try:
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
        _spin(node_class, signals, end)
    except Refusal as refusal:
        _fail(str(refusal))
    except SystemExit as request:
        _fail(f'{traceback.format_exc()}the node was ended by exit({request.code!r}) within it')
    except BaseException:
        _fail(traceback.format_exc())
    try_shutdown()


def _spin(
    node_class: Callable[[], Node], signals: StopSignals, end: Callable[[Any], None]
) -> None:
    node = node_class()
    try:
        _serve(node, signals)
        if ok():
            end(node)
    except BaseException:
        with contextlib.suppress(Exception):  # the cause of the end is what is reported
            node.destroy_node()  # so that others need not wait for a timeout
        raise


def _serve(node: Node, signals: StopSignals) -> None:
    """Run the callbacks of a node until a signal comes."""
    executor = EventsExecutor()
    executor.add_node(node)
    shut_down: list[bool] = []  # cheaper than to ask ok() after each event
    node.context.on_shutdown(lambda: shut_down.append(True))
    try:
        with Waker(node):
            # These objects stay for good: no later collection has to look through them.
            gc.collect()
            gc.freeze()
            with contextlib.suppress(ExternalShutdownException):
                while not (shut_down or signals.received):
                    executor.spin_once(timeout_sec=WAIT)
    finally:
        executor.shutdown()  # it holds the node, which could not be destroyed before
    if not signals.received:
        raise Refusal('the context of ROS 2 was shut down within the node, which ends now')


def _fail(reason: str) -> NoReturn:
    """End the process now, with a reason and exit code 1, whatever other threads do."""
    try_shutdown()
    with contextlib.suppress(OSError, ValueError):  # nobody reads it
        print(reason.rstrip(), file=sys.stderr, flush=True)
    with contextlib.suppress(OSError, ValueError):
        sys.stdout.flush()
    os._exit(1)  # a thread of the user's may never end
