"""The system at run time: every node by its full name, every topic by its graph name.

Names resolve as ROS 2 resolves them (ROS 2 design, "Topic and Service name mapping"): an absolute
name is kept, a relative one is resolved in the namespace where it is written, ``~/x`` under
the node's own full name. An absolute ``namespace`` replaces the enclosing one, a relative one
extends it. An imported system used as ``subsystem left : Arm namespace /left`` is flattened under
``/left``. A ``safety`` statement becomes its nodes.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

from deros.interfaces.types import InterfaceType
from deros.models.common import Value
from deros.models.launch_files import MadeFile
from deros.models.lifecycle import Autostart, combined
from deros.models.node import NodeType, Port, PortKind
from deros.models.parameter_files import ParameterFile
from deros.models.programs import ProcessInstance
from deros.models.rules import Rules
from deros.models.system import (
    GroupSettings,
    NodeInstance,
    SafetyInstance,
    Subsystem,
    System,
    Wiring,
)
from deros.names.graph_names import from_root, resolve_name
from deros.systems.arguments.resolve import resolve
from deros.systems.flat import (
    FlatLaunch,
    FlatNode,
    FlatPort,
    FlatProcess,
    FlatSystem,
    FlatTopic,
    UntypedWiring,
    entries_of,
    is_topic_parameter,
)
from deros.systems.group_remappings import remapped
from deros.systems.groups import Groups
from deros.systems.known_topics import TopicTable
from deros.systems.parameters.overrides import NOTHING, file_parameters, wired_setting
from deros.systems.remapping import remappings, wired_ends
from deros.systems.running.autostart import autostart_of
from deros.systems.running.composition import in_containers
from deros.systems.running.processes import MakeNode, NodePlace, in_processes
from deros.systems.running.readiness import awaited_end
from deros.systems.safety_instances import (
    Place,
    instances,
    safety_node_types,
    unresolved_instance,
)
from deros.systems.safety_qos import Offers


def flatten(system: System, root: str = "/") -> FlatSystem:
    """Expand ``system``; unknown node types, ports and systems are left out, not reported here.

    Args:
        system: one that is computed from arguments has their usual values; for others, resolve it
            before.
        root: the namespace that it is started in.
    """
    return _Expansion(_Walk(resolve(system), root), _node_types).system()


@dataclass(frozen=True, slots=True)
class _Site:
    """A ``safety`` statement and its place at run time."""

    statement: SafetyInstance
    path: tuple[str, ...]
    place: Place
    groups: Groups
    files: tuple[ParameterFile, ...]
    host: str


@dataclass(frozen=True, slots=True)
class _Program:
    """A process that is not a node, and its place at run time."""

    instance: ProcessInstance
    path: tuple[str, ...]
    groups: Groups
    host: str
    namespace: str


@dataclass(frozen=True, slots=True)
class _Launch:
    """A launch file, and its place at run time."""

    instance: Subsystem
    path: tuple[str, ...]
    namespace: str
    groups: Groups
    files: tuple[ParameterFile, ...]
    host: str


@dataclass(frozen=True, slots=True)
class _Around:
    """What the groups around a part say for the nodes in it, and which launch file starts these."""

    groups: Groups
    autostart: Autostart | None
    host: str
    files: tuple[ParameterFile, ...] = ()
    launch: Subsystem | None = None


def _around(system: System) -> _Around:
    host = "" if system.host is None else system.host.text
    return _Around(Groups(), system.autostart, host)


class _Walk:
    """The members of a system, imports expanded, in the order written."""

    def __init__(self, system: System, root: str = "/") -> None:
        self.system = system
        self.topics: list[FlatTopic] = []
        self.found: list[FlatNode | _Site | _Program | _Launch] = []
        self.files: list[ParameterFile] = []
        self.makers: dict[NodePlace, MakeNode] = {}
        self.made: list[MadeFile] = []
        self._enter(system, root, root, (), (system,), _around(system))

    def _enter(
        self,
        part: System | Subsystem,
        namespace: str,
        frame: str,
        path: tuple[str, ...],
        open_systems: tuple[System, ...],
        around: _Around,
    ) -> None:
        groups = around.groups.within(part.settings)
        self.files += part.files
        self.made += part.made
        files = (*around.files, *part.files)
        self.topics += (FlatTopic(resolve_name(t.name, namespace), t, path) for t in part.topics)
        members: Iterable[NodeInstance | Subsystem | SafetyInstance | ProcessInstance]
        members = part.members
        if part.safety or part.processes:
            everything = (*part.members, *part.safety, *part.processes)
            members = sorted(everything, key=lambda each: each.span.start)
        for member in members:
            host = member.host.text if member.host is not None else around.host
            if isinstance(member, ProcessInstance):
                self.found.append(_Program(member, path, groups, host, namespace))
                continue
            inner = namespace
            if member.namespace is not None:
                inner = resolve_name(member.namespace, namespace)
            if isinstance(member, NodeInstance | SafetyInstance):
                self.files += member.files
                read = (*files, *member.files)
            if isinstance(member, NodeInstance):
                there = replace(around, host=host)
                make = functools.partial(_node, member, inner, path, frame, there, groups)
                self.makers[path, member.name_span] = make
                self.found.append(make(read))
                continue
            if isinstance(member, SafetyInstance):
                place = Place(inner, frame)
                self.found.append(_Site(member, path, place, groups, read, host))
                continue
            here = (*path, member.name)
            if member.launch is not None:
                self.found.append(_Launch(member, path, inner, groups, files, host))
                nodes = _Around(groups, None, host, files, member)
                self._enter(member, inner, frame, here, open_systems, nodes)
                continue
            autostart = combined(member.autostart, around.autostart)
            below = _Around(groups, autostart, host, files)
            self._enter(member, inner, frame, here, open_systems, below)
            used = member.system
            # A system that uses itself is reported as a cyclic import; expanding it would never
            # end.
            if used is not None and not any(used is one for one in open_systems):
                autostart = combined(used.autostart, autostart)
                read = (*files, *member.files)
                within = _Around(groups.within(member.settings), autostart, host, read)
                self._enter(used, inner, inner, here, (*open_systems, used), within)


# Safety statements --------------------------------------------------------------------------------

_Describe = Callable[[SafetyInstance, Rules], tuple[NodeType, ...]]


class _Expansion:
    """A system with the nodes of its ``safety`` statements."""

    def __init__(self, walk: _Walk, describe: _Describe) -> None:
        self._walk = walk
        self._describe = describe

    def system(self) -> FlatSystem:
        nodes: list[FlatNode] = []
        others: list[FlatProcess | FlatLaunch] = []
        for each in self._programs():
            if isinstance(each, FlatNode):
                nodes.append(each)
            elif isinstance(each, _Launch):
                others.append(_flat_launch(each, len(nodes)))
            else:
                others.append(_flat_process(each, len(nodes)))
        walk = self._walk
        topics, files, made = tuple(walk.topics), tuple(walk.files), tuple(walk.made)
        nodes, others = in_processes(in_containers(nodes), others, walk.makers)
        return FlatSystem(walk.system, tuple(nodes), topics, tuple(others), files, made)

    def _programs(self) -> Iterator[FlatNode | _Program | _Launch]:
        seen: set[tuple[int, str]] = set()
        for each in self._walk.found:
            if not isinstance(each, _Site):
                yield each
                continue
            # A second statement for the same rules is reported; its nodes would be the same ones.
            key = (id(each.statement.rules), each.place.frame)
            if each.statement.rules is None or key not in seen:
                seen.add(key)
                yield from self._at(each)

    def _at(self, site: _Site) -> Iterator[FlatNode]:
        statement, place = site.statement, site.place
        if statement.rules is None:
            found: tuple[NodeInstance, ...] = (unresolved_instance(statement),)
        else:
            types = self._describe(statement, statement.rules)
            complete = site.groups.applied_to_rules(statement, types)
            found = instances(complete, statement.rules, types, place)
        for instance in found:
            flat = _flat_node(instance, place.namespace, site.path, place.frame, site.files)
            yield replace(_in_groups(flat, site.groups), statement=statement, host=site.host)


def _node_types(statement: SafetyInstance, rules: Rules) -> tuple[NodeType, ...]:
    """Return the nodes of a statement, given the systems that the rules use."""
    return nodes_of_rules(rules, statement.target, statement.package or "")


def nodes_of_rules(rules: Rules, target: str = "python", package: str = "") -> tuple[NodeType, ...]:
    """Return the safety node that rules become, followed by its gates.

    Args:
        rules: as written; inputs whose type is in no used system are left out.
        target: the language that they are generated in, ``python`` or ``cpp``.
        package: that they are generated in, with or without what the target appends.
    """
    if (target, package) not in rules.nodes:
        rules.nodes[target, package] = _nodes_of_rules(rules, target, package)
    return rules.nodes[target, package]


def _nodes_of_rules(rules: Rules, target: str, package: str) -> tuple[NodeType, ...]:
    topics = _known_topics(rules)

    def type_of(name: str) -> InterfaceType | None:
        known = topics.get(name)
        return known.type if known is not None else None

    return safety_node_types(rules, type_of, topics.offers, target, package)


def _node_types_alone(statement: SafetyInstance, rules: Rules) -> tuple[NodeType, ...]:
    """Return the nodes of a statement as far as they follow from the rules alone.

    Other safety nodes need no more: the topics that they publish, and the types.
    """
    return safety_node_types(
        rules, lambda _: None, lambda _: Offers(), statement.target, statement.package or ""
    )


def _known_topics(rules: Rules) -> TopicTable:
    """Return the topics of the systems that rules use, without the inputs of safety nodes."""
    systems = {id(use.system): use.system for use in rules.uses if use.system is not None}
    return TopicTable(
        _Expansion(_Walk(resolve(system)), _node_types_alone).system()
        for system in systems.values()
    )


# Nodes --------------------------------------------------------------------------------------------


def _flat_process(found: _Program, position: int) -> FlatProcess:
    instance = found.instance
    return FlatProcess(
        instance,
        found.path,
        found.groups.environment(instance.environment),
        position,
        host=found.host,
        awaited_end=awaited_end(instance.starting, found.namespace),
    )


def _flat_launch(found: _Launch, position: int) -> FlatLaunch:
    groups = found.groups
    return FlatLaunch(
        found.instance,
        found.path,
        found.namespace,
        groups.environment(()),
        groups.parameters,
        groups.remappings,
        found.files,
        position,
        found.host,
    )


def _node(
    member: NodeInstance,
    namespace: str,
    path: tuple[str, ...],
    frame: str,
    around: _Around,
    groups: Groups,
    files: tuple[ParameterFile, ...],
) -> FlatNode:
    """Return a node of the system with all that the groups around it say."""
    node = _flat_node(groups.applied(member), namespace, path, frame, files)
    autostart = autostart_of(member, around.autostart)
    node = replace(node, autostart=autostart, launch=around.launch, host=around.host)
    return _in_groups(node, groups.within(GroupSettings(remappings=member.remappings)))


def _in_groups(node: FlatNode, groups: Groups) -> FlatNode:
    """Return a node, which has the parameters of the groups around it, with all else of them."""
    environment = groups.environment(node.instance.environment)
    found = remapped(node, groups.remappings, comes_first=node.launch is not None)
    return replace(found, environment=environment)


def _flat_node(
    instance: NodeInstance,
    namespace: str,
    path: tuple[str, ...],
    frame: str,
    files: tuple[ParameterFile, ...],
) -> FlatNode:
    def full(name: str) -> str:
        return resolve_name(name, namespace, instance.name)

    node_type = instance.type
    full_name = resolve_name(instance.name, namespace)
    by_port: dict[tuple[PortKind, str], Wiring] = {}
    by_parameter: dict[str, Wiring] = {}
    for wiring in instance.wirings if node_type else ():
        assert node_type is not None
        for port, parameter in wired_ends(node_type, wiring):
            if port is not None:
                by_port.setdefault((port.kind, port.name), wiring)
            if parameter and is_topic_parameter(node_type, parameter):
                by_parameter.setdefault(parameter, wiring)
    # The wiring wins over a `param` for the same parameter; contradicting it is reported elsewhere.
    wired = {name: full(wiring.target) for name, wiring in by_parameter.items()}
    from_files = NOTHING
    if files:
        own = [each for each in instance.parameters if each.name not in wired]
        own += (wired_setting(name, each, wired[name]) for name, each in by_parameter.items())
        from_files = file_parameters(files, from_root(full_name), own)
        parameters = (*from_files.settings, *instance.parameters)
        instance = replace(instance, parameters=parameters)
    settings: dict[str, Value] = {p.name: p.value for p in instance.parameters} | wired

    flat_ports: list[FlatPort] = []
    claimed: set[str] = set()
    for port in node_type.ports if node_type else ():
        assert node_type is not None
        if node_type.is_listed(port):
            for parameter, entry in _listed(port, node_type, settings):
                topic = full(entry)
                flat_ports.append(
                    FlatPort(port, topic, None, topic, entry=entry, named_by=parameter)
                )
            continue
        found = by_parameter.get(port.via) if port.via is not None else None
        if found is not None and port.via is not None:
            claimed.add(port.via)
            topic = full(found.target)
            flat_ports.append(FlatPort(port, topic, found, topic, sets_parameter=True))
            continue
        requested = full(_default_topic(port, node_type, settings))
        found = by_port.get((port.kind, port.name))
        topic = requested if found is None else full(found.target)
        flat_ports.append(FlatPort(port, topic, found, requested))
    untyped = tuple(
        UntypedWiring(wiring, full(wiring.target))
        for name, wiring in by_parameter.items()
        if name not in claimed
    )
    return FlatNode(
        instance,
        node_type,
        path,
        namespace,
        full_name,
        tuple(flat_ports),
        untyped,
        tuple(settings.items()),
        remappings(flat_ports),
        frame,
        files=files,
        beaten=from_files.beaten,
        awaited_end=awaited_end(instance.starting, namespace, instance.name),
    )


def _listed(
    port: Port, node_type: NodeType, settings: dict[str, Value]
) -> Iterator[tuple[str, str]]:
    """Yield the names that a port has, as set or else by default, each after its parameter.

    An empty one is the name of no topic.
    """
    parameter = node_type.parameter(port.via) if port.via is not None else None
    if parameter is None:
        return
    holders = [parameter.name]
    if parameter.keys:
        entries = entries_of(node_type, parameter, settings) or ()
        holders = [parameter.name_for(entry) for entry in dict.fromkeys(entries)]
    for holder in holders:
        value = settings.get(holder, parameter.default)
        for name in value if isinstance(value, tuple) else (value,):
            if isinstance(name, str) and name:
                yield holder, name


def _default_topic(port: Port, node_type: NodeType | None, settings: dict[str, Value]) -> str:
    """Return the name an unwired port uses: its parameter's value if it has one, else its own."""
    if port.via is None or node_type is None:
        return port.name
    parameter = node_type.parameter(port.via)
    value = settings.get(port.via, parameter.default if parameter else None)
    return value if isinstance(value, str) and value else port.name
