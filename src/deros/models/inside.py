"""Nodes in the process of another program, which makes them itself: controllers, plug-ins."""

from __future__ import annotations

from dataclasses import dataclass, field

from deros.diagnostics import Span


@dataclass(frozen=True, slots=True)
class Inside:
    """``inside PROCESS { node … }``: the node is a part of what another program runs.

    Attributes:
        process: the name of the node, container or process, as written.
        hosts: the places of the names of what is called so in the innermost group around that has
            the name; several, where each has a condition. Empty, if nothing is called so.
        levels: how many groups lie between the node and its hosts.
    """

    process: str
    process_span: Span = field(compare=False, repr=False)
    hosts: tuple[Span, ...] = field(default=(), compare=False, repr=False)
    levels: int = 0
