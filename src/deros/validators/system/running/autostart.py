"""Checks of ``autostart``: it is for managed nodes, and for those that nothing else activates."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.system import NodeInstance, Subsystem, System
from deros.names.graph_names import resolve_name
from deros.systems.flat import LISTED_NODES, FlatNode, FlatSystem, listed_nodes
from deros.systems.groups import groups_of

_BY_ANOTHER = "leave out 'autostart' if another node is to activate it, or else the other"


def check_groups(system: System) -> Iterator[Diagnostic]:
    """Yield the finding that ``autostart`` stands on what has no managed node to bring up.

    Conditions are not looked at: where the managed nodes are left out, there is nothing to do.
    """
    for _, group in groups_of(system):
        if group.autostart is not None and not _has_managed(group, (system,)):
            what = "system" if group is system else "subsystem"
            yield _idle(f"{what} '{group.name}'", group.autostart.span)


def _has_managed(part: System | Subsystem, open_systems: tuple[System, ...]) -> bool:
    """Return whether there is a node to bring up, or one may be in what could not be loaded."""
    for member in part.members:
        if isinstance(member, Subsystem):
            if _has_managed(member, open_systems):
                return True
        elif member.type is None or _is_brought_up(member):
            return True
    if isinstance(part, System) or part.system_name is None:
        return False
    used = part.system
    if used is None:
        return True
    # A system that uses itself is reported as a cyclic import.
    return not any(used is one for one in open_systems) and _has_managed(
        used, (*open_systems, used)
    )


def _is_brought_up(node: NodeInstance) -> bool:
    is_managed = node.type is not None and node.type.lifecycle
    return is_managed and node.activated_by is None and node.inside is None


def _idle(what: str, span: Span) -> Diagnostic:
    return report(
        codes.UNFIT_AUTOSTART,
        f"no node of {what} is managed, or each is activated by another node: there is nothing to"
        " bring up",
        span,
        "write 'lifecycle' in the descriptions of its managed nodes, or remove 'autostart'",
    )


def check_autostart(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield a finding for each node that cannot, or need not, be brought up at the start."""
    managers = dict(_listed(flat))
    reported: set[Span] = set()
    for node in flat.nodes:
        # Of a system that is used several times, each instance would say the same.
        if node.autostart is None or node.instance.name_span in reported:
            continue
        found = list(_unfitting(node, managers.get(node.full_name)))
        if found:
            reported.add(node.instance.name_span)
        yield from found


def _listed(flat: FlatSystem) -> Iterator[tuple[str, FlatNode]]:
    """Yield the full names of the nodes that lifecycle managers list, each with its manager."""
    for node in flat.nodes:
        for name in listed_nodes(node):
            yield resolve_name(name, node.namespace), node


def _unfitting(node: FlatNode, manager: FlatNode | None) -> Iterator[Diagnostic]:
    instance = node.instance
    assert node.autostart is not None
    if node.type is not None and not node.type.lifecycle:
        yield report(
            codes.UNFIT_AUTOSTART,
            f"'{node.full_name}' is not a managed node: it runs as soon as it is started",
            node.autostart.span,
            f"write 'lifecycle' in the description of '{node.type.name}', or remove 'autostart'",
            (Related(node.type.name_span, "described here, without 'lifecycle'"),),
        )
    elif instance.activated_by is not None and instance.activated_by_span is not None:
        yield report(
            codes.ACTIVATED_TWICE,
            f"'{node.full_name}' is brought to active at the start, and also by"
            f" '{instance.activated_by}'",
            node.autostart.span,
            _BY_ANOTHER,
            (Related(instance.activated_by_span, "the other one"),),
        )
    elif manager is not None:
        own = instance.autostart is not None
        yield report(
            codes.ACTIVATED_TWICE,
            f"'{node.full_name}' is brought to active at the start, and also by the lifecycle"
            f" manager '{manager.full_name}', which lists it",
            node.autostart.span if own else instance.name_span,
            f"write 'activated by {manager.full_name}' behind its type"
            f"{', instead of autostart' if own else ''}, or remove it from '{LISTED_NODES}'",
            (Related(manager.instance.name_span, "the manager"),),
        )
