"""Nodes in the processes of other programs: which of them share one, and what follows from that.

All nodes of a process read its parameter files, and live in its environment. The process of what is
loaded into a container is that of the container.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from deros.diagnostics import Span
from deros.models.parameter_files import ParameterFile
from deros.systems.flat import FlatLaunch, FlatNode, FlatProcess

NodePlace = tuple[tuple[str, ...], Span]
"""The path of a node, and the place of its name."""

MakeNode = Callable[[tuple[ParameterFile, ...]], FlatNode]
"""Makes a node of the system again, given the parameter files that it reads."""

_Others = Sequence[FlatProcess | FlatLaunch]


def owner_places(node: FlatNode) -> tuple[NodePlace, ...]:
    """Return the places of the programs in whose processes a node is, if any."""
    inside = node.instance.inside
    return () if inside is None else inside.places(node.path)


def in_processes(
    nodes: Sequence[FlatNode], others: _Others, makers: Mapping[NodePlace, MakeNode]
) -> tuple[list[FlatNode], list[FlatProcess | FlatLaunch]]:
    """Return the nodes and other programs, those of one process joined."""
    if all(node.instance.inside is None for node in nodes):
        return [*nodes], [*others]
    owners: dict[NodePlace, FlatNode | FlatProcess] = {
        _place(each): each
        for each in (*nodes, *others)
        if not isinstance(each, FlatLaunch) and not (isinstance(each, FlatNode) and each.statement)
    }
    containers = {n.full_name: _place(n) for n in nodes if n.instance.is_container}
    members: dict[NodePlace, list[FlatNode]] = {}
    for node in nodes:
        for place in owner_places(node):
            if place in owners:
                owner = owners[place]
                loaded = owner.container if isinstance(owner, FlatNode) else None
                process = containers.get(loaded, place) if loaded is not None else place
                members.setdefault(process, []).append(node)
    made: dict[NodePlace, FlatNode | FlatProcess] = {}
    for place, inside in members.items():
        owner = owners[place]
        files = _joined(owner, inside)
        joined = [_inside(node, owner, files, makers) for node in inside]
        made |= {_place(each): each for each in joined}
        if isinstance(owner, FlatProcess):
            made[place] = replace(owner, inside=tuple(joined), files=files)
        elif owner.instance.inside is None and owner.container is None:  # else it is reported
            made[place] = replace(_reading(owner, files, makers), inside=tuple(joined))
    return [_as_node(each, made) for each in nodes], [_as_other(each, made) for each in others]


def _place(program: FlatNode | FlatProcess) -> NodePlace:
    return program.path, program.instance.name_span


def _joined(owner: FlatNode | FlatProcess, inside: Sequence[FlatNode]) -> tuple[ParameterFile, ...]:
    """Return the parameter files of a process, each once: those of the program itself first."""
    files: list[ParameterFile] = []
    for program in (owner, *inside):
        files += (each for each in program.files if each not in files)
    return tuple(files)


def _reading(
    node: FlatNode, files: tuple[ParameterFile, ...], makers: Mapping[NodePlace, MakeNode]
) -> FlatNode:
    if node.files == files:
        return node
    return replace(makers[_place(node)](files), container=node.container)


def _inside(
    node: FlatNode,
    owner: FlatNode | FlatProcess,
    files: tuple[ParameterFile, ...],
    makers: Mapping[NodePlace, MakeNode],
) -> FlatNode:
    read = _reading(node, files, makers)
    return replace(
        read,
        process=owner.full_name,
        host=owner.host,
        environment=owner.environment,
        autostart=None,
    )


def _as_node(node: FlatNode, made: Mapping[NodePlace, FlatNode | FlatProcess]) -> FlatNode:
    found = made.get(_place(node)) if node.statement is None else None
    return found if isinstance(found, FlatNode) else node


def _as_other(
    program: FlatProcess | FlatLaunch, made: Mapping[NodePlace, FlatNode | FlatProcess]
) -> FlatProcess | FlatLaunch:
    found = made.get(_place(program)) if isinstance(program, FlatProcess) else None
    return found if isinstance(found, FlatProcess) else program
