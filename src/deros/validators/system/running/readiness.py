"""Checks of what programs wait for in the ROS graph, in a system that stands on its own."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.starting import Ready
from deros.names.names import did_you_mean, near
from deros.systems.flat import FlatLaunch, FlatNode, FlatProcess, FlatSystem
from deros.systems.running.readiness import StartOrder
from deros.systems.running.starting import awaited_programs
from deros.validators.system.running.activation import activated_nodes, is_activated

_ACTION_PART = "/_action/send_goal"


def check_readiness(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the programs that wait for a name that nothing provides, or a node never active."""
    waiting = [
        (each, each.instance.starting.ready)
        for each in flat.programs
        if not isinstance(each, FlatLaunch) and each.instance.starting.ready is not None
    ]
    # A node of unknown type may provide anything, and activate any other.
    if not waiting or any(each.type is None for each in flat.nodes):
        return
    order = StartOrder(flat)
    activated = activated_nodes(flat)
    reported: set[Span] = set()
    for program, ready in waiting:
        # Of a system that is used several times, each instance would say the same.
        if ready is None or program.instance.name_span in reported:
            continue
        found = (
            [*_never_active(program, ready, order, activated)]
            if ready.names_program
            else [*_unprovided(program, ready, order, flat)]
        )
        if found:
            reported.add(program.instance.name_span)
        yield from found


def _never_active(
    program: FlatNode | FlatProcess, ready: Ready, order: StartOrder, activated: set[str]
) -> Iterator[Diagnostic]:
    found = awaited_programs(program.path, ready.name, order.known)
    node = found[0] if len(found) == 1 else None
    if ready.kind != "active" or not isinstance(node, FlatNode):
        return
    is_managed = node.type is not None and node.type.lifecycle
    # A launch file may bring its nodes to active by events, and a program those of its process.
    if not is_managed or node.launch or node.process or is_activated(node, activated):
        return
    yield report(
        codes.NEVER_READY,
        f"'{program.instance.name}' is started when '{ready.name}' is active, but nothing brings"
        " that to active",
        ready.span,
        f"write 'autostart' behind the type of '{ready.name}', or 'activated by NODE'",
        (Related(node.instance.name_span, f"'{ready.name}'"),),
    )


def _unprovided(
    program: FlatNode | FlatProcess, ready: Ready, order: StartOrder, flat: FlatSystem
) -> Iterator[Diagnostic]:
    name, providers = program.awaited_end, order.providers
    is_external = any(each.name == name and each.declaration.external for each in flat.topics)
    # The nodes of a launch file are not all known.
    has_launch_files = any(isinstance(each, FlatLaunch) for each in flat.others)
    if is_external or has_launch_files or (ready.kind, name) in providers:
        return
    names = {other for kind, other in providers if kind == ready.kind}
    hint = (
        did_you_mean(near(name, names), ready.name, name)
        or f"if it is outside the model, declare 'external topic {name}'"
    )
    if ready.kind == "service" and ("service", f"{name}{_ACTION_PART}") in providers:
        hint = f"that is an action: write 'after service {name}{_ACTION_PART}'"
    does = "has the service" if ready.kind == "service" else "publishes the topic"
    yield report(
        codes.UNPROVIDED_NAME,
        f"'{program.instance.name}' is started when the {ready.kind} '{name}' is there, but no node"
        f" {does}",
        ready.name_span,
        hint,
    )
