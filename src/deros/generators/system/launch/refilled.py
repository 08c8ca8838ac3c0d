"""What launch cannot do with containers: fill those again that it starts again."""

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
