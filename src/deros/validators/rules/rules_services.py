"""Checks of the services that actions call: whether the systems of the rules serve them."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.interfaces.types import InterfaceType
from deros.models.node import PortKind
from deros.models.rules import Rules
from deros.names.graph_names import resolve_name
from deros.names.names import did_you_mean
from deros.names.topic_likeness import likely_topics
from deros.rules.compiler.scope.topics import SystemTopics


def check_services(rules: Rules, topics: SystemTopics) -> Iterator[Diagnostic]:
    """Yield the services of actions that no node of the used systems serves.

    An external service has its server outside the model. A system with unknown parts proves
    nothing.
    """
    if not topics.complete:
        return
    served = _served(topics)
    for action in rules.actions:
        call = action.service
        if call is None or call.service.text.startswith("~"):
            continue
        service = resolve_name(call.service.text, "/")
        declared = topics.get(service)
        if service in served or (declared is not None and declared.external):
            continue
        meant = likely_topics(service, (n for n, kind in served.items() if kind == call.type))
        yield report(
            codes.CALL_WITHOUT_SERVER,
            f"no node in the system serves '{service}'",
            call.service.span,
            did_you_mean(meant, call.service.text, service)
            or f"if it is served outside the model, declare 'external topic {service}'",
        )


def _served(topics: SystemTopics) -> dict[str, InterfaceType]:
    return {
        port.topic: port.port.type
        for system in topics.systems
        for node in system.nodes
        for port in node.ports
        if port.port.kind is PortKind.SERVICE
    }
