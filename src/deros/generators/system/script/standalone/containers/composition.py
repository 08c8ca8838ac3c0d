"""Runs the process that loads nodes into containers beside them."""

from __future__ import annotations

from collections.abc import Sequence
import json
import selectors
import shlex
import sys
from typing import Any

from ..assistant import Assistant, complaint, lacks, location
from ..lifecycle import managed, ManagingSupervisor
from ..node import Node, Row, starts_later
from ..process import Process, State
from .load import load
from .values import run_with_values, unreadable

LOADER = 'loading'  # the label of the process
NEEDED_TO_LOAD = ('rclpy', 'composition_interfaces')
LONGEST_WORD = 1 << 16  # bytes of a command line in one word; Linux takes twice as many
BY_HAND = (
    'import runpy, sys; file, module, name, *rest = sys.argv[1:]; '
    'runpy.run_path(file, run_name=module)[name](*rest)'
)
CONTAINER_TIMEOUT = 10.0  # seconds in which a container offers its services


class Loading(Assistant):
    """The process that loads nodes: it is told of containers through its standard input."""

    def __init__(self, components: Sequence[Node], keep_going: bool, later: Sequence[str]) -> None:
        """Set the command, without starting it, given the containers that start later."""
        containers: dict[str, list[dict[str, Any]]] = {}
        for each in components:
            containers.setdefault(each.container, []).append(
                {
                    'name': each.full_name,
                    'package': each.package,
                    'plugin': each.plugin,
                    'remappings': [
                        f'{name}:={target}' for name, target in each.remappings.items()
                    ],
                    'parameters': dict(each.parameters),
                    'files': [*each.files],
                    'intra_process': each.intra_process,
                }
            )
        needed = '' if keep_going else 'needed'
        text = json.dumps(containers)
        pieces = [text[at:][:LONGEST_WORD] for at in range(0, len(text), LONGEST_WORD)]
        words = [str(CONTAINER_TIMEOUT), needed, json.dumps(later), *pieces]
        super().__init__(LOADER, load, words)
        self._pieces = pieces if any(each.files for each in components) else []

    def faults(self, environment: dict[str, str]) -> str:
        """Return why the parameter files of nodes cannot be read in an environment, if so."""
        return complaint(unreadable, self._pieces, environment) if self._pieces else ''


class ComposingSupervisor(ManagingSupervisor):
    """Has nodes loaded into containers whenever these are started."""

    def __init__(
        self,
        system: str,
        processes: Sequence[Process],
        environment: dict[str, str],
        patience: float = 5.0,
        keep_going: bool = False,
        rows: Sequence[Row] = (),
    ) -> None:
        """Prepare to run the processes, and another one if there are nodes to load."""
        components = [row for row in rows if isinstance(row, Node) and row.container]
        self._components = {node.full_name: node for node in components}
        later = [row.full_name for row in rows if starts_later(row)]
        self._loading = Loading(components, keep_going, later) if components else None
        everything = [*processes] if self._loading is None else [self._loading, *processes]
        super().__init__(system, everything, environment, patience, keep_going, rows)

    def run(self) -> int:
        """Do so, unless something is missing that is needed to load nodes: then return 2."""
        if self._loading is None:
            return super().run()
        purpose = 'Nodes are to be loaded into containers'
        advice = (
            'Install the package (ros-$ROS_DISTRO-composition-interfaces) and source the setup '
            'file of ROS 2.'
        )
        if lacks(NEEDED_TO_LOAD, purpose, advice, self._environment):
            return 2
        if faults := self._loading.faults(self._environment):
            what = 'Parameters of nodes in containers cannot be read, so nothing was started:'
            print(what, faults, sep='\n', file=sys.stderr)
            return 2
        ours = {process.node.full_name for process in self._processes}
        for node in self._components.values():
            if node.container not in ours:  # it runs elsewhere
                ours.add(node.container)
                self._loading.tell('started', _named(node.container))
        with self._loading.talk as talk:
            self._selector.register(talk, selectors.EVENT_READ, self._hear_of_loading)
            return super().run()

    @classmethod
    def by_hand(cls, node: Node) -> str:
        """Return the command for bash that loads a node; Python reads its files for it."""
        line = super().by_hand(node)
        if not node.files:
            return line
        words = [*location(run_with_values), node.full_name, json.dumps([*node.files])]
        return f'{shlex.join(["python3", "-c", BY_HAND, *words])} {line}'

    def _hear_of_loading(self) -> None:
        assert self._loading is not None
        said, more = self._loading.hear()
        if not more:
            self._selector.unregister(self._loading.talk)
        for what, name in said:
            if what == 'loaded':
                self._tell_of([self._components[name]], 'started')
            elif what == 'failed':
                self._tell_of(self._inside(name), 'gone')

    def _inside(self, container: str) -> list[Node]:
        return [node for node in self._components.values() if node.container == container]

    def _tell_of(self, nodes: Sequence[Node], what: str) -> None:
        """Tell who brings nodes up of those that are managed."""
        for node in nodes:
            if self._bring_up is not None and managed(node) is not None:
                self._active.discard(node.full_name)
                self._bring_up.tell(what, node)

    def _start(self, process: Process) -> None:
        super()._start(process)
        self._tell_of_container(process, 'started' if process.group else 'gone')

    def _ended(self, process: Process) -> None:
        super()._ended(process)
        self._tell_of_container(process, 'ended' if process.state is State.WAITING else 'gone')
        self._finish_alone()

    def _tell_of_container(self, process: Process, what: str) -> None:
        inside = self._inside(process.node.full_name)
        if not inside or self._loading is None:
            return
        assert isinstance(process.node, Node)
        self._loading.tell(what, process.node)
        if what != 'started':
            self._tell_of(inside, what)


def _named(full_name: str) -> Node:
    namespace, _, name = full_name.rpartition('/')
    return Node(name, namespace or '/', '', '')
