"""What programs wait for in the ROS graph before they are started."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from deros.interfaces.standard_services import OF_EVERY_NODE, OF_MANAGED_NODES
from deros.models.node import PortKind
from deros.models.starting import AT_ONCE, Ready, Starting
from deros.names.graph_names import resolve_name
from deros.systems.flat import FlatLaunch, FlatNode, FlatProgram, FlatSystem, listed_nodes
from deros.systems.remapping import ACTION_SERVICES, ACTION_TOPICS
from deros.systems.running.autostart import manager_of
from deros.systems.running.starting import awaited_programs, programs_by_key

_OF_CONTAINERS = ("load_node", "unload_node", "list_nodes")
_OF_NODES = ("/rosout", "/parameter_events")
"""Topics that every node publishes."""


Way = tuple[FlatProgram, ...]
"""Programs of which each needs the next one."""


def awaited_end(starting: Starting, namespace: str, node_name: str = "") -> str:
    """Return the graph name of the service or topic that a program waits for; without one, empty.

    Args:
        starting: of the program.
        namespace: in which the name resolves: that of a node, or that around a process.
        node_name: of a node, which ``~`` stands for.
    """
    ready = starting.ready
    if ready is None or ready.names_program:
        return ""
    return resolve_name(ready.name, namespace, node_name)


def starting_of(program: FlatProgram) -> Starting:
    """Return when a program is started; a launch file always is at once."""
    return AT_ONCE if isinstance(program, FlatLaunch) else program.instance.starting


def names_awaited(program: FlatProgram) -> Iterator[tuple[str, str, str]]:
    """Yield the names at which a program is awaited, or awaits something, and as what.

    Each is the kind of the name, the name, and what the program is there.
    """
    yield "awaited", program.instance.name, "program"
    starting = starting_of(program)
    wait = starting.after or starting.ready
    if wait is None:
        return
    yield "waiting", "", "program"  # for each other, perhaps
    if isinstance(program, FlatLaunch) or not program.awaited_end:
        last = wait.name.rpartition("/")[2]
        yield from (("awaited", last, "waiting"), ("activated", last, "waiting"))
        return
    name = program.awaited_end
    while name:  # also the service of a node or a container, and a part of an action
        yield from (("topic", name, "waiting"), ("node", name, "waiting"))
        name = name.rpartition("/")[0]


class StartOrder:
    """What has to be started before the programs of a system that wait."""

    def __init__(self, flat: FlatSystem) -> None:
        """Find what the programs of a system wait for."""
        self.known = programs_by_key(flat)
        self._nodes = {node.full_name: node for node in flat.nodes}
        self._programs: dict[str, FlatProgram] = {each.full_name: each for each in flat.parts}
        self._flat = flat
        self._providers: Mapping[tuple[str, str], Sequence[FlatNode]] | None = None

    def before(self, program: FlatProgram) -> list[Way]:
        """Return the programs without whose start that of another one never comes.

        Each stands at the end of a way to it, behind the node that it brings to active, if it is
        for that.
        """
        starting = starting_of(program)
        if starting.after is not None:
            found = awaited_programs(program.path, starting.after.name, self.known)
            return [tuple(found)] if len(found) == 1 else []
        if starting.ready is None or isinstance(program, FlatLaunch):
            return []
        if starting.ready.names_program:
            return self._before_ready(program, starting.ready)
        providers = self.providers.get((starting.ready.kind, program.awaited_end), ())
        processes = {each.full_name: each for each in map(self._process, providers)}
        return [tuple(processes.values())] if len(processes) == 1 else []

    def _before_ready(self, program: FlatProgram, ready: Ready) -> list[Way]:
        found = awaited_programs(program.path, ready.name, self.known)
        if len(found) != 1 or not isinstance(found[0], FlatNode):
            return []
        node = found[0]
        managers = [*self._managers(node)] if ready.kind == "active" else []
        process = self._process(node)
        return [(process,), *([(process, managers[0])] if len(managers) == 1 else [])]

    def _managers(self, node: FlatNode) -> Iterator[FlatProgram]:
        """Yield the programs that bring a node to active."""
        manager = manager_of(node, self._nodes)
        if manager is not None:
            yield self._process(manager)
        for other in self._flat.nodes:
            if any(resolve_name(e, other.namespace) == node.full_name for e in listed_nodes(other)):
                yield self._process(other)

    def _process(self, node: FlatNode) -> FlatProgram:
        return self._programs.get(node.container or node.process or "", node)

    @property
    def providers(self) -> Mapping[tuple[str, str], Sequence[FlatNode]]:
        """The nodes that have a service or publish a topic, by its kind and its graph name."""
        if self._providers is None:
            found = defaultdict(list)
            for node in self._flat.nodes:
                for end in _provided(node):
                    found[end].append(node)
            self._providers = dict(found)
        return self._providers


def _provided(node: FlatNode) -> Iterator[tuple[str, str]]:
    """Yield the services and topics that a node has, by kind and name."""
    for end in node.ports:
        if end.port.kind is PortKind.PUBLISHER:
            yield "topic", end.topic
        elif end.port.kind is PortKind.SERVICE:
            yield "service", end.topic
        elif end.port.kind is PortKind.ACTION:
            yield from (("service", f"{end.topic}/_action/{part}") for part in ACTION_SERVICES)
            yield from (("topic", f"{end.topic}/_action/{part}") for part in ACTION_TOPICS)
    for untyped in node.untyped:
        yield from (("topic", untyped.topic), ("service", untyped.topic))
    names = [*OF_EVERY_NODE]
    if node.type is not None and node.type.lifecycle:
        names += OF_MANAGED_NODES
        yield "topic", f"{node.full_name}/transition_event"
    if node.instance.is_container:
        names += (f"_container/{each}" for each in _OF_CONTAINERS)
    yield from (("service", f"{node.full_name}/{each}") for each in names)
    yield from (("topic", each) for each in _OF_NODES)
