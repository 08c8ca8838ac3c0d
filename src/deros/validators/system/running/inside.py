"""Checks of nodes in the processes of others: whose these are, and what the nodes can be told."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.composition import Inside
from deros.models.system import NodeInstance, System
from deros.systems.flat import FlatLaunch, FlatNode, FlatProcess, FlatSystem
from deros.systems.groups import groups_of, members_of
from deros.systems.running.processes import NodePlace, owner_places
from deros.validators.findings.hints import did_you_mean, one_of

# As written ---------------------------------------------------------------------------------------


def check_own_names(system: System) -> Iterator[Diagnostic]:
    """Yield the nodes that are loaded into a container, which names them, and have own names."""
    for _, group in groups_of(system):
        for node in members_of(group):
            if not isinstance(node, NodeInstance) or node.own_name is None:
                continue
            if node.into is not None and node.into.when is None:
                yield report(
                    codes.NOT_OF_COMPOSED_NODE,
                    f"'{node.name}' is loaded into a container, which gives it its name",
                    node.own_name,
                    "remove 'own_name': what is loaded is called as the system says",
                    (Related(node.into.container_span, "loaded here"),)
                    if node.into.braces is None
                    else (),
                )


# At run time --------------------------------------------------------------------------------------

_Program = FlatNode | FlatProcess


def check_inside(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the nodes that can be in no process of that name, or not be told from others there."""
    nodes = [node for node in flat.nodes if node.instance.inside is not None]
    if not nodes:
        return
    owners: dict[NodePlace, _Program] = {
        (each.path, each.instance.name_span): each for each in flat.nodes if each.statement is None
    }
    owners |= {(each.path, each.instance.name_span): each for each in flat.processes}
    containers = {each.full_name for each in flat.nodes if each.instance.is_container}
    reported: set[Span] = set()
    for node in nodes:
        inside = node.instance.inside
        assert inside is not None
        found = [*_unfit_owner(node, inside, owners, containers, flat), *_made_by_xacro(node)]
        # Of one statement, and of a system that is used several times, each would say the same.
        yield from (each for each in found if each.span not in reported)
        reported.update(each.span for each in found)
    for program in owners.values():
        if program.inside:
            yield from _alike(program)


def _unfit_owner(
    node: FlatNode,
    inside: Inside,
    owners: dict[NodePlace, _Program],
    containers: set[str],
    flat: FlatSystem,
) -> Iterator[Diagnostic]:
    if not inside.owners:
        yield _unknown(node, inside, flat)
    for place in owner_places(node):
        owner = owners.get(place)
        if not isinstance(owner, FlatNode):
            continue
        outer = owner.instance.inside
        name = owner.instance.name
        if outer is not None:
            yield report(
                codes.NOT_A_PROCESS,
                f"'{name}' has no process of its own: it is inside '{outer.process}'",
                inside.process_span,
                f"write 'inside {outer.process}' around all nodes of that process",
                (Related(owner.instance.name_span, f"'{name}'"),),
            )
        elif owner.container is not None and owner.container not in containers:
            yield report(
                codes.NOT_A_PROCESS,
                f"'{name}' has no process of its own: it is loaded into '{owner.container}', which"
                " this system does not start",
                inside.process_span,
                f"load '{name}' into a container of the system, or leave what it makes undescribed",
                (Related(owner.instance.name_span, f"'{name}'"),),
            )


def _unknown(node: FlatNode, inside: Inside, flat: FlatSystem) -> Diagnostic:
    around = [node.path[:depth] for depth in range(len(node.path), -1, -1)]
    known = [
        each.instance.name
        for each in flat.parts
        if each.path in around
        and not isinstance(each, FlatLaunch)
        and not (isinstance(each, FlatNode) and (each.statement or each.instance.inside))
    ]
    launched = [
        each
        for each in flat.nodes
        if each.launch is not None and each.instance.name == inside.process
    ]
    hint = did_you_mean(inside.process, known, one_of(known, "there are"))
    if launched:
        hint = "that is started by a launch file: describe these nodes among its 'provides', too"
    return report(
        codes.UNKNOWN_PROCESS,
        f"no node, container or process '{inside.process}' stands in this group or in one around"
        " it",
        inside.process_span,
        hint or "write the program whose process it is beside the statement",
        tuple(Related(each.instance.name_span, "the node") for each in launched[:1]),
    )


def _made_by_xacro(node: FlatNode) -> Iterator[Diagnostic]:
    owner = node.instance.inside.process if node.instance.inside is not None else ""
    for setting in node.instance.parameters:
        if setting.xacro is not None:
            yield report(
                codes.NOT_OF_COMPOSED_NODE,
                f"'{node.instance.name}' is in the process of '{owner}', and only programs that are"
                " started get texts from xacro",
                setting.value_span,
                f"give '{owner}' the parameter, or write the text into a parameter file",
            )


def _alike(program: _Program) -> Iterator[Diagnostic]:
    """Yield nodes of one name in a process, which its rules cannot tell apart."""
    own = (program,) if isinstance(program, FlatNode) else ()
    first: dict[str, FlatNode] = {}
    for node in (*own, *program.inside):
        other = first.setdefault(node.instance.name, node)
        if other.full_name != node.full_name:  # else it is reported as such
            yield report(
                codes.ALIKE_IN_PROCESS,
                f"'{node.full_name}' and '{other.full_name}' are in one process: what is said to"
                f" '{node.instance.name}' there would be said to both",
                node.instance.name_span,
                "give one of them another name, in its program and here",
                (Related(other.instance.name_span, "the other one"),),
            )
