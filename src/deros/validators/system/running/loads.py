"""Checks of load monitors: the node that each watches is there, in a process that can be told."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.names.graph_names import from_root
from deros.systems.flat import FlatNode, FlatSystem
from deros.systems.running.monitors import WATCHED, is_load_monitor, place_of, watched_node
from deros.validators.findings.hints import SHOWN, did_you_mean, one_of


def check_loads(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the findings about the nodes whose processor load is measured."""
    monitors = [node for node in flat.nodes if is_load_monitor(node)]
    if not monitors:
        return
    nodes = {node.full_name: node for node in flat.nodes}
    for monitor in monitors:
        name = watched_node(monitor)
        if name is None:
            continue  # it has no value, or one that is reported
        place = place_of(monitor, WATCHED)
        watched = nodes.get(name)
        if watched is None:
            yield _unknown(monitor, name, place, nodes)
            continue
        there = (Related(watched.instance.name_span, f"'{watched.instance.name}'"),)
        if watched.host != monitor.host:
            yield report(
                codes.LOAD_ELSEWHERE,
                f"'{monitor.instance.name}' measures on host '{monitor.host}', and"
                f" '{watched.instance.name}' runs on '{watched.host}'",
                place,
                f"write 'on {watched.host}' at '{monitor.instance.name}'",
                there,
            )
        yield from _process(watched, place, there)


def _unknown(monitor: FlatNode, name: str, place: Span, nodes: dict[str, FlatNode]) -> Diagnostic:
    written = str(dict(monitor.parameters)[WATCHED])
    others = [each for each in nodes if each != monitor.full_name]
    if not written.startswith("/"):
        around = monitor.namespace.rstrip("/") + "/"
        others = [each.removeprefix(around) for each in others]
    return report(
        codes.LOAD_OF_UNKNOWN_NODE,
        f"no node of the system is called '{from_root(name)}', whose load"
        f" '{monitor.instance.name}' is to measure",
        place,
        did_you_mean(written, others, one_of(others, "there are"))
        or "write the name of the node whose load it is to measure",
    )


def _process(watched: FlatNode, place: Span, there: tuple[Related, ...]) -> Iterator[Diagnostic]:
    """Yield why the process of a node cannot be told by its command line, or is not its own."""
    name = watched.instance.name
    owner = watched.container or watched.process
    if owner is not None or watched.instance.inside is not None:
        inside = watched.instance.inside
        shown = from_root(owner) if owner is not None else str(inside.process if inside else "")
        yield report(
            codes.LOAD_WITHOUT_PROCESS,
            f"'{name}' has no process of its own: it is in that of '{shown}', whose load is that of"
            " all nodes in there",
            place,
            f"measure the load of '{shown}', or let '{name}' run as a process of its own",
            there,
        )
    elif watched.instance.own_name is not None:
        yield report(
            codes.LOAD_WITHOUT_PROCESS,
            f"'{name}' names itself ('own_name'), so the command line of no process has its name",
            place,
            "remove 'own_name' if it can be started with a name",
            there,
        )
    elif watched.inside:
        others = [f"'{each.instance.name}'" for each in watched.inside]
        listed = ", ".join(others[:SHOWN])
        more = f" and {len(others) - SHOWN} more" if len(others) > SHOWN else ""
        yield report(
            codes.LOAD_OF_SEVERAL_NODES,
            f"the load of '{name}' is that of its process, in which are also {listed}{more}",
            place,
            "",
            there,
        )
