"""Runs the process that brings managed nodes up and down beside them."""

from __future__ import annotations

from collections.abc import Sequence
import json
import selectors

from .assistant import Assistant, lacks
from .bring_up import bring_up
from .node import Node, Row, starts_later
from .process import Process, State
from .supervisor import Supervisor

LABEL = 'bring-up'  # which no node can be called
NEEDED = ('rclpy', 'lifecycle_msgs')


class BringUp(Assistant):
    """The process that brings managed nodes up: it is told of them through its standard input."""

    def __init__(
        self, nodes: Sequence[Node], patience: float, keep_going: bool, later: set[str]
    ) -> None:
        """Set the command, without starting it, given the names of nodes that start later."""
        rows = [
            {
                'name': node.full_name,
                'timeout': node.autostart,
                'needed': not (node.optional or keep_going),
                'later': (node.container or node.full_name) in later,
            }
            for node in nodes
        ]
        super().__init__(LABEL, bring_up, [json.dumps(rows), str(patience)])


def managed(row: Row) -> Node | None:
    """Return the node that a row is to be brought to active as; None: it is none such."""
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
        rows: Sequence[Row] = (),
    ) -> None:
        """Prepare to run the processes, and another one if some of the nodes are managed."""
        nodes = [node for node in map(managed, rows) if node is not None]
        later = {row.full_name for row in rows if starts_later(row)}
        self._bring_up = BringUp(nodes, patience, keep_going, later) if nodes else None
        self._active: set[str] = set()  # names of nodes that have been active since their start
        everything = [*processes] if self._bring_up is None else [self._bring_up, *processes]
        super().__init__(system, everything, environment, patience, keep_going, rows)

    def run(self) -> int:
        """Do so, unless something is missing that is needed to bring nodes up: then return 2."""
        if self._bring_up is None:
            return super().run()
        purpose = 'Managed nodes are to be brought up'
        advice = "Source the setup file of ROS 2, or leave 'autostart' out."
        if lacks(NEEDED, purpose, advice, self._environment):
            return 2
        with self._bring_up.talk as talk:
            self._selector.register(talk, selectors.EVENT_READ, self._hear)
            return super().run()

    def _hear(self) -> None:
        assert self._bring_up is not None
        said, more = self._bring_up.hear()
        if not more:
            self._selector.unregister(self._bring_up.talk)
        self._active.update(name for what, name in said if what == 'active')
        for name in (name for what, name in said if what == 'failed'):
            self._never_active(name)

    def _start(self, process: Process) -> None:
        self._active.discard(process.node.full_name)
        super()._start(process)
        node = managed(process.node)
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
        node = managed(process.node)
        if node is not None:
            again = process.state is State.WAITING
            self._bring_up.tell('ended' if again else 'gone', node)
        self._finish_alone()

    def _finish_alone(self) -> None:
        """Let the processes beside the nodes end, if there is no other one left."""
        assistants = [each for each in self._processes if isinstance(each, Assistant)]
        others = (each for each in self._processes if not isinstance(each, Assistant))
        if all(each.state is State.ENDED for each in others):
            for each in assistants:
                each.finish()

    def _goes_on_without(self, process: Process) -> bool:
        """Return whether the failure of a process is no reason to stop the others."""
        node = managed(process.node)
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
