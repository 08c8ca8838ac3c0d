"""Nodes in the processes of others: which of the programs around them is meant."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, TypeVar

from deros import codes
from deros.metamodels.converters.convert_arguments import ArgumentConverter
from deros.metamodels.converters.convert_starting import OF_STARTERS, not_started
from deros.models.arguments import Condition, Joined, both
from deros.models.composition import Inside
from deros.models.programs import ProcessInstance
from deros.models.system import NodeInstance, Subsystem, System

_OF_PROCESSES = {
    **OF_STARTERS,
    "Plugin": "plugin",
    "Into": "into",
    "IntraProcess": "intra_process",
}
"""The modifiers of what is started or loaded, by their rules."""
_HINTS = {
    "log_level": 'give the process the level: \'arguments ["--ros-args", "--log-level",'
    " \"NODE:=debug\"]' at '{owner}'",
    "autostart": "'{owner}' brings its nodes to active itself; or name the node that does:"
    " 'activated by NODE'",
    "own_name": "remove it: in another process, a node always has the name that it is given there",
    "plugin": "remove it: '{owner}' makes the node itself",
    "into": "remove it, or take the node out of 'inside'",
    "intra_process": "remove it",
}


class InsideConverter(ArgumentConverter):
    """Converts ``inside`` statements."""

    _has_inside = False

    def inside_nodes(self, found: Any, nodes: Iterable[NodeInstance]) -> list[NodeInstance]:
        """Return the nodes of a statement; what is not for them is reported, and left out."""
        self._has_inside = True
        inside = Inside(str(found.process), self.token_span(found.process))
        for node in found.nodes:
            self._refuse(node, inside.process)
        return [_in_process(node, inside) for node in nodes]

    def with_owners(self, system: System) -> System:
        """Return a system with the programs known in whose processes its nodes are."""
        return _in_group(system, ()) if self._has_inside else system

    def _refuse(self, node: Any, owner: str) -> None:
        for modifier in node.modifiers:
            word = _OF_PROCESSES.get(type(modifier).__name__)
            if word is not None:
                hint = _HINTS.get(word, "write it at '{owner}', whose process it is")
                self.report(
                    codes.NOT_OF_COMPOSED_NODE,
                    f"'{word}' is said of processes, and '{node.name}' is in that of '{owner}'",
                    self.span(modifier),
                    hint.format(owner=owner),
                )


def _in_process(node: NodeInstance, inside: Inside) -> NodeInstance:
    """Return a node without what is refused, so that nothing follows from it."""
    return replace(not_started(node), inside=inside, plugin=None, into=None, intra_process=None)


# Hosts --------------------------------------------------------------------------------------------

Group = TypeVar("Group", System, Subsystem)


def _in_group(group: Group, around: tuple[System | Subsystem, ...]) -> Group:
    """Return a group whose nodes are there where the programs are in whose processes they are."""
    groups = (group, *around)
    members = (
        _in_group(each, groups) if isinstance(each, Subsystem) else _with_owners(each, groups)
        for each in group.members
    )
    return replace(group, members=tuple(members))


def _with_owners(node: NodeInstance, groups: tuple[System | Subsystem, ...]) -> NodeInstance:
    if node.inside is None:
        return node
    for level, group in enumerate(groups):
        programs: list[NodeInstance | ProcessInstance]
        programs = [each for each in group.members if isinstance(each, NodeInstance)]
        programs += group.processes
        name = node.inside.process
        named = [each for each in programs if each.name == name and not _is_in(each, name)]
        if named:
            places = tuple(each.name_span for each in named)
            inside = replace(node.inside, owners=places, levels=level)
            return replace(node, inside=inside, when=both(_condition(named), node.when))
    return node


def _is_in(program: NodeInstance | ProcessInstance, process: str) -> bool:
    """Return whether a program is itself a node in the process of that name."""
    inside = program.inside if isinstance(program, NodeInstance) else None
    return inside is not None and inside.process == process


def _condition(owners: list[NodeInstance | ProcessInstance]) -> Condition | None:
    """Return when one of the owners is there; ``None``: always."""
    conditions = [each.when for each in owners if each.when is not None]
    if len(conditions) < len(owners):
        return None
    first = conditions[0]
    return first if len(conditions) == 1 else Joined("or", tuple(conditions), first.span)
