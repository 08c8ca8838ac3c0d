"""The graph of a system that runs exactly as its model says, as a snapshot shows it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from deros.live.snapshots import End, SeenNode, SeenParameter, Snapshot
from deros.models.common import QosProfile, Value
from deros.models.node import ParameterType, PortKind, as_double
from deros.models.qos import policies
from deros.systems.flat import FlatNode, FlatSystem

_TOPICS = (PortKind.PUBLISHER, PortKind.SUBSCRIPTION)


def graph_of(flat: FlatSystem) -> Snapshot:
    """Return the snapshot of a system that is started, with the defaults of its nodes."""
    loaded: dict[str, list[str]] = {}
    for each in flat.nodes:
        loaded.setdefault(each.container or "", []).append(each.full_name)
    nodes = (_node(each, sorted(loaded.get(each.full_name, ()))) for each in flat.nodes)
    return Snapshot(tuple(sorted(nodes, key=lambda each: each.full_name)))


def changed(seen: Snapshot, name: str, change: Callable[[SeenNode], SeenNode]) -> Snapshot:
    """Return a snapshot in which one node, which has to be there, is another one."""
    assert name in {each.full_name for each in seen.nodes}
    nodes = (change(each) if each.full_name == name else each for each in seen.nodes)
    return replace(seen, nodes=tuple(nodes))


def without(seen: Snapshot, name: str) -> Snapshot:
    """Return a snapshot without a node, which has to be there."""
    assert name in {each.full_name for each in seen.nodes}
    return replace(seen, nodes=tuple(each for each in seen.nodes if each.full_name != name))


def profile(qos: QosProfile | None) -> QosProfile:
    """Return what a graph shows of a profile: all policies but history and depth."""
    found = policies(qos)
    return QosProfile(
        reliability=found.reliability,
        durability=found.durability,
        deadline_ns=found.deadline,
        lifespan_ns=found.lifespan,
        liveliness=found.liveliness,
        lease_ns=found.lease,
    )


def parameter(name: str, kind: ParameterType, value: Value) -> SeenParameter:
    """Return a parameter as a node has it: an integer of a double parameter is a double."""
    return SeenParameter(name, kind, as_double(value, kind))


def _node(node: FlatNode, loaded: Sequence[str]) -> SeenNode:
    assert node.type is not None
    ends = tuple(
        End(
            each.port.kind,
            each.topic,
            str(each.port.type),
            profile(each.port.qos) if each.port.kind in _TOPICS else None,
        )
        for each in node.ports
    )
    values = {each.name: each.default for each in node.type.parameters if not each.keys}
    values |= dict(node.parameters)
    kinds = {name: node.type.parameter_for(name) for name in values}
    parameters = tuple(
        parameter(name, kind.type, value)
        for name, value in sorted(values.items())
        if value is not None and (kind := kinds[name]) is not None
    )
    simulated = dict(node.parameters).get("use_sim_time", False)
    parameters += (parameter("use_sim_time", ParameterType.BOOL, simulated),)
    is_up = node.autostart is not None or node.instance.activated_by is not None
    state = ("active" if is_up else "unconfigured") if node.type.lifecycle else None
    is_container = node.instance.is_container
    components = tuple(loaded) if is_container else None
    return SeenNode(
        node.full_name, ends, parameters, state, container=is_container, components=components
    )
