"""Checks of the nodes that read what a gate publishes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.models.node import PortKind
from deros.models.rules import Rules
from deros.systems.flat import FlatSystem
from deros.systems.safety_nodes import is_safety_node
from deros.validators.safety.safety_wiring import gates_of
from deros.validators.wiring.graph import End


def check_gate_readers(flat: FlatSystem, programs: Sequence[Rules]) -> Iterator[Diagnostic]:
    """Yield each reader of a gate whose description does not say that silence stops it.

    A gate that has ended, or whose host or network has failed, commands nothing, not even zero. The
    rules state what safety nodes and further gates do then. Of a system that is used several times,
    a reader is reported once.
    """
    gates = gates_of(flat, programs)
    ours = {id(node) for node, _ in gates}
    by_target = {end.topic: End(node, end) for node, end in reversed(gates)}
    reported: set[tuple[int, str]] = set()
    for node in flat.nodes if by_target else ():
        if node.type is None or id(node) in ours or is_safety_node(node.type):
            continue
        for port in node.ports:
            gate = by_target.get(port.topic)
            key = (id(node.instance), port.port.name)
            if gate is None or port.port.kind is not PortKind.SUBSCRIPTION or key in reported:
                continue
            if port.port.stops_after_ns is None:
                reported.add(key)
                yield _keeps_going(End(node, port), gate)


def _keeps_going(reader: End, gate: End) -> Diagnostic:
    there, here = reader.node.host, gate.node.host
    at_reader, at_gate = (f" on host '{host}'" if there != here else "" for host in (there, here))
    return report(
        codes.GATE_READER_KEEPS_GOING,
        # Without namespaces: it is the same finding in a system and in those that contain it.
        f"'{reader.node.instance.name}'{at_reader} reads the commands of the gate"
        f" '{gate.node.instance.name}'{at_gate}, and its description does not say that it stops"
        " when they cease, as they do where the gate, its host or the network fails",
        reader.span,
        f"if it does stop, write so at '{reader.port.port.name}' in the description of its node,"
        " as in 'stops after 0.5 sec'",
        (
            Related(reader.port.port.span, "its subscription is declared here"),
            Related(gate.span, "the gate"),
        ),
    )
