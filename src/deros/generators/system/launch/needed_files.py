"""Which files have to be there before anything is started, and for which values of the arguments.

A file of several nodes, or of a node in several forms, is looked at once.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from deros.generators.system.files import FileView
from deros.generators.system.launched import LaunchView
from deros.generators.system.view import NodeView, ProgramView, SystemView
from deros.models.arguments import Condition, Joined
from deros.systems.arguments.symbolic import conjuncts, negated

MOST_CONDITIONS = 200
"""So many are put together; more of one file would take too long, and stay as they are."""


@dataclass(frozen=True, slots=True)
class NeededFile:
    """A file that is needed where ``when`` holds; always, if that is ``None``.

    Attributes:
        kind: ``file``, for nodes; ``xacro``; ``launch_file``.
        path: as the target writes it.
    """

    kind: str
    path: str
    when: Condition | None


def needed_files(view: SystemView, path: Callable[[FileView], str]) -> list[NeededFile]:
    """Return the files that a system needs, in the order of its programs.

    Args:
        view: of the system.
        path: returns the text for the path of a file.
    """
    conditions: dict[tuple[str, str], list[Condition | None]] = {}
    for program in view.programs:
        for kind, file in _files(program):
            conditions.setdefault((kind, path(file)), []).append(program.when)
    return [
        NeededFile(kind, text, when)
        for (kind, text), found in conditions.items()
        for when in united(found)
    ]


def _files(program: ProgramView) -> Iterator[tuple[str, FileView]]:
    yield from (("file", each) for each in program.files)
    if isinstance(program, NodeView):
        yield from (("xacro", made.file) for _, made in program.described)
    if isinstance(program, LaunchView):
        yield "launch_file", program.file


def united(conditions: Iterable[Condition | None]) -> list[Condition | None]:
    """Return fewer conditions of which one holds where one of the given does.

    Two that differ in one part, which is opposite in them, are one without that part; and what
    holds only where another one does is left out.
    """
    found = list(dict.fromkeys(map(_parts, conditions)))
    while len(found) <= MOST_CONDITIONS:
        for one, other in itertools.combinations(found, 2):
            common = one & other
            if common in (one, other) or _are_opposite(one - other, other - one):
                at = found.index(one)
                found = [each for each in found if each not in (one, other, common)]
                found.insert(at, common)
                break
        else:
            break
    return [_joined(each) for each in found]


_Parts = frozenset[Condition]


def _parts(condition: Condition | None) -> _Parts:
    return frozenset() if condition is None else frozenset(conjuncts(condition))


def _are_opposite(one: _Parts, other: _Parts) -> bool:
    if len(one) != 1 or len(other) != 1:
        return False
    (first,), (second,) = one, other
    return negated(first) == second or negated(second) == first


def _joined(parts: _Parts) -> Condition | None:
    ordered = sorted(parts, key=lambda each: (each.span.start, repr(each)))
    if len(ordered) < 2:
        return ordered[0] if ordered else None
    return Joined("and", tuple(ordered), ordered[0].span)
