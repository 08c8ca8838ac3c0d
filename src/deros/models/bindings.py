"""What actions of safety rules are bound to: a topic with their state, a service."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from deros.diagnostics import Span
from deros.interfaces.types import InterfaceType
from deros.models.common import Name

if TYPE_CHECKING:
    from deros.models.rules import Term


@dataclass(frozen=True, slots=True)
class Binding:
    """The publication of a bound action: ``publishes VALUE on TOPIC : TYPE``."""

    value: Term
    topic: Name
    type: InterfaceType
    type_span: Span = field(compare=False, repr=False)
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class ServiceCall:
    """The service that a bound action calls: ``calls VALUE on SERVICE : TYPE``.

    There is no ``VALUE`` if the request is empty.
    """

    value: Term | None
    service: Name
    type: InterfaceType
    type_span: Span = field(compare=False, repr=False)
    span: Span = field(compare=False, repr=False)
