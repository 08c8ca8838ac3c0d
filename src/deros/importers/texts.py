"""Imported nodes as text: descriptions of their types, and the system that they form."""

from __future__ import annotations

from collections.abc import Iterator

from deros.diagnostics import SourceFile, Span
from deros.generators.node.description import parameter_line, parameter_name, value_text
from deros.importers.node_text import UNKNOWN_PACKAGE, body, head, port_line, wired
from deros.importers.node_types import (
    ImportedGraph,
    ImportedNode,
    ImportedType,
    LeftOut,
    interface_type,
)
from deros.importers.results import Parts
from deros.interfaces.standard_services import OF_EVERY_NODE, OF_MANAGED_NODES
from deros.live.snapshots import SeenParameter
from deros.models.common import Value
from deros.models.composition import usual_class
from deros.models.node import Parameter, PortKind
from deros.names.graph_names import resolve_name

_TOPICS = (PortKind.PUBLISHER, PortKind.SUBSCRIPTION)
_SERVERS = {PortKind.CLIENT: PortKind.SERVICE, PortKind.ACTION_CLIENT: PortKind.ACTION}
_NOWHERE = Span(SourceFile("", ""), 0, 0)


def files(graph: ImportedGraph, name: str) -> dict[str, Parts]:
    """Return the files of an imported graph by path, the system first."""
    described = {f"nodes/{each.name}.rnd": _node_file(each) for each in graph.types}
    return {f"{name}.system": system_file(graph, name)} | described


# Node types -------------------------------------------------------------------------------------


def _node_file(node: ImportedType) -> Parts:
    why = "A running graph shows no package and no program: write the right ones here."
    if node.is_component:
        why = "A running graph shows no package and no class: write the right ones here."
    parameters: list[str] = []
    if node.parameters is None:
        parameters.append("parameters open  // the node did not say which it has")
    elif node.parameters:
        parameters = ["parameters", *map(_declaration, node.parameters)]
    text = body(
        lifecycle=node.is_managed,
        parameters=parameters,
        ports=[(port.kind, port_line(*port)) for port in node.ports],
        left_out=map(_comment, node.left_out),
    )
    plugin = usual_class(UNKNOWN_PACKAGE, node.name) if node.is_component else ""
    return Parts(head(node.name, UNKNOWN_PACKAGE, node.name, why, plugin=plugin), text)


def _comment(left_out: LeftOut) -> str:
    return f"{left_out.what} {left_out.why}"


def _declaration(seen: SeenParameter) -> str:
    parameter = Parameter(
        seen.name,
        seen.type,
        None,
        _NOWHERE,
        _NOWHERE,
        interval=seen.interval,
        read_only=seen.read_only,
        description=seen.description,
    )
    return f"  {parameter_line(parameter)}"


# The system -------------------------------------------------------------------------------------


def system_file(graph: ImportedGraph, name: str) -> Parts:
    """Return the system that the nodes of a graph form; it imports their types from ``nodes``."""
    imports = (
        '\nimports\n  import "nodes/*.rnd"\n'
        if any(not each.is_container for each in graph.nodes)
        else ""
    )
    head = f"system {name}\n{imports}"
    topics = list(_topics(graph))
    blocks = ["\n".join(["topics", *topics])] if topics else []
    by_namespace: dict[str, list[ImportedNode]] = {}
    for node in graph.nodes:
        by_namespace.setdefault(node.seen.namespace, []).append(node)
    taken = {node.seen.name for node in by_namespace.get("/", ())}
    managers = _managers(graph)
    for namespace, nodes in sorted(by_namespace.items()):
        blocks += _group(namespace, nodes, managers, taken)
    return Parts(head, "\n\n".join(blocks) + "\n")


def _group(
    namespace: str, nodes: list[ImportedNode], managers: dict[str, str], taken: set[str]
) -> Iterator[str]:
    """Yield the nodes of a namespace, in a subsystem unless it is the root."""
    indent = "" if namespace == "/" else "  "
    inside: dict[str, list[ImportedNode]] = {each.seen.full_name: [] for each in nodes}
    beside = [each for each in nodes if each.container not in inside]
    for each in nodes:
        if each.container in inside:
            inside[each.container].append(each)
    written = [
        "\n".join(
            f"{indent}{line}" if line else ""
            for line in (
                _container(node, inside[node.seen.full_name], managers)
                if node.is_container
                else _instance(node, managers, node.container)
            )
        )
        for node in beside
    ]
    if namespace == "/":
        yield from written
        return
    name = "_".join(namespace.split("/")[1:])
    while name in taken:
        name += "_"
    taken.add(name)
    yield "\n".join([f"subsystem {name} namespace {namespace} {{", "\n\n".join(written), "}"])


