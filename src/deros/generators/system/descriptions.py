"""What the author of a system says about its parts."""

from __future__ import annotations

import itertools

from deros.models.system import NodeInstance, Subsystem, System


def collapse_whitespace(text: str) -> str:
    """Return a description with every line break and run of blanks as one blank."""
    return " ".join(text.split())


def description_of(system: System, path: tuple[str, ...]) -> str:
    """Return the description of a subsystem, or else of the system that it uses."""
    members: tuple[NodeInstance | Subsystem, ...] = system.members
    description = ""
    for name in path:
        inside = [m for m in members if isinstance(m, Subsystem) and m.name == name]
        used = [subsystem.system for subsystem in inside if subsystem.system]
        said = [*(s.description for s in inside), *(s.description for s in used)]
        description = next(filter(None, said), "")
        members = (
            *itertools.chain.from_iterable(s.members for s in inside),
            *itertools.chain.from_iterable(s.members for s in used),
        )
    return collapse_whitespace(description)
