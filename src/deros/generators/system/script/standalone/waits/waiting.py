"""Starts programs when what they wait for is in the ROS graph."""

from __future__ import annotations

from collections.abc import Sequence
import json
import selectors
import time
from typing import cast

from ..assistant import Assistant, lacks
from ..node import Node, nodes_of, Ready, Row
from ..process import Process, State
from ..supervisor import Supervisor
from .graph import watch_graph

WATCHER = 'graph-watch'  # the label of the process, which no node can have


class GraphWatch(Assistant):
    """The process that watches the graph: it is told when a wait begins, and when it is over."""

    def __init__(self, rows: Sequence[tuple[Row, Ready]]) -> None:
        """Set the command, without starting it."""
        waits = [
            {
                'program': row.full_name,
                'kind': ready.kind,
                'name': ready.name,
                'timeout': ready.timeout,
            }
            for row, ready in rows
        ]
        super().__init__(WATCHER, watch_graph, [json.dumps(waits)])


def awaited_in_graph(row: Row) -> Ready | None:
    """Return what a row waits for in the graph; None without that, or if it is left out."""
    return None if row.ready is None or row.ready.left_out else row.ready


class GraphWaits(Supervisor):
    """Has the graph watched, and programs started when what they wait for is there."""

    def __init__(
        self,
        system: str,
        processes: Sequence[Process],
        environment: dict[str, str],
        patience: float = 5.0,
        keep_going: bool = False,
        rows: Sequence[Row] = (),
    ) -> None:
        """Prepare to run the processes, and another one if some of them wait."""
        self._rows = rows
        self._waits = {
            process.node.full_name: (process, ready)
            for process in processes
            if (ready := awaited_in_graph(process.node)) is not None
        }
        self._begun: set[str] = set()
        found = [(process.node, ready) for process, ready in self._waits.values()]
        self._watch = GraphWatch(found) if found else None
        everything = [*processes] if self._watch is None else [self._watch, *processes]
        super().__init__(system, everything, environment, patience, keep_going, rows)

    def run(self) -> int:
        """Do so, unless something is missing that is needed to watch: then return 2."""
        if self._watch is None:
            return super().run()
        needed = ['rclpy']
        if any(ready.kind == 'active' for _, ready in self._waits.values()):
            needed.append('lifecycle_msgs')
        purpose = 'Programs wait for what is in the ROS graph'
        advice = "Source the setup file of ROS 2, or leave 'after' out."
        if lacks(needed, purpose, advice, self._environment):
            return 2
        with self._watch.talk as talk:
            self._selector.register(talk, selectors.EVENT_READ, self._hear_of_graph)
            return super().run()

    def _plan(self) -> None:
        super()._plan()
        for process in self._processes:
            ready = process.node.ready
            if ready is not None and ready.left_out:
                self._say(f'{process.label} does not wait for {ready}, which is left out')
        for process, _ in self._waits.values():
            process.due = None
        for process, ready in self._waits.values():
            owner = self._owner(ready)
            if owner is None or (owner.due is not None and not owner.node.delay):
                self._begin(process)

    def _begin(self, process: Process) -> None:
        """Let the time begin in which what a program waits for has to appear."""
        name = process.node.full_name
        if self._watch is not None and name in self._waits and name not in self._begun:
            self._begun.add(name)
            self._watch.tell('begin', process.node)

    def _owner(self, ready: Ready) -> Process | None:
        """Return the process of an awaited node; None if we do not start it."""
        if ready.kind not in ('node', 'active'):
            return None
        row = next((each for each in self._rows if ready.name in nodes_of(each)), None)
        if isinstance(row, Node) and row.container:
            row = next((each for each in self._rows if each.full_name == row.container), None)
        return next((each for each in self._processes if each.node is row), None)

    def _waiting_on(self, owner: Process) -> list[Process]:
        waits = self._waits.values()
        return [process for process, ready in waits if self._owner(ready) is owner]

    def _hear_of_graph(self) -> None:
        assert self._watch is not None
        said, more = self._watch.hear()
        if not more:
            self._selector.unregister(self._watch.talk)
        for what, name in said:
            process, ready = self._waits.get(name, (None, None))
            if process is None or ready is None:
                continue
            if what == 'late':
                self._give_up(process, f'it is not there within {ready.timeout:g} s')
                continue
            del self._waits[name]
            if process.state is State.WAITING:
                process.due = time.monotonic() + process.node.delay

    def _give_up(self, process: Process, reason: str) -> None:
        _, ready = self._waits.pop(process.node.full_name)
        if self._watch is not None:
            self._watch.tell('drop', process.node)
        if process.state is State.WAITING:
            self._say(f'{process.label} is not started: it waits for {ready}, and {reason}')
            self._failure(process)

    def _give_up_on(self, owner: Process) -> None:
        """Wait no longer for the nodes of a process that has ended for good."""
        waiting = [] if self._watch is None else self._waiting_on(owner)
        if waiting:
            self._hear_of_graph()  # it may have been there before
        for process in waiting:
            if process.node.full_name in self._waits:
                self._give_up(process, f'{owner.label} is not running any more')

    def _never_active(self, name: str) -> None:
        super()._never_active(name)
        for process, ready in [*self._waits.values()]:
            if ready.kind == 'active' and ready.name == name:
                self._give_up(process, 'it could not be brought to active')

    def _start(self, process: Process) -> None:
        super()._start(process)
        if process.group:
            for each in self._waiting_on(process):
                self._begin(each)

    def _failure(self, process: Process, is_awaited: bool = False) -> None:
        super()._failure(process, is_awaited)
        self._give_up_on(process)

    def _ended(self, process: Process) -> None:
        super()._ended(process)
        if process is self._watch:
            for each, _ in [*self._waits.values()]:
                self._give_up(each, 'the graph is not watched any more')
        elif process.state is State.ENDED:
            self._give_up_on(process)


def waiting(base: type[Supervisor]) -> type[Supervisor]:
    """Return a kind of supervisor that waits for what is in the graph, too."""
    return cast('type[Supervisor]', type('WaitingSupervisor', (GraphWaits, base), {}))
