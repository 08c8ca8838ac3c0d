"""How the managed nodes of a system are brought to active when it is started."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from deros.diagnostics import Span
from deros.interfaces.durations import NS_PER_S

OnFailure = Literal["stop", "continue"]

_TIMEOUT_NS = 10 * NS_PER_S


@dataclass(frozen=True, slots=True)
class Autostart:
    """``autostart`` on a node, a subsystem or a system, as written: ``None`` where nothing is."""

    span: Span = field(compare=False, repr=False)
    timeout_ns: int | None = None
    on_failure: OnFailure | None = None

    @property
    def timeout_s(self) -> float:
        """The seconds that each transition may take, as may the services of the node to appear."""
        return (_TIMEOUT_NS if self.timeout_ns is None else self.timeout_ns) / NS_PER_S

    @property
    def is_optional(self) -> bool:
        """Whether the others run on when the node cannot be brought up; else all are stopped."""
        return self.on_failure == "continue"


def combined(inner: Autostart | None, outer: Autostart | None) -> Autostart | None:
    """Return what holds inside: each setting of the inner one where it has that, else the outer."""
    if inner is None or outer is None:
        return inner or outer
    timeout = outer.timeout_ns if inner.timeout_ns is None else inner.timeout_ns
    return Autostart(inner.span, timeout, inner.on_failure or outer.on_failure)