def _container(
    node: ImportedNode, components: list[ImportedNode], managers: dict[str, str]
) -> Iterator[str]:
    """Yield a container with the components that are in its namespace."""
    yield f"container {node.seen.name} {{"
    for number, each in enumerate(components):
        if number:
            yield ""
        yield from (f"  {line}" for line in _instance(each, managers, None))
    yield "}"


def _instance(node: ImportedNode, managers: dict[str, str], container: str | None) -> Iterator[str]:
    """Yield a node; ``container`` is that in whose braces it does not stand."""
    seen = node.seen
    line = f"node {seen.name} : {node.type.name}"
    if container is not None:
        line += f" into {container}"
    if seen.lifecycle is not None:
        if manager := managers.get(seen.full_name):
            line += f" activated by {manager}"
        line += f"  // it was {seen.lifecycle}"
    yield line
    if node.values:
        yield "parameters"
        yield from (
            f"  param {parameter_name(name)} = {_set(value)}" for name, value in node.values
        )
    wirings = list(_wirings(node))
    if wirings:
        yield "wirings"
        yield from wirings


def _set(value: Value) -> str:
    """Return a value as a system writes it, where ``${`` begins an argument."""
    return value_text(value).replace("${", "$${")


def _wirings(node: ImportedNode) -> Iterator[str]:
    own = node.seen
    names = [port.name for port in node.type.ports]
    for port in node.type.ports:
        target = node.renamed.get((port.kind, port.name))
        if port.kind in _SERVERS.values() and target is None:
            continue
        target = target or resolve_name(port.name, own.namespace, own.name)
        yield f"  connect {wired(port.kind, port.name, names)} to {target}"


def _managers(graph: ImportedGraph) -> dict[str, str]:
    """Return the managed nodes that another node has a client for, and that node."""
    clients = {
        end.name: node.seen.full_name
        for node in reversed(graph.nodes)
        for end in node.ends
        if end.kind is PortKind.CLIENT
    }
    return {
        node.seen.full_name: clients[service]
        for node in graph.nodes
        if node.seen.lifecycle is not None
        and (service := f"{node.seen.full_name}/change_state") in clients
    }


def _topics(graph: ImportedGraph) -> Iterator[str]:
    """Yield the declarations: topics, and what is reached outside of the model."""
    outside = _outside(graph)
    publishers: dict[str, list[str]] = {}
    subscriptions: dict[str, list[str]] = {}
    for node in graph.nodes:
        for end in node.ends:
            if end.kind in _TOPICS:
                ends = publishers if end.kind is PortKind.PUBLISHER else subscriptions
                ends.setdefault(end.name, []).append(end.type)
    for name in sorted(publishers.keys() | subscriptions.keys() | outside):
        known = {*publishers.get(name, ()), *subscriptions.get(name, ())}
        both = name in publishers and name in subscriptions
        external = "" if both and name not in outside else "external "
        pin = f" : {interface_type(min(known)).short}" if len(known) == 1 else ""
        several = " publishers any" if len(publishers.get(name, ())) > 1 else ""
        yield f"  {external}topic {name}{pin}{several}"


def _outside(graph: ImportedGraph) -> set[str]:
    """Return the services and actions that a server outside of the model has, or that activates."""
    served = {
        (end.kind, end.name)
        for node in graph.nodes
        for end in node.ends
        if end.kind in _SERVERS.values()
    }
    for node in graph.nodes:
        own = {**OF_EVERY_NODE, **(OF_MANAGED_NODES if node.type.is_managed else {})}
        served |= {(PortKind.SERVICE, f"{node.seen.full_name}/{name}") for name in own}
    called = {
        end.name
        for node in graph.nodes
        for end in node.ends
        if end.kind in _SERVERS and (_SERVERS[end.kind], end.name) not in served
    }
    managers = _managers(graph)
    return called | {
        f"{node.seen.full_name}/change_state"
        for node in graph.nodes
        if node.seen.lifecycle is not None and node.seen.full_name not in managers
    }
