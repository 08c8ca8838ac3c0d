"""Remapping rules of ROS 2 that connect the ports of a node as wired.

A rule ``NAME:=TARGET`` gives the name ``TARGET`` to every topic and every service that the node's
code calls ``NAME``; ``rostopic://NAME:=TARGET`` does so for topics alone, ``rosservice://…`` for
services alone. No rule distinguishes the two ends of a topic, or those of a service. Source: ROS 2
design, "Remapping Names"; ``rcl/src/rcl/remap.c``. An action consists of services and topics (ROS 2
design, "Actions"); later versions of rcl than Jazzy's remap its own name as a topic's.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.models.node import NodeType, Port, PortKind
from deros.models.system import Wiring
from deros.systems.flat import FlatNode, FlatPort

Scheme = Literal["rostopic", "rosservice"]

ACTION_SERVICES = ("send_goal", "cancel_goal", "get_result")
ACTION_TOPICS = ("feedback", "status")
ACTION_KINDS = (PortKind.ACTION, PortKind.ACTION_CLIENT)
_SERVICE_KINDS = (PortKind.SERVICE, PortKind.CLIENT)


def wired_ends(node_type: NodeType, wiring: Wiring) -> list[tuple[Port | None, str | None]]:
    """Return the ports that a wiring connects, each with the parameter that gives it its name.

    Without a port of that name, it is the name of a parameter.
    """
    ports = node_type.ports_named(wiring.port, wiring.kind)
    if not ports and wiring.kind is None:
        return [(None, wiring.port)]
    return [(port, port.via) for port in ports]


def scheme_of(kind: PortKind) -> Scheme:
    """Return the prefix of a rule that applies to ports of this kind only."""
    return "rosservice" if kind in _SERVICE_KINDS else "rostopic"


def conflicts(ports: Sequence[FlatPort]) -> Iterator[tuple[FlatPort, FlatPort]]:
    """Yield the pairs of ports that one rule would remap together, unlike the model.

    The first of a pair is the port that is declared first.
    """
    first: dict[tuple[Scheme, str], tuple[FlatPort, str]] = {}
    reported: set[int] = set()
    for port in ports:
        for scheme, name, target in _names(port):
            other, elsewhere = first.setdefault((scheme, name), (port, target))
            if target != elsewhere and id(port) not in reported:
                reported.add(id(port))
                yield other, port


def _names(port: FlatPort) -> Iterator[tuple[Scheme, str, str]]:
    """Yield every name that the port requests, as topic or service, with its target."""
    kind, name, target = port.port.kind, port.requested, port.topic
    yield scheme_of(kind), name, target
    if kind in ACTION_KINDS:
        for part in ACTION_SERVICES:
            yield "rosservice", f"{name}/_action/{part}", f"{target}/_action/{part}"
        for part in ACTION_TOPICS:
            yield "rostopic", f"{name}/_action/{part}", f"{target}/_action/{part}"


def remappings(ports: Sequence[FlatPort]) -> tuple[tuple[str, str], ...]:
    """Return the rules for the ports that are wired, as pairs of the port's own name and a target.

    A rule is for topics or for services alone where a port of the other sort has the same name and
    goes elsewhere. The parts of actions are left to the targets. Without :func:`conflicts`, the
    rules do what the model says.
    """
    wanted: dict[str, dict[Scheme, str]] = {}
    for port in ports:
        wanted.setdefault(port.requested, {}).setdefault(scheme_of(port.port.kind), port.topic)
    rules: dict[str, str] = {}
    for port in ports:
        if port.wiring is None or port.sets_parameter:
            continue
        apart = len(set(wanted[port.requested].values())) > 1
        # A port `via` a parameter that a group remaps asks for the name in the parameter.
        name = port.port.name if port.port.via is None else port.requested
        rules[f"{scheme_of(port.port.kind)}://{name}" if apart else name] = port.topic
    return tuple(rules.items())


# What no rule can do ------------------------------------------------------------------------------


def wired_apart(node: FlatNode) -> Iterator[Diagnostic]:
    """Yield a finding for each port whose wiring conflicts with that of another port."""
    yield from _one_parameter(node)
    for first, second in conflicts(node.ports):
        one, other = _called(first), _called(second)
        wiring = second.wiring or first.wiring
        yield report(
            codes.WIRED_APART,
            f"{one} and {other} of '{node.instance.name}' cannot be on '{first.topic}' and"
            f" '{second.topic}': both are called '{second.requested}' by the node, and a remapping"
            " of that name moves both",
            wiring.span if wiring is not None else node.instance.name_span,
            "connect both to one name, or have the node take one of the names from a string"
            " parameter ('via')",
            (
                Related(first.port.name_span, f"{one} is declared here"),
                Related(second.port.name_span, f"{other} is declared here"),
            ),
        )


def _called(port: FlatPort) -> str:
    return f"{port.port.kind.word} '{port.port.name}'"


def _one_parameter(node: FlatNode) -> Iterator[Diagnostic]:
    """Yield ports that take their names from one parameter, but have different topics."""
    if node.type is None:
        return
    by_parameter = {port.port.via: port for port in node.ports if port.sets_parameter}
    for wiring in node.instance.wirings:
        for _, parameter in wired_ends(node.type, wiring):
            first = by_parameter.get(parameter)
            if first is None or first.wiring is None or first.wiring.target == wiring.target:
                continue
            yield report(
                codes.WIRED_APART,
                f"'{wiring.port}' and '{first.wiring.port}' of '{node.instance.name}' both take"
                f" their names from parameter '{parameter}', and are connected to"
                f" '{wiring.target}' and '{first.wiring.target}'",
                wiring.span,
                "connect both to one name, or declare a parameter for each",
                (Related(first.wiring.span, "the other connection"),),
            )
            break
