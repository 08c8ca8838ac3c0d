"""Models of RosTooling: nodes (``*.ros2``) and systems (``*.rossystem``) that use them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from deros.importers.formats import loading
from deros.importers.formats.names import UniqueNames, identifier
from deros.importers.formats.rostooling_nodes import ReadNode, read_nodes, typed
from deros.importers.formats.rostooling_systems import Instance, ReadSystem, read_systems
from deros.importers.formats.values import UnusableError
from deros.importers.node_types import ImportedGraph, ImportedNode, ImportedType, TypePort
from deros.importers.readers import Request, UnreadableError, source_of
from deros.importers.results import Imported, Missing, Parts
from deros.importers.texts import system_file
from deros.live.snapshots import End, SeenNode
from deros.metamodels.yaml_trees.tree import Tree
from deros.models.common import Value
from deros.models.node import NodeType

_NODES, _SYSTEMS = ".ros2", ".rossystem"


def is_rostooling(path: Path) -> bool:
    """Return whether a file is a model of RosTooling, by its name."""
    return path.suffix in (_NODES, _SYSTEMS)


def read_rostooling(request: Request) -> Imported:
    """Return a system for each system, and a description for each node type.

    Raises:
        UnreadableError: if a file cannot be read, or none of them says anything.
    """
    names = UniqueNames()
    nodes: list[ReadNode] = []
    systems: list[ReadSystem] = []
    missing: list[Missing] = []
    for path in request.files:
        if path.suffix != _SYSTEMS:
            found, more = read_nodes(source_of(path), names)
            nodes += found
            missing += more
    for path in request.files:
        if path.suffix == _SYSTEMS:
            systems += read_systems(source_of(path), nodes)
    if not nodes and not systems:
        raise UnreadableError(f"{request.files[0]}: there is no node in these files")
    for node in nodes:
        node.settle(_always_set(node, systems))
        node.draft.clean(request.store)
    files = dict(_systems(systems, request.name))
    files |= {f"nodes/{each.draft.node.name}.rnd": each.parts() for each in nodes}
    missing += (each for node in nodes for each in node.draft.missing)
    missing += (each for system in systems for each in system.missing)
    return Imported(files, tuple(map(str, missing)))


def _always_set(node: ReadNode, systems: Iterable[ReadSystem]) -> set[str]:
    """Return the parameters without a value that every node of the type is given one for."""
    settings = [
        {name for name, value in each.settings if _fits(node, name, value)}
        for system in systems
        for each in system.instances
        if each.read is node
    ]
    return set.intersection(*settings) & node.unset.keys() if settings else set()


def _fits(node: ReadNode, name: str, tree: Tree) -> bool:
    if name not in node.unset:
        return False
    try:
        return typed(tree, node.unset[name][0]) is not None
    except UnusableError:
        return False


# Systems ----------------------------------------------------------------------------------------


def _systems(systems: list[ReadSystem], name: str | None) -> Iterator[tuple[str, Parts]]:
    names = UniqueNames()
    by_name = {each.name: each for each in systems}
    for system in systems:
        alone = name if name is not None and len(systems) == 1 else None
        called = names.of(alone or identifier(system.name, "robot"))
        instances = list(_instances(system, by_name, system, set()))
        graph = ImportedGraph(tuple(_imported(system, each) for each in instances), (), ())
        parts = system_file(graph, called)
        if system.origin:
            parts = Parts(f"// From {system.origin}\n{parts.head}", parts.body)
        yield f"{called}.system", parts


def _instances(
    system: ReadSystem, known: dict[str, ReadSystem], whole: ReadSystem, above: set[str]
) -> Iterator[Instance]:
    """Yield the nodes of a system and of its subsystems, each full name once."""
    taken = set()
    for each in system.instances:
        taken.add(each.full_name)
        yield each
    for name, span in system.inside:
        inner = known.get(name)
        what = f"subsystem '{name}'"
        if inner is None:
            why = "is left out: none of the files has it"
            whole.missing.append(loading.missing(what, why, span))
        elif name in above | {system.name}:
            why = "is left out: it contains itself"
            whole.missing.append(loading.missing(what, why, span))
        else:
            for each in _instances(inner, known, whole, above | {system.name}):
                if each.full_name in taken:
                    why = f"has a second node '{each.full_name}', which is left out"
                    whole.missing.append(loading.missing(what, why, span))
                else:
                    taken.add(each.full_name)
                    yield each


def _imported(system: ReadSystem, instance: Instance) -> ImportedNode:
    node = instance.read.draft.node
    ports = tuple(TypePort(each.kind, each.name, each.type, each.qos) for each in node.ports)
    ends = tuple(
        End(each.kind, instance.graph_name(each), str(each.type), each.qos) for each in node.ports
    )
    seen = SeenNode(instance.full_name, ends, ())
    of = ImportedType(node.name, ports, (), is_managed=False, left_out=())
    values = tuple(_values(system, instance, node))
    kept = {(port.kind, port.name) for port in node.ports}
    renamed = {key: name for key, name in instance.graph_names.items() if key in kept}
    return ImportedNode(seen, of, ends, values, renamed)


def _values(system: ReadSystem, instance: Instance, node: NodeType) -> Iterator[tuple[str, Value]]:
    """Yield what a node's parameters are set to, each once."""
    given: set[str] = set()
    for name, tree in instance.settings:
        what = f"parameter '{name}' of '{instance.name}'"
        declared = node.parameter(name)
        of_type = declared.type if declared is not None else None
        if of_type is None and name in instance.read.unset:
            of_type = instance.read.unset[name][0]
        value, why = None, ""
        try:
            value = typed(tree, of_type) if of_type is not None else None
        except UnusableError as error:
            why = f"it {error}"
        if of_type is None:
            why = "its type has no parameter of that name here"
        elif value is None:
            why = why or "it has no value"
        elif name in given:
            why = "it is set twice"
        if why or value is None:
            system.missing.append(loading.missing(what, f"is left out: {why}", tree.span))
            continue
        given.add(name)
        yield name, value
