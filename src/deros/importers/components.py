"""The containers of a snapshot, and what is loaded into them."""

from __future__ import annotations

from deros.live.observer import printable
from deros.live.snapshots import SeenNode, Snapshot, Unseen

_USUAL = {"use_sim_time": False, "start_type_description_service": True}
"""The parameters of every node, as they are usually."""


class Containers:
    """What a system says of the containers of a snapshot."""

    def __init__(self, snapshot: Snapshot) -> None:
        """Find the containers that are nothing else, and what is in them."""
        self._containers: set[str] = set()
        self._of: dict[str, str] = {}
        self._problems: dict[str, list[str]] = {}
        for node in snapshot.nodes:
            if node.container:
                self._take(node)

    def is_one(self, node: SeenNode) -> bool:
        """Return whether a system says ``container`` of a node."""
        return node.full_name in self._containers

    def is_usual(self, unseen: Unseen) -> bool:
        """Return whether something is not seen of any container, and said of none in a system."""
        return unseen.is_of_container and unseen.node in self._containers

    def of(self, node: SeenNode) -> str | None:
        """Return the full name of the container that a node is loaded into, if it is."""
        return None if self.is_one(node) else self._of.get(node.full_name)

    def problems_of(self, node: SeenNode) -> list[str]:
        """Return what a system cannot say of a node that is a container."""
        return self._problems.get(node.full_name, [])

    def _take(self, node: SeenNode) -> None:
        name = node.full_name
        problems: list[str] = []
        self._problems[name] = problems
        if node.components is None:
            problems.append(f"{name} is a container: which nodes are in it is not known")
            return
        if node.ends or node.lifecycle is not None:
            said = ", ".join(node.components) or "nothing"
            problems.append(
                f"{name} is a container with ends of its own, and in the model a node; in it there "
                f"is {said}"
            )
            return
        problems.extend(
            f"{name}: parameter {printable(each.name)} is left out: a system sets none of a "
            "container"
            for each in node.parameters or ()
            if each.value != _USUAL.get(each.name)
        )
        self._containers.add(name)
        for component in node.components:
            self._of.setdefault(component, name)
