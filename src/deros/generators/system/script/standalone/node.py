"""One row of the table of nodes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

Scalar = bool | int | float | str
Value = Scalar | Sequence[Scalar]


@dataclass(frozen=True)
class Node:
    """One node of the system: which program to run, and under which names."""

    name: str
    namespace: str
    package: str
    executable: str
    subsystem: str = ''
    parameters: Mapping[str, Value] = field(default_factory=dict)
    remappings: Mapping[str, str] = field(default_factory=dict)
    log_level: str | None = None
    respawn_delay: float | None = None  # seconds; None: it is not started again
    respawn_max: int | None = None  # None: without limit
    autostart: float | None = None  # seconds for each transition; None: it is not brought up
    optional: bool = False  # when it cannot be brought up, the others run on

    @property
    def full_name(self) -> str:
        """Return the name in the ROS graph, such as /front/lidar."""
        return f'{self.namespace.rstrip("/")}/{self.name}'
