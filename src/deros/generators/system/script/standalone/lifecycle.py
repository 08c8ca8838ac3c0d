"""Runs the process that brings managed nodes up and down beside them."""

from __future__ import annotations

from collections.abc import Sequence
import contextlib
import json
from pathlib import Path
import selectors
import socket
import subprocess
import sys

from .bring_up import bring_up
from .guard import Guard
from .node import Node
from .process import Process, State
from .programs import QUIET_START
from .supervisor import Supervisor

LABEL = 'bring-up'  # which no node can be called
NEEDED = ('rclpy', 'lifecycle_msgs')

# The file that holds bring_up() is the script itself, whose nodes are not started by that.
BRING_UP = (
    f"{QUIET_START}import runpy; sys.exit(runpy.run_path(sys.argv[1])['bring_up'](*sys.argv[2:]))"
)
MISSING = (
    'import importlib.util, sys; '
    'print(*(name for name in sys.argv[1:] if importlib.util.find_spec(name) is None))'
)


class BringUp(Process):
    """The process that brings managed nodes up: it is told of them through its standard input."""

    def __init__(self, nodes: Sequence[Node], patience: float, keep_going: bool) -> None:
        """Set the command, without starting it."""
        rows = [
            {
                'name': node.full_name,
                'timeout': node.autostart,
                'needed': not (node.optional or keep_going),
            }
            for node in nodes
        ]
        file = str(Path(bring_up.__code__.co_filename).absolute())
        command = [sys.executable, '-c', BRING_UP, file, json.dumps(rows), str(patience)]
        super().__init__(Node(LABEL, '/', '', ''), LABEL, command)
        self.talk, self._its_end = socket.socketpair()
        self.talk.setblocking(False)
        self.standard_input = self._its_end.fileno()

    def start(self, environment: dict[str, str], guard: Guard) -> int:
        """Start it as any process; its end of what we talk through is its own."""
        try:
            return super().start(environment, guard)
        finally:
            self._its_end.close()

    def tell(self, what: str, node: Node) -> None:
        """Tell it that a node has started, has ended, or is gone for good."""
        with contextlib.suppress(OSError):  # it has ended itself
            self.talk.sendall(f'{what} {node.full_name}\n'.encode())

    def finish(self) -> None:
        """Tell it that there is nothing more to tell."""
        with contextlib.suppress(OSError):
            self.talk.shutdown(socket.SHUT_WR)


def _managed(process: Process) -> Node | None:
    """Return the node that a process is to be brought to active as; None: it is none such."""
    row = process.node
    return row if isinstance(row, Node) and row.autostart is not None else None


class ManagingSupervisor(Supervisor):
    """Has managed nodes brought up when they are started, and down before any node is stopped."""

    def __init__(
        self,
        system: str,
        processes: Sequence[Process],
        environment: dict[str, str],
        patience: float = 5.0,
        keep_going: bool = False,
    ) -> None:
        """Prepare to run the processes, and another one if some of their nodes are managed."""
        managed = [node for node in map(_managed, processes) if node is not None]
        self._bring_up = BringUp(managed, patience, keep_going) if managed else None
        self._active: set[str] = set()  # names of nodes that have been active since their start
        self._heard = b''
        everything = [*processes] if self._bring_up is None else [self._bring_up, *processes]
        super().__init__(system, everything, environment, patience, keep_going)

    def run(self) -> int:
        """Do so, unless something is missing that is needed to bring nodes up: then return 2."""
        if self._bring_up is None:
            return super().run()
        missing = self._missing()
        if missing:
            print(
                f'Managed nodes are to be brought up, and {sys.executable} has no '
                f'{" and no ".join(missing)}, so nothing was started.\n'
                "Source the setup file of ROS 2, or leave 'autostart' out.",
                file=sys.stderr,
            )
            return 2
        with self._bring_up.talk as talk:
            self._selector.register(talk, selectors.EVENT_READ, self._hear)
            return super().run()

    def _missing(self) -> list[str]:
        command = [sys.executable, '-c', MISSING, *NEEDED]
        found = subprocess.run(command, capture_output=True, text=True, env=self._environment)
        return found.stdout.split() if found.returncode == 0 else list(NEEDED)

    def _hear(self) -> None:
        assert self._bring_up is not None
        try:
            data = self._bring_up.talk.recv(4096)
        except BlockingIOError:
            return
        except OSError:
            data = b''
        if not data:
            self._selector.unregister(self._bring_up.talk)
        *lines, self._heard = (self._heard + data).split(b'\n')
        self._active.update(line.decode().partition(' ')[2] for line in lines)

    def _start(self, process: Process) -> None:
        self._active.discard(process.node.full_name)
        super()._start(process)
        node = _managed(process)
        if self._bring_up is not None and node is not None:
            self._bring_up.tell('started' if process.group else 'gone', node)
            self._finish_alone()

    def _ended(self, process: Process) -> None:
        super()._ended(process)
        if self._bring_up is None:
            return
        if process is self._bring_up:
            if self._stopping:
                super()._stop_all()
            return
        node = _managed(process)
        if node is not None:
            again = process.state is State.WAITING
            self._bring_up.tell('ended' if again else 'gone', node)
        self._finish_alone()

    def _finish_alone(self) -> None:
        """Let the process end that brings nodes up, if there is none left."""
        assert self._bring_up is not None
        others = (each for each in self._processes if each is not self._bring_up)
        if all(each.state is State.ENDED for each in others):
            self._bring_up.finish()

    def _goes_on_without(self, process: Process) -> bool:
        """Return whether the failure of a process is no reason to stop the others."""
        node = _managed(process)
        can_lack = node is not None and node.optional and node.full_name not in self._active
        return super()._goes_on_without(process) or can_lack

    def _stop_all(self) -> None:
        """Have the managed nodes brought down, before they and all others are told to stop."""
        if self._bring_up is None or self._bring_up.state is not State.RUNNING:
            super()._stop_all()
            return
        for process in self._processes:
            if process.state is State.WAITING:
                process.state, process.due = State.ENDED, None
        self._stop_process(self._bring_up)
