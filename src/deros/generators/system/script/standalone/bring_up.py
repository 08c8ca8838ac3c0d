"""Brings managed nodes to active and back: a process of its own, which needs rclpy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
import contextlib
from dataclasses import dataclass
import json
import os
import select
import signal
import socket
import time
from typing import Any

GRAPH_PERIOD = 0.05  # seconds; rclpy reports no event when a service appears
PROBE_PERIOD = 0.5  # seconds after which a question that is not answered is put again
RESERVE = 0.9  # the part of the time to stop in which nodes are brought down


class NotDoneError(Exception):
    """Why a node does not come to the state that it is to be in."""


class ToldError(Exception):
    """The script has told that the node in question has ended, or that all is to be stopped."""


@dataclass
class ManagedNode:
    """One node to bring up, and what is known about it."""

    name: str
    timeout: float  # seconds, for each transition
    needed: bool  # all is stopped when it does not become active
    later: bool = False  # the others do not wait for its first start
    running: bool = False
    changes: int = 0  # how often it has started or ended
    gone: bool = False  # for good
    pending: bool = True  # it is still, or again, to be brought up
    active: bool = False
    touched: bool = False  # it has left the state in which nodes are started
    change_state: Any = None
    get_state: Any = None


class Manager:
    """Brings nodes up in order, and down in reverse order when it is told to."""

    _own_name = '_bring_up'
    _what_is_done = 'managed nodes are active'
    _what_fails = 'is not active'

    def __init__(
        self, nodes: Sequence[ManagedNode], patience: float, script: socket.socket
    ) -> None:
        """
        Manage the nodes in the given order.

        The patience is the time in seconds in which all have to be brought down. The script sends
        a line for each start and end of a node; the end of file says that no node runs any more.
        """
        self._nodes = {node.name: node for node in nodes}
        self._patience = patience
        self._script = script
        self._script.setblocking(False)
        self._received = b''
        self._stop = False
        self._going_down = False
        self._changes = 0  # of the node in question, when its turn began
        self._failed = False
        self._complete = False
        self._signals, signalled = os.pipe()
        for end in (self._signals, signalled):
            os.set_blocking(end, False)
        signal.set_wakeup_fd(signalled, warn_on_full_buffer=False)
        # In this order: a program that handles SIGINT alone is taken to be importing.
        signal.signal(signal.SIGTERM, lambda *_: os._exit(128 + signal.SIGTERM))
        signal.signal(signal.SIGINT, self._on_stop)

    def run(self) -> int:
        """Bring the nodes up, wait, bring them down; return 1 if one could not be brought up."""
        import rclpy
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.signals import SignalHandlerOptions

        rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
        node = rclpy.create_node(f'{self._own_name}_{os.getpid()}', start_parameter_services=False)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(node)
        self._make_clients(node)
        try:
            while self._go_on():
                pass
            self._bring_all_down()
        finally:
            self._executor.shutdown()
            rclpy.shutdown()
        return 1 if self._failed else 0

    def _make_clients(self, node: Any) -> None:
        from lifecycle_msgs.msg import State, Transition
        from lifecycle_msgs.srv import ChangeState, GetState

        self._change, self._get = ChangeState.Request, GetState.Request
        self._unconfigured = State.PRIMARY_STATE_UNCONFIGURED
        self._inactive = State.PRIMARY_STATE_INACTIVE
        self._active = State.PRIMARY_STATE_ACTIVE
        up = Transition
        self._upward = {
            self._unconfigured: (up.TRANSITION_CONFIGURE, 'configure', 'configured'),
            self._inactive: (up.TRANSITION_ACTIVATE, 'activate', 'activated'),
        }
        self._downward = {
            self._active: (up.TRANSITION_DEACTIVATE, 'deactivate', 'deactivated'),
            self._inactive: (up.TRANSITION_CLEANUP, 'clean up', 'cleaned up'),
            self._unconfigured: (up.TRANSITION_UNCONFIGURED_SHUTDOWN, 'shut down', 'shut down'),
        }
        for each in self._nodes.values():
            # In this order: who answers get_state has found our end of change_state before.
            each.change_state = node.create_client(ChangeState, f'{each.name}/change_state')
            each.get_state = node.create_client(GetState, f'{each.name}/get_state')

    # What the script and the system tell ----------------------------------------------------

    def _on_stop(self, *_: object) -> None:
        self._stop = True

    def _listen(self, timeout: float | None = 0.0) -> None:
        """Take what the script has sent; wait for it, or for a signal, so many seconds."""
        script = self._script.fileno()
        readable, _, _ = select.select([script, self._signals], [], [], timeout)
        if self._signals in readable:
            os.read(self._signals, 4096)
        if script not in readable:
            return
        try:
            data = self._script.recv(4096)
        except OSError:
            data = b''
        self._stop |= not data
        *lines, self._received = (self._received + data).split(b'\n')
        for line in lines:
            what, name = line.decode().split(' ', 1)
            node = self._nodes[name]
            node.changes += 1
            node.running = what == 'started'
            node.gone = what == 'gone'
            node.touched = node.active = False
            node.pending = not node.gone or node.pending
            self._complete &= not node.pending

    def _tell(self, what: str, name: str) -> None:
        """Tell the script what has become of a node."""
        with contextlib.suppress(OSError):  # the script has been killed
            self._script.sendall(f'{what} {name}\n'.encode())

    def _await(self, done: Callable[[], bool], timeout: float, node: ManagedNode) -> bool:
        """
        Return whether something of a node comes true within so many seconds.

        Raises ToldError when there is no use in waiting for it any longer.
        """
        end = time.monotonic() + timeout
        while not done():
            self._listen()
            if node.changes != self._changes or (self._stop and not self._going_down):
                raise ToldError
            left = min(GRAPH_PERIOD, end - time.monotonic())
            if left <= 0:
                return False
            self._executor.spin_once(timeout_sec=left)
        return True

    # Services of a node ---------------------------------------------------------------------

    def _ask(self, client: Any, request: Any, timeout: float, node: ManagedNode) -> Any:
        """Return the answer of a service, or None if there is none in so many seconds."""
        if not client.service_is_ready():
            return None
        future = client.call_async(request)
        try:
            answered = self._await(future.done, timeout, node)
        finally:
            client.remove_pending_request(future)
        return future.result() if answered else None

    def _state_of(self, node: ManagedNode, timeout: float) -> tuple[int, str] | None:
        """
        Return the state of a node and its name, or None without an answer in so many seconds.

        It is asked again and again: a service that is in the graph may not have found us yet, or
        belong to a process that has been killed.
        """
        end = time.monotonic() + timeout
        while (left := end - time.monotonic()) > 0:
            if not self._await(node.get_state.service_is_ready, left, node):
                return None
            left = min(PROBE_PERIOD, max(0.0, end - time.monotonic()))
            answer = self._ask(node.get_state, self._get(), left, node)
            if answer is not None:
                return answer.current_state.id, answer.current_state.label
        return None

    def _request(self, transition: int) -> Any:
        request = self._change()
        request.transition.id = transition
        return request

    # Up -------------------------------------------------------------------------------------

    def _go_on(self) -> bool:
        """Bring up the next node, or wait for something to do; return False at the end."""
        self._listen()
        if self._stop:
            return False
        begun = (each for each in self._nodes.values() if each.changes or not each.later)
        node = next((each for each in begun if each.pending), None)
        if node is None:
            if not self._complete:
                self._complete = True
                active = sum(each.active for each in self._nodes.values())
                print(f'{active} of {len(self._nodes)} {self._what_is_done}', flush=True)
            self._listen(None)
            return True
        try:
            self._bring_up(node)
        except NotDoneError as reason:
            node.pending = False
            self._failed = True
            print(f'{node.name} {self._what_fails}: {reason}', flush=True)
            self._tell('failed', node.name)
            return not node.needed
        except ToldError:
            pass
        return True

    def _bring_up(self, node: ManagedNode) -> None:
        if node.gone:
            raise NotDoneError('it has ended')
        while not (node.running or node.gone or self._stop):
            self._listen(None)  # until it is started, perhaps again
        if not node.running:
            return
        self._changes = node.changes
        self._complete_node(node)
        node.pending, node.active, node.touched = False, True, True
        self._tell('active', node.name)

    def _complete_node(self, node: ManagedNode) -> None:
        name, timeout = node.name, node.timeout
        if not self._await(node.change_state.service_is_ready, timeout, node):
            raise NotDoneError(f'no service {name}/change_state within {timeout:g} s')
        while True:
            state = self._state_of(node, timeout)
            if state is None:
                raise NotDoneError(f'no answer from {name}/get_state within {timeout:g} s')
            number, label = state
            if number == self._active:
                break
            if number not in self._upward:
                raise NotDoneError(f'it is {label}')
            transition, verb, done = self._upward[number]
            node.touched = True
            answer = self._ask(node.change_state, self._request(transition), timeout, node)
            if answer is None:
                raise NotDoneError(f'it does not {verb} within {timeout:g} s')
            if not answer.success:
                raise NotDoneError(f'it does not {verb}: the transition has failed')
            print(f'{name} {done}', flush=True)

    # Down -----------------------------------------------------------------------------------

    def _bring_all_down(self) -> None:
        """Bring down what has been brought up, in reverse order, each in its share of the time."""
        self._going_down = True
        end = time.monotonic() + RESERVE * self._patience
        nodes = [each for each in reversed(self._nodes.values()) if each.touched]
        for number, node in enumerate(nodes):
            share = max(0.0, end - time.monotonic()) / (len(nodes) - number)
            try:
                self._bring_down(node, time.monotonic() + share)
            except ToldError:
                continue  # it has ended meanwhile
            except NotDoneError as reason:
                self._failed = True
                print(f'{node.name} is not shut down: {reason}', flush=True)

    def _bring_down(self, node: ManagedNode, end: float) -> None:
        def left() -> float:
            return min(node.timeout, max(0.0, end - time.monotonic()))

        self._listen()
        self._changes = node.changes
        while node.running:
            state = self._state_of(node, left())
            if state is None:
                raise NotDoneError('it does not answer')
            if state[0] not in self._downward:
                return
            transition, verb, done = self._downward[state[0]]
            answer = self._ask(node.change_state, self._request(transition), left(), node)
            if answer is None or not answer.success:
                raise NotDoneError(f'it does not {verb}')
            print(f'{node.name} {done}', flush=True)


def bring_up(nodes: str, patience: str) -> int:
    """Manage the nodes of a JSON text, told by the script at our standard input."""
    with socket.socket(fileno=os.dup(0)) as script:
        managed = [ManagedNode(**each) for each in json.loads(nodes)]
        return Manager(managed, float(patience), script).run()
