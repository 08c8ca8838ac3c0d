"""Which program another one waits for: that of the innermost subsystem that has the name."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

from deros.systems.flat import FlatProgram, FlatSystem

Key = tuple[str, ...]
"""The path of a program and its name; a name with ``/`` leads further in."""


def key_of(program: FlatProgram) -> Key:
    """Return by which programs name each other."""
    return (*program.path, program.instance.name)


def programs_by_key(flat: FlatSystem) -> Mapping[Key, Sequence[FlatProgram]]:
    """Return the nodes, processes and launch files of a system; two nodes may have one key."""
    found: dict[Key, list[FlatProgram]] = defaultdict(list)
    for each in flat.parts:
        found[key_of(each)].append(each)
    return dict(found)


def awaited_programs(
    path: Sequence[str], name: str, known: Mapping[Key, Sequence[FlatProgram]]
) -> Sequence[FlatProgram]:
    """Return what ``after exit of NAME`` names in the subsystem of a path; nothing if unknown.

    Args:
        path: the subsystems that hold what waits, outermost first.
        name: as written.
        known: the programs of the system.
    """
    for depth in range(len(path), -1, -1):
        found = known.get((*path[:depth], *name.split("/")))
        if found is not None:
            return found
    return ()
