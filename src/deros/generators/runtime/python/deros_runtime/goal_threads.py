"""Executes the goals of a node's actions in threads."""

from __future__ import annotations

import atexit
from collections.abc import Callable
import contextlib
import os
import sys
import threading
import time
from typing import Any

from rclpy.action.server import ActionServer, GoalResponse, ServerGoalHandle
from rclpy.exceptions import InvalidHandle
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.utilities import ok

PATIENCE = 1.0  # seconds that the end of a node waits for its goals
LAST_MESSAGES = 0.05  # seconds in which the results of the last goals are sent


class GoalThreads:
    """
    Executes each goal in a thread of its own: no goal delays messages, cancels or parameters.

    When the node ends, its goals are aborted: their code sees that they are not active any more,
    and returns.
    """

    def __init__(self, node: Node, max_goals: Callable[[], int]) -> None:
        """Set up; max_goals returns how many goals may be in execution at the same time."""
        self._node = node
        self._max_goals = max_goals
        self._changed = threading.Condition()
        self._running: dict[threading.Thread, Any] = {}
        self._ends = False

    def accept(self, action: str) -> bool:
        """Return whether a goal of an action may be accepted; log why not."""
        with self._changed:
            running = len(self._running)
            if self._ends:
                return False
        limit = self._max_goals()
        if running < limit:
            return True
        self._node.get_logger().warning(
            f'goal of {action} rejected: {running} goals are in execution, max_goals is {limit}'
        )
        return False

    def start(
        self,
        goal_handle: Any,
        execute: Callable[[Any], Any],
        finish: Callable[[Callable[[Any], Any]], None],
        result_type: Callable[[], Any],
    ) -> None:
        """
        Start to execute a goal.

        In the end, finish has the executor take the result: from a function that returns it, or
        raises what execute has raised.
        """

        def run() -> None:
            request: BaseException | None = None
            try:
                outcome = _returning(execute(goal_handle))
            except Exception as error:
                outcome = _returning(result_type()) if self._ends else _raising(error)
            except BaseException as error:  # the program is to end, and so is the goal
                request = error
                _abort(goal_handle)
                outcome = _returning(result_type())
            with contextlib.suppress(AttributeError, InvalidHandle):  # there is no executor left
                finish(outcome)
                if request and (executor := self._node.executor):
                    executor.create_task(_raising(request), None)
            self._forget(thread)

        thread = threading.Thread(target=run, name='goal', daemon=True)
        with self._changed:
            self._running[thread] = goal_handle
        try:
            thread.start()
        except RuntimeError as error:  # there are too many threads
            self._forget(thread)
            finish(_raising(error))

    def _forget(self, thread: threading.Thread) -> None:
        with self._changed:
            del self._running[thread]
            self._changed.notify_all()

    @property
    def is_busy(self) -> bool:
        """Whether a goal is in execution."""
        with self._changed:
            return bool(self._running)

    def abort(self) -> None:
        """Abort all goals, and accept no more."""
        with self._changed:
            self._ends = True
            goal_handles = list(self._running.values())
        for goal_handle in goal_handles:
            _abort(goal_handle)

    def wait(self) -> None:
        """Wait for a while until all goals have returned."""
        with self._changed:
            self._changed.wait_for(lambda: not self._running, PATIENCE)

    def end(self, executor: Executor) -> None:
        """
        Abort the goals, and spin until they have returned and their results are sent.

        If one of them does not return, the program ends in the middle of it, after all else.
        """
        waits = self.is_busy and ok()
        self.abort()
        end = time.monotonic() + PATIENCE
        while waits and self.is_busy and time.monotonic() < end:
            _spin_once(executor)
        end = time.monotonic() + LAST_MESSAGES
        while waits and time.monotonic() < end:
            _spin_once(executor)
        if self.is_busy:
            error = sys.exc_info()[1]
            code = error.code if isinstance(error, SystemExit) else error is not None
            atexit.register(_leave, code if isinstance(code, int) else bool(code))


class GoalServer(ActionServer):
    """An action server whose goals are executed in threads of their own."""

    def __init__(
        self,
        threads: GoalThreads,
        node: Node,
        action_type: Any,
        name: str,
        *,
        accept: Callable[[Any], GoalResponse],
        execute: Callable[[ServerGoalHandle], Any],
        cancel: Callable[[ServerGoalHandle], Any],
    ) -> None:
        """Open the server; the functions are those of the node's class."""

        def accept_within_limit(goal: Any) -> GoalResponse:
            return accept(goal) if threads.accept(name) else GoalResponse.REJECT

        self._threads = threads
        super().__init__(  # type: ignore[no-untyped-call]
            node,
            action_type,
            name,
            execute_callback=execute,
            goal_callback=accept_within_limit,
            cancel_callback=cancel,
        )

    def notify_execute(
        self, goal_handle: ServerGoalHandle, execute_callback: Callable[[Any], Any] | None
    ) -> None:
        """Execute a goal in a thread, not in the executor, which gets its result only."""

        def finish(result: Callable[[Any], Any]) -> None:
            super(GoalServer, self).notify_execute(  # type: ignore[no-untyped-call]
                goal_handle, result
            )

        execute = execute_callback or self._execute_callback
        self._threads.start(goal_handle, execute, finish, self.action_type.Result)


def _returning(result: Any) -> Callable[[Any], Any]:
    return lambda _: result


def _raising(error: BaseException) -> Callable[[Any], Any]:
    def throw(_: Any) -> Any:
        raise error

    return throw


def _spin_once(executor: Executor) -> None:
    with contextlib.suppress(Exception, SystemExit):  # why the node ends is known already
        executor.spin_once(timeout_sec=LAST_MESSAGES / 2)


def _abort(goal_handle: Any) -> None:
    """Close a goal; it may be closed at the same moment."""
    with contextlib.suppress(Exception):
        if goal_handle.is_active:
            goal_handle.abort()


def _leave(code: int) -> None:
    """End in the middle of a goal, which does not return: its thread would break the usual end."""
    print('ends in the middle of a goal, which does not return', file=sys.stderr)
    sys.stdout.flush()
    os._exit(code)
