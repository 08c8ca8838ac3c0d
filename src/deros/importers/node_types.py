"""The node types of a snapshot: nodes with equal interfaces share one."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from deros.importers.components import Containers
from deros.importers.file_names import FileNames, numbered
from deros.interfaces.types import InterfaceKind, InterfaceType
from deros.live.observer import printable
from deros.live.snapshots import End, SeenNode, SeenParameter, Snapshot
from deros.models.common import QosProfile, Value
from deros.models.composition import CONTAINER
from deros.models.node import BUILT_IN_PARAMETERS, PortKind
from deros.models.qos import USUAL_OVERRIDES
from deros.names.graph_names import resolve_name
from deros.names.names import (
    check_node_name,
    check_parameter_name,
    check_topic_name,
    not_text,
)

_KINDS: dict[str, InterfaceKind] = {"msg": "msg", "srv": "srv", "action": "action"}
_TYPE = re.compile(r"(\w+)/(msg|srv|action)/(\w+)")
_CLOCK = (PortKind.SUBSCRIPTION, "/clock", "rosgraph_msgs/msg/Clock")


class TypePort(NamedTuple):
    """A port of a node type; the name is absolute, relative or private."""

    kind: PortKind
    name: str
    type: InterfaceType
    qos: QosProfile | None


class LeftOut(NamedTuple):
    """What a model cannot say of a node, and why."""

    what: str
    why: str


@dataclass(frozen=True, slots=True)
class ImportedType:
    """A node type of a snapshot.

    Attributes:
        parameters: without their values; ``None`` if they are not known.
        left_out: what it has, and a model cannot say.
        is_component: whether containers load it.
    """

    name: str
    ports: tuple[TypePort, ...]
    parameters: tuple[SeenParameter, ...] | None
    is_managed: bool
    left_out: tuple[LeftOut, ...]
    is_component: bool = False


_CONTAINER = ImportedType(CONTAINER, (), (), False, ())


@dataclass(frozen=True, slots=True)
class ImportedNode:
    """A node of a snapshot and its type.

    Attributes:
        ends: those that the type has ports for.
        values: of parameters, in the order of their names.
        renamed: the graph names of the ports of the type that are not connected to their own.
        container: the full name of the container that it is loaded into, if it is.
        is_container: whether it is one that the model says.
    """

    seen: SeenNode
    type: ImportedType
    ends: tuple[End, ...]
    values: tuple[tuple[str, Value], ...]
    renamed: Mapping[tuple[PortKind, str], str] = field(default_factory=dict)
    container: str | None = None
    is_container: bool = False


@dataclass(frozen=True, slots=True)
class ImportedGraph:
    """The nodes and types of a snapshot, and what is left out of each node."""

    nodes: tuple[ImportedNode, ...]
    types: tuple[ImportedType, ...]
    problems: tuple[str, ...]


def imported(snapshot: Snapshot, is_known: Callable[[InterfaceType], bool]) -> ImportedGraph:
    """Return the node types of a snapshot, and the type of each node.

    Names below a node become private. Others become relative if they are in the namespace of the
    node, unless that is the root: a name there is relative only if another node of the type shows
    it.

    Args:
        snapshot: of a graph.
        is_known: whether there is a definition of an interface.
    """
    types = _Types()
    nodes: list[ImportedNode] = []
    containers = Containers(snapshot)
    problems = [each.what for each in snapshot.unseen if not containers.is_usual(each)]
    # Nodes in the root do not show which of their names are relative, so they come last.
    for node in sorted(snapshot.nodes, key=lambda each: (each.namespace == "/", each.full_name)):
        if why := check_node_name(node.name) or _namespace_fault(node.namespace):
            problems.append(f"{node.full_name} is left out: its name {why}")
            continue
        if node.count > 1:
            problems.append(f"{node.count} nodes are called {node.full_name}: they are seen as one")
        usable = _Usable(node, is_known)
        problems += (f"{node.full_name}: {each.what} {each.why}" for each in usable.left_out)
        problems += containers.problems_of(node)
        if containers.is_one(node):
            nodes.append(ImportedNode(node, _CONTAINER, (), (), is_container=True))
            continue
        container = containers.of(node)
        found = types.of(usable, is_component=container is not None)
        ends, values = tuple(usable.ends), tuple(usable.values)
        nodes.append(ImportedNode(node, found, ends, values, container=container))
    nodes.sort(key=lambda each: each.seen.full_name)
    return ImportedGraph(tuple(nodes), types.all, tuple(problems))


def _namespace_fault(namespace: str) -> str | None:
    return None if namespace == "/" else check_topic_name(namespace)


@dataclass
class _Usable:
    """What a model can say of a node, and what it cannot."""

    node: SeenNode
    is_known: Callable[[InterfaceType], bool]
    ends: list[End] = field(default_factory=list)
    parameters: list[SeenParameter] = field(default_factory=list)
    values: list[tuple[str, Value]] = field(default_factory=list)
    left_out: list[LeftOut] = field(default_factory=list)

    def __post_init__(self) -> None:
        for end in self.node.ends:
            if self._is_for_simulated_time(end):
                continue
            what = f"{end.kind.word} {end.name} : {end.type}"
            if why := check_topic_name(end.name):
                self.left_out.append(LeftOut(what, f"is left out: its name {why}"))
            elif (found := _interface_type(end.type)) is None or not self.is_known(found):
                why = "is left out: there is no definition of its type here, see --interfaces"
                self.left_out.append(LeftOut(what, why))
            else:
                self.ends.append(end)
        for parameter in self.node.parameters or ():
            self._take(parameter)

    def _is_for_simulated_time(self, end: End) -> bool:
        """Return whether a node reads the clock because it was told to, whatever it does."""
        is_clock = (end.kind, end.name, end.type) == _CLOCK
        parameters = self.node.parameters or ()
        return is_clock and any(each.name == "use_sim_time" and each.value for each in parameters)

    def _take(self, parameter: SeenParameter) -> None:
        if parameter.name in BUILT_IN_PARAMETERS:
            usual = parameter.name != "use_sim_time"
            if parameter.value != usual:
                self.values.append((parameter.name, parameter.value))
            return
        if USUAL_OVERRIDES.get(parameter.name) == parameter.value:
            return
        what = f"parameter {printable(parameter.name)}"
        if why := check_parameter_name(parameter.name):
            self.left_out.append(LeftOut(what, f"is left out: its name {why}"))
            return
        texts = [parameter.value] if isinstance(parameter.value, str) else parameter.value
        if isinstance(texts, list | tuple) and any(
            isinstance(text, str) and not_text(text) for text in texts
        ):
            self.left_out.append(LeftOut(what, "is left out: its value is not a text"))
            return
        if parameter.step:
            self.left_out.append(LeftOut(what, f"goes in steps of {parameter.step!r}"))
        if parameter.constraints:
            why = f"has constraints in words: {printable(parameter.constraints)}"
            self.left_out.append(LeftOut(what, why))
        description = parameter.description
        if not_text(description):
            description = printable(description)
        self.parameters.append(replace(parameter, description=description))
        self.values.append((parameter.name, parameter.value))


def interface_type(text: str) -> InterfaceType:
    """Return the type that ROS 2 spells ``package/kind/Name``, of an end that is not left out."""
    found = _interface_type(text)
    assert found is not None
    return found


def _interface_type(text: str) -> InterfaceType | None:
    found = _TYPE.fullmatch(text)
    return InterfaceType(found[1], _KINDS[found[2]], found[3]) if found else None


class _Types:
    """The types so far."""

    def __init__(self) -> None:
        self._found: list[ImportedType] = []
        self._names = FileNames()

    @property
    def all(self) -> tuple[ImportedType, ...]:
        """All types, sorted by name."""
        return tuple(sorted(self._found, key=lambda each: each.name))

    def of(self, usable: _Usable, *, is_component: bool) -> ImportedType:
        """Return the type of a node, a new one if no other has its interface."""
        node = usable.node
        declared = None if node.parameters is None else tuple(map(_declared, usable.parameters))
        left_out = tuple(usable.left_out)
        for each in self._found:
            if (
                each.parameters == declared
                and each.is_component == is_component
                and each.is_managed == (node.lifecycle is not None)
                and each.left_out == left_out
                and _resolved(each, node) == tuple(map(_port, usable.ends))
            ):
                return each
        ports = tuple(_port(end)._replace(name=_as_written(end, node)) for end in usable.ends)
        name = self._name(node)
        is_managed = node.lifecycle is not None
        found = ImportedType(name, ports, declared, is_managed, left_out, is_component)
        self._found.append(found)
        return found

    def _name(self, node: SeenNode) -> str:
        """Return a name that differs from others in more than case: it is that of a file."""
        where = "_".join(node.namespace.split("/")[1:])
        full = f"{node.name}_{where}" if where else node.name
        return self._names.first(itertools.chain((node.name,), numbered(full)))


def _declared(parameter: SeenParameter) -> SeenParameter:
    return replace(parameter, value=())


def _port(end: End) -> TypePort:
    return TypePort(end.kind, end.name, interface_type(end.type), end.qos)


def _as_written(end: End, node: SeenNode) -> str:
    if end.name.startswith(f"{node.full_name}/"):
        return f"~{end.name.removeprefix(node.full_name)}"
    if node.namespace != "/" and end.name.startswith(f"{node.namespace}/"):
        return end.name.removeprefix(f"{node.namespace}/")
    return end.name


def _resolved(known: ImportedType, node: SeenNode) -> tuple[TypePort, ...]:
    """Return the ports that a node of a type has under its own name, in the order of its ends."""
    ports = (
        port._replace(name=resolve_name(port.name, node.namespace, node.name))
        for port in known.ports
    )
    return tuple(sorted(ports, key=_order))


def _order(port: TypePort) -> tuple[int, str]:
    return list(PortKind).index(port.kind), port.name


def names_of(ends: Iterable[End], *kinds: PortKind) -> set[str]:
    """Return the graph names of the ends of some kinds."""
    return {end.name for end in ends if end.kind in kinds}
