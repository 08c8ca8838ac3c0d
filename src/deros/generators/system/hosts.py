"""The computers of a system, as what starts it on them sees them."""

from __future__ import annotations

from dataclasses import dataclass

from deros.generators.system.computed import Computed, Text
from deros.models.starting import Host


@dataclass(frozen=True, slots=True)
class HostView:
    """A computer.

    Attributes:
        name: by which it is chosen.
        address: of it in the network.
        setup: the file that a shell there has to source, or nothing.
    """

    name: str
    address: Text
    setup: Text = ""


def host_view(host: Host) -> HostView:
    """Return the view of a computer."""
    address: Text = host.address if host.address_from is None else Computed((host.address_from,))
    setup: Text = host.setup if host.setup_from is None else Computed((host.setup_from,))
    return HostView(host.name, address, setup)
