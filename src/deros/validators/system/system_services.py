"""Checks of services and actions: clients without a server, and of another type than it.

Types of the described ends, and unwired ports, are checked together with those of topics
(:mod:`deros.validators.system.system_topics`): a service joins its ends by name as a topic does.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.interfaces.standard_services import OF_EVERY_NODE, OF_MANAGED_NODES
from deros.systems.flat import FlatNode, FlatSystem
from deros.validators.wiring.topic_channels import Channel

if TYPE_CHECKING:
    from deros.interfaces.types import InterfaceType


def check_services(flat: FlatSystem, channels: Iterable[Channel]) -> Iterator[Diagnostic]:
    """Yield the findings about the services and actions among the channels of a system."""
    nodes = {node.full_name: node for node in flat.nodes}
    for channel in channels:
        if channel.vertex[0] != "topic":
            yield from _missing_server(channel, nodes)


def _missing_server(channel: Channel, nodes: Mapping[str, FlatNode]) -> Iterator[Diagnostic]:
    if channel.sinks or channel.open:
        return
    name = channel.name
    owner, _, service = name.rpartition("/")
    node = nodes.get(owner) if channel.vertex[0] == "service" else None
    if node is not None and node.type is None:
        return  # whether it is a managed node is unknown
    served = _own_service(node, service) if node is not None else None
    for end in channel.sources:
        if served is not None:
            if end.type != served:
                yield report(
                    codes.TYPE_MISMATCH,
                    f"'{name}' joins two types: {end.name} has {end.type.short}, "
                    f"'{owner}' serves {served.short} like every node of its kind",
                    end.span,
                    related=(Related(end.port.port.type_span, "the client is declared here"),),
                )
        elif end.wired and not _is_checked_with_rules(end.node):
            yield report(
                codes.SERVICE_WITHOUT_SERVER,
                f"no node serves the {channel.vertex[0]} '{name}' that {end.name} calls",
                end.span,
                hint=f"'{owner}' is not described as 'lifecycle'"
                if node is not None and service in OF_MANAGED_NODES
                else "connect a server to that name; if it is outside the model, "
                f"declare 'external topic {name}'",
                related=(Related(end.port.port.span, "the client is declared here"),),
            )


def _is_checked_with_rules(node: FlatNode) -> bool:
    """Return whether a node is made from rules that use a system, whose check says the same."""
    rules = node.statement.rules if node.statement is not None else None
    return rules is not None and bool(rules.uses)


def _own_service(node: FlatNode, service: str) -> InterfaceType | None:
    """Return the type of a service that a node has without describing it, or ``None``."""
    if node.type is not None and node.type.lifecycle and service in OF_MANAGED_NODES:
        return OF_MANAGED_NODES[service]
    return OF_EVERY_NODE.get(service)
