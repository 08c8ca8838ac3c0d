"""What launch cannot do with containers: fill one again, and tell when it is filled later."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Span, report
from deros.generators.system.expanded import programs_in
from deros.generators.system.view import SystemView
from deros.models.system import System
from deros.systems.flat import FlatNode


def refilled(model: System, view: SystemView) -> Iterator[Diagnostic]:
    """Yield the containers with nodes that are to be started again when they end.

    launch_ros loads nodes once. It would start an empty container, and a request that is sent while
    the graph still shows the one that was killed is never answered.
    """
    containers = (node for node in view.nodes if node.address is not None)
    if all(node.respawn_delay is None for node in containers):
        return  # as nearly always: to expand the model once more would take as long as the view
    nodes = [each for each in programs_in(model) if isinstance(each, FlatNode)]
    filled = {node.container for node in nodes}
    reported: set[Span] = set()
    for node in nodes:
        name = node.instance.name_span
        if node.instance.respawn is None or node.full_name not in filled or name in reported:
            continue
        reported.add(name)
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"launch would start container '{node.instance.name}' again without its nodes",
            name,
            "start the system with 'deros up' or the script, or leave 'respawn' out",
        )


def late_managed(model: System, view: SystemView) -> Iterator[Diagnostic]:
    """Yield the nodes that are to be brought to active in containers that are started later.

    A node that waits for its turn does so from the start on, and launch has no event for the moment
    at which a container has a node.
    """
    late = any(node.address is not None and node.starting.is_later for node in view.nodes)
    if not late or not any(node.container and node.autostart for node in view.nodes):
        return
    nodes = [each for each in programs_in(model) if isinstance(each, FlatNode)]
    later = {node.full_name for node in nodes if node.instance.starting.is_later}
    reported: set[Span] = set()
    for node in nodes:
        name = node.instance.name_span
        if node.autostart is None or node.container not in later or name in reported:
            continue
        reported.add(name)
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"launch would bring '{node.instance.name}' to active ('autostart') before its"
            f" container '{node.container}' is started",
            name,
            "start the system with 'deros up' or the script, or leave out 'delay' and 'after exit"
            " of' at the container",
        )
