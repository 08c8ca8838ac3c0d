"""Checks of managed nodes: each is silent until another node brings it to active."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.interfaces.standard_services import OF_MANAGED_NODES
from deros.models.node import NodeType, PortKind
from deros.names.graph_names import resolve_name
from deros.systems.flat import LISTED_NODES, FlatNode, FlatSystem, listed_nodes
from deros.systems.running.autostart import manager_of
from deros.validators.findings.hints import did_you_mean

if TYPE_CHECKING:
    from deros.diagnostics import Span

_CHANGE_STATE = "change_state"

_WRITE_NODE = "write the name of the node that brings it to active"


def check_activation(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield a finding for each managed node that nothing brings to active.

    A node is activated by the start of the system, where it has ``autostart``, by the node that
    ``activated by`` names, by a client of its service ``change_state``, by a manager that lists it
    in ``node_names``, from outside, where the system declares that service an ``external topic``,
    or by the process that it is a part of.
    """
    nodes = {node.full_name: node for node in flat.nodes}
    activated = activated_nodes(flat)
    programs = _running_programs(flat, activated)
    # A node of unknown type may be the manager of any other; that the type is unknown is reported.
    is_complete = not any(n.type is None and n.statement is None for n in flat.nodes)
    reported: set[Span] = set()
    for node in flat.nodes:
        # Of a system that is used several times, each instance would say the same.
        if node.type is None or node.instance.name_span in reported:
            continue
        found = list(_unfitting(node, node.type, nodes))
        if is_complete and node.type.lifecycle and not is_activated(node, activated):
            # A launch file may bring its nodes to active by events, which no model shows, and a
            # program those of its own process.
            found += (
                [] if node.launch or node.process else _never_activated(node, node.type, programs)
            )
        if found:
            reported.add(node.instance.name_span)
        yield from found


def activated_nodes(flat: FlatSystem) -> set[str]:
    """Return the full names of the nodes that something in the system, or outside, activates."""
    return set(_activated(flat))


def is_activated(node: FlatNode, activated: set[str]) -> bool:
    """Return whether a node is among those, or says itself how it is activated."""
    stated = node.instance.activated_by is not None or node.autostart is not None
    return stated or node.full_name in activated


def _activated(flat: FlatSystem) -> Iterator[str]:
    """Yield the full names of the nodes that something in the system, or outside, activates."""
    for topic in flat.topics:
        if topic.declaration.external:
            yield from _owner(topic.name)
    for node in flat.nodes:
        for end in node.ports:
            is_client = end.port.kind is PortKind.CLIENT
            if is_client and end.port.type == OF_MANAGED_NODES[_CHANGE_STATE]:
                yield from _owner(end.topic)
        for name in listed_nodes(node):
            yield resolve_name(name, node.namespace)


def _running_programs(flat: FlatSystem, activated: set[str]) -> dict[str, set[str]]:
    """Return the programs whose nodes run without further ado, each with the packages it is of."""
    programs: dict[str, set[str]] = {}
    for node in flat.nodes:
        if node.type is None:
            continue
        if not node.type.lifecycle or is_activated(node, activated):
            programs.setdefault(node.type.executable_name, set()).add(node.type.package)
    return programs


def _is_part(node_type: NodeType, programs: dict[str, set[str]]) -> bool:
    """Return whether a node is part of a process that another package's program is.

    Plug-ins are described so: a controller has its own package, and ``ros2_control_node`` for a
    program, which loads and activates it. Two nodes of one package are two processes.
    """
    packages = programs.get(node_type.executable or "", set())
    return bool(packages - {node_type.package})


def _owner(service: str) -> Iterator[str]:
    """Yield the node whose state a service changes."""
    node, _, name = service.rpartition("/")
    if name == _CHANGE_STATE:
        yield node


def _unfitting(
    node: FlatNode, node_type: NodeType, nodes: dict[str, FlatNode]
) -> Iterator[Diagnostic]:
    """Yield what is wrong with the node's ``activated by``."""
    name, span = node.instance.activated_by, node.instance.activated_by_span
    if name is None or span is None:
        return
    manager = manager_of(node, nodes)
    if not node_type.lifecycle:
        yield report(
            codes.UNKNOWN_MANAGER,
            f"'{node.full_name}' is not a managed node: nothing has to activate it",
            span,
            f"write 'lifecycle' in the description of '{node_type.name}', or remove 'activated by'",
            (Related(node_type.name_span, "described here, without 'lifecycle'"),),
        )
    elif manager is None:
        others = [other for other in nodes if other != node.full_name]
        if not name.startswith("/"):
            others = [other.rpartition("/")[2] for other in others]
        yield report(
            codes.UNKNOWN_MANAGER,
            f"no node of the system is called '{name}', which is to activate '{node.full_name}'",
            span,
            did_you_mean(name, others, _WRITE_NODE),
        )
    elif manager is node:
        yield report(
            codes.UNKNOWN_MANAGER,
            f"'{node.full_name}' is to activate itself",
            span,
            _WRITE_NODE,
        )


def _never_activated(
    node: FlatNode, node_type: NodeType, programs: dict[str, set[str]]
) -> Iterator[Diagnostic]:
    """Yield that a node stays unconfigured, unless it is part of one of the running programs."""
    if _is_part(node_type, programs):
        return
    service = f"{node.full_name}/{_CHANGE_STATE}"
    yield report(
        codes.NEVER_ACTIVATED,
        f"nothing activates the managed node '{node.full_name}': it starts unconfigured, and"
        " neither publishes nor reacts until another node brings it to active",
        node.instance.name_span,
        "write 'autostart' behind its type to activate it at the start of the system, or 'activated"
        f" by NODE' if another node does; or list it in the parameter '{LISTED_NODES}'"
        " of a lifecycle manager; if it is activated from outside the model, declare"
        f" 'external topic {service}'",
        (Related(node_type.name_span, "it is described as 'lifecycle' here"),),
    )
