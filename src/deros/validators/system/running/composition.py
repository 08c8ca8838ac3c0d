"""Checks of containers: what can be loaded, into which of them, and with what."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.arguments import Expression, Interpolation
from deros.models.composition import usual_class
from deros.models.system import NodeInstance, System
from deros.systems.flat import FlatNode, FlatSystem
from deros.systems.groups import groups_of, members_of
from deros.validators.findings.hints import did_you_mean, one_of
from deros.validators.node.plugins import plugin_findings

# As written ---------------------------------------------------------------------------------------


def check_composed(system: System) -> Iterator[Diagnostic]:
    """Yield what nodes of the system's own file say in vain, whatever the arguments are."""
    for _, group in groups_of(system):
        for member in members_of(group):
            if isinstance(member, NodeInstance):
                yield from plugin_findings(member.plugin)
                yield from _in_vain(member)


def _in_vain(node: NodeInstance) -> Iterator[Diagnostic]:
    into = node.into
    if into is None:
        if node.intra_process is not None:
            yield report(
                codes.IDLE_INTRA_PROCESS,
                f"'{node.name}' is a process of its own: 'intra_process' does nothing",
                node.intra_process.span,
                "write it at nodes in a container",
            )
        return
    start = into.container_from
    if start is not None and not _is_absolute(start):
        yield report(
            codes.UNKNOWN_CONTAINER,
            "a container whose name is computed may be anywhere: its name begins with '/'",
            into.container_span,
            "write 'into \"/${...}\"', or choose between containers of the system with 'when'",
        )
    if into.when is not None:
        return  # the settings hold where the node is a process of its own
    for what, span in _of_processes(node):
        yield report(
            codes.NOT_OF_COMPOSED_NODE,
            f"'{node.name}' shares the process of its container, and has no {what} of its own",
            span,
            _HINTS.get(what, f"write it at the container '{into.container}'"),
            (Related(into.container_span, "loaded here"),) if into.braces is None else (),
        )


def _is_absolute(found: Expression) -> bool:
    first = found.pieces[0] if isinstance(found, Interpolation) else ""
    return isinstance(first, str) and first.startswith("/")


_HINTS = {
    "log level": 'give the container its level: \'arguments ["--ros-args", "--log-level",'
    ' "NODE:=debug"]\'',
    **dict.fromkeys(
        ("start ('delay')", "start ('after')", "exit"),
        "write it at the container, which is started with all in it, or take it out of there",
    ),
}


def _of_processes(node: NodeInstance) -> Iterator[tuple[str, Span]]:
    if node.respawn is not None:
        yield "respawn", node.name_span
    if node.log_level is not None:
        yield "log level", node.name_span
    for word in node.arguments[:1]:
        yield "arguments", word.span
    for variable in node.environment[:1]:
        yield "environment", variable.name_span
    if node.prefix is not None:
        yield "prefix", node.prefix.span
    starting = node.starting
    if starting.delay is not None:
        yield "start ('delay')", starting.delay.span
    if starting.after is not None:
        yield "start ('after')", starting.after.span
    if starting.ready is not None:
        yield "start ('after')", starting.ready.span
    if starting.stops_all is not None:
        yield "exit", starting.stops_all


# At run time --------------------------------------------------------------------------------------


def check_containers(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the nodes that cannot be loaded into their containers."""
    nodes = {node.full_name: node for node in flat.nodes}
    reported: set[Span] = set()
    for node in flat.nodes:
        # Of a system that is used several times, each instance would say the same.
        if node.instance.into is None or node.instance.name_span in reported:
            continue
        found = [*_unloadable(node), *_unknown(node, nodes)]
        if found:
            reported.add(node.instance.name_span)
        yield from found


def _unloadable(node: FlatNode) -> Iterator[Diagnostic]:
    node_type, into = node.type, node.instance.into
    if node_type is None or into is None or node.instance.component is not None:
        return
    package, name = node_type.package, node_type.name
    yield report(
        codes.UNCOMPOSABLE_NODE,
        f"'{name}' cannot be loaded into a container: no 'plugin' says which class of C++ it is",
        node.instance.type_span,
        f"write 'plugin \"{usual_class(package, name)}\"' in its description, with the class that"
        " is registered; a Python node is a process of its own: take it out of the container",
        (Related(node_type.name_span, "described here"),),
    )


def _unknown(node: FlatNode, nodes: dict[str, FlatNode]) -> Iterator[Diagnostic]:
    into = node.instance.into
    if into is None or into.braces is not None:
        return
    if into.is_computed:
        return  # its name is checked as it is written
    if node.container is None:
        known = {each.instance.name for each in nodes.values() if each.instance.is_container}
        yield report(
            codes.UNKNOWN_CONTAINER,
            f"the system has no container '{into.container}' for '{node.instance.name}'",
            into.container_span,
            did_you_mean(into.container, known, one_of(known, "its containers"))
            or "write 'container NAME { ... }', or the absolute name of one that runs elsewhere",
        )
        return
    target = nodes.get(node.container)
    if target is not None and not target.instance.is_container:
        yield report(
            codes.UNKNOWN_CONTAINER,
            f"'{node.container}' is not a container",
            into.container_span,
            "name a 'container', or write this node as one",
            (Related(target.instance.name_span, "the node"),),
        )
