"""Watches the ROS graph for what programs wait for: a process of its own, which needs rclpy."""

from __future__ import annotations

from collections.abc import Sequence
import contextlib
from dataclasses import dataclass
import json
import os
import signal
import socket
import time
from typing import Any

LOOK_PERIOD = 0.05  # seconds; rclpy reports no event when something appears in the graph
ANSWER_PERIOD = 0.5  # seconds after which a node is asked for its state again


@dataclass
class Wait:
    """What one program waits for."""

    program: str
    kind: str  # node, active, service or topic
    name: str
    timeout: float  # seconds, from the moment at which the script says that it begins
    end: float | None = None  # monotonic time; None: it has not begun
    client: Any = None
    answer: Any = None
    asked: float = 0.0  # monotonic time


class GraphWatcher:
    """Looks again and again whether what programs wait for is there, and tells the script."""

    def __init__(self, waits: Sequence[Wait], script: socket.socket) -> None:
        """
        Watch for these.

        The script sends a line when a wait begins, and when it is of no use any more. The end of
        file says that there is nothing left to wait for.
        """
        self._waits = {wait.program: wait for wait in waits}
        self._script = script
        self._script.setblocking(False)
        self._received = b''
        self._stop = False
        # In this order: a program that handles SIGINT alone is taken to be importing.
        signal.signal(signal.SIGTERM, lambda *_: os._exit(128 + signal.SIGTERM))
        signal.signal(signal.SIGINT, self._on_stop)

    def _on_stop(self, *_: object) -> None:
        self._stop = True

    def run(self) -> int:
        """Watch until nothing is waited for any more; return 0."""
        import rclpy
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.signals import SignalHandlerOptions

        rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
        self._node = rclpy.create_node(
            f'_graph_watch_{os.getpid()}', start_parameter_services=False
        )
        executor = SingleThreadedExecutor()
        executor.add_node(self._node)
        try:
            while self._waits and not self._stop:
                self._listen()
                self._look()
                executor.spin_once(timeout_sec=LOOK_PERIOD)
        finally:
            executor.shutdown()
            rclpy.shutdown()
        return 0

    def _listen(self) -> None:
        try:
            data = self._script.recv(4096)
        except BlockingIOError:
            return
        except OSError:
            data = b''
        self._stop |= not data
        *lines, self._received = (self._received + data).split(b'\n')
        for line in lines:
            what, _, program = line.decode().partition(' ')
            if what == 'begin' and program in self._waits:
                wait = self._waits[program]
                wait.end = time.monotonic() + wait.timeout
            elif what == 'drop':
                self._waits.pop(program, None)

    def _look(self) -> None:
        begun = [wait for wait in self._waits.values() if wait.end is not None]
        names: set[str] = set()
        if any(wait.kind == 'node' for wait in begun):
            found = self._node.get_node_names_and_namespaces()
            names = {f'{space.rstrip("/")}/{name}' for name, space in found}
        for wait in begun:
            assert wait.end is not None
            # In this order: what comes in the last moment is there.
            if self._is_there(wait, names):
                self._done('ready', wait)
            elif time.monotonic() >= wait.end:
                self._done('late', wait)

    def _is_there(self, wait: Wait, names: set[str]) -> bool:
        if wait.kind == 'node':
            return wait.name in names
        if wait.kind == 'service':
            return bool(self._node.count_services(wait.name) > 0)
        if wait.kind == 'topic':
            return bool(self._node.count_publishers(wait.name) > 0)
        return self._is_active(wait)

    def _is_active(self, wait: Wait) -> bool:
        """Return whether the last answer was that a node is active; ask it, if it is time."""
        from lifecycle_msgs.msg import State
        from lifecycle_msgs.srv import GetState

        if wait.client is None:
            wait.client = self._node.create_client(GetState, f'{wait.name}/get_state')
        now = time.monotonic()
        if wait.answer is None:
            if wait.client.service_is_ready():
                wait.answer, wait.asked = wait.client.call_async(GetState.Request()), now
            return False
        if wait.answer.done():
            state = wait.answer.result().current_state.id
            wait.answer = None
            return bool(state == State.PRIMARY_STATE_ACTIVE)
        if now - wait.asked > ANSWER_PERIOD:
            # The service may still be that of a process that has been killed.
            wait.client.remove_pending_request(wait.answer)
            wait.answer = None
        return False

    def _done(self, what: str, wait: Wait) -> None:
        del self._waits[wait.program]
        if wait.client is not None:
            self._node.destroy_client(wait.client)
        with contextlib.suppress(OSError):  # the script has been killed
            self._script.sendall(f'{what} {wait.program}\n'.encode())


def watch_graph(waits: str) -> int:
    """Watch for the waits of a JSON text, told of them by the script at our standard input."""
    with socket.socket(fileno=os.dup(0)) as script:
        return GraphWatcher([Wait(**each) for each in json.loads(waits)], script).run()
