"""When and where a program is started, and whether its exit stops all others."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal

from deros.diagnostics import Span
from deros.interfaces.durations import NS_PER_S
from deros.models.arguments import Expression


@dataclass(frozen=True, slots=True)
class Host:
    """``host NAME "ADDRESS" setup "FILE"``: a computer of the system.

    ``address`` is its name or address in the network, and ``setup`` the file that a shell there has
    to source before ROS is found, if any; both as written. See :mod:`deros.models.system` for
    ``address_from`` and ``setup_from``.
    """

    name: str
    address: str
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    description: str = ""
    address_from: Expression | None = None
    setup: str = ""
    setup_from: Expression | None = None

    @property
    def computed(self) -> Iterator[Expression]:
        """What is computed of it."""
        yield from (each for each in (self.address_from, self.setup_from) if each is not None)


@dataclass(frozen=True, slots=True)
class Delay:
    """``delay T``: counted from the start of the system, or from the exit that is waited for."""

    ns: int
    span: Span = field(compare=False, repr=False)

    @property
    def seconds(self) -> float:
        """The delay in seconds."""
        return self.ns / NS_PER_S


@dataclass(frozen=True, slots=True)
class After:
    """``after exit of NAME``: a program of the same subsystem or of one around it, as written.

    A name with ``/`` leads into subsystems: ``Logging/recorder``.
    """

    name: str
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)


READY_TIMEOUT_NS = 60 * NS_PER_S
"""The time for which a program waits for something in the ROS graph, where none is written."""


@dataclass(frozen=True, slots=True)
class Ready:
    """``after node NAME``, ``active NAME``, ``service NAME`` or ``topic NAME``.

    Attributes:
        name: a program of the system as :class:`After` names it, or the graph name of a service or
            a topic, as written; see :mod:`deros.models.system` for ``name_from``.
    """

    kind: Literal["node", "active", "service", "topic"]
    name: str
    timeout_ns: int
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    name_from: Expression | None = None

    @property
    def timeout_s(self) -> float:
        """The longest time to wait, in seconds."""
        return self.timeout_ns / NS_PER_S

    @property
    def names_program(self) -> bool:
        """Whether ``name`` is that of a program of the system, not one of the ROS graph."""
        return self.kind in ("node", "active")


@dataclass(frozen=True, slots=True)
class Starting:
    """When a program is started, and whether its exit stops all; by default at once, and no.

    Attributes:
        stops_all: the place of ``on exit stop all``, where it is written.
        ready: what has to be there before; then there is no ``after``.
    """

    delay: Delay | None = None
    after: After | None = None
    stops_all: Span | None = field(default=None, repr=False)
    ready: Ready | None = None

    @property
    def delay_s(self) -> float:
        """The delay in seconds; without one, zero."""
        return 0.0 if self.delay is None else self.delay.seconds

    @property
    def awaited(self) -> str:
        """The name of the program whose exit is waited for, as written; without one, empty."""
        return "" if self.after is None else self.after.name

    @property
    def is_later(self) -> bool:
        """Whether the program is not started together with the system."""
        return not (self.delay is None and self.after is None and self.ready is None)


AT_ONCE = Starting()
"""Started with the system; its exit is left to the rule for all programs."""
