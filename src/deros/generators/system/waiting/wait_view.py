"""What a program waits for in the ROS graph, for a target."""

from __future__ import annotations

from dataclasses import dataclass

from deros.generators.system.computed import Text
from deros.models.starting import Ready


@dataclass(frozen=True, slots=True)
class WaitView:
    """What has to be there before a program is started.

    Attributes:
        ready: as written.
        name: the full name of the node, service or topic, from the namespace that the system is
            started in.
        owner: the program, with its subsystems, whose process the awaited node is in; empty if
            that is not a process which the system starts, or depends on the arguments.
        restarts: whether that program is started again when it ends.
    """

    ready: Ready
    name: Text
    owner: str = ""
    restarts: bool = False
