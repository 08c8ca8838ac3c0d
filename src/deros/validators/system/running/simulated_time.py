"""Checks of simulated time: all nodes of a system use it or none, and something publishes it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.common import Value
from deros.models.node import PortKind
from deros.systems.flat import FlatNode, FlatSystem
from deros.validators.findings.hints import SHOWN

_SWITCH = "use_sim_time"
_CLOCK = "/clock"


def check_simulated_time(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the finding that a system runs in two times, or in a time that never begins.

    Nodes that publish ``/clock`` are left out: a simulator makes the time that the others use. So
    are containers, which ask for no time.
    """
    clocks = [node for node in flat.nodes if _publishes_clock(node)]
    others = [node for node in flat.nodes if not node.instance.is_container]
    nodes = [node for node in others if node not in clocks]
    simulated = [node for node in nodes if _is_simulated(node)]
    real = [node for node in nodes if not _is_simulated(node)]
    is_published = bool(clocks) or any(
        topic.name == _CLOCK and topic.declaration.external for topic in flat.topics
    )
    if not simulated or (is_published and not real):
        return
    times = f"simulated time: {_listed(simulated)}"
    hints = []
    if real:
        times += f"; real time: {_listed(real)}"
        hints.append(f"set '{_SWITCH}' to one value for all nodes")
    if not is_published:
        times += f"; no node publishes '{_CLOCK}', without which simulated time does not begin"
        hints.append(f"where a simulator outside does, declare 'external topic {_CLOCK}'")
    yield report(
        codes.SIMULATED_TIME,
        f"the nodes of the system use {times}",
        _switch(simulated[0]),
        "; ".join(hints),
        tuple(Related(node.instance.name_span, "it uses real time") for node in real[:SHOWN]),
    )


def _publishes_clock(node: FlatNode) -> bool:
    return any(end.topic == _CLOCK and end.port.kind is PortKind.PUBLISHER for end in node.ports)


def _is_simulated(node: FlatNode) -> bool:
    """Return whether a node uses simulated time, as the system or else its description says."""
    declared = node.type.parameter(_SWITCH) if node.type is not None else None
    default: Value | None = declared.default if declared is not None else None
    return dict(node.parameters).get(_SWITCH, default) is True


def _switch(node: FlatNode) -> Span:
    """Return where a node is told to use simulated time."""
    settings = (each.span for each in node.instance.parameters if each.name == _SWITCH)
    return next(settings, node.instance.name_span)


def _listed(nodes: Sequence[FlatNode]) -> str:
    """Return the names of some nodes, of many the first ones."""
    names = ", ".join(f"'{node.full_name}'" for node in nodes[:SHOWN])
    return f"{names} and {len(nodes) - SHOWN} more" if len(nodes) > SHOWN else names
