"""Which node is in which container, as the containers say."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from deros.live.snapshots import SeenNode
from deros.live.verify.differences import Difference, Kind
from deros.live.verify.expectation import Expectation, ExpectedNode

_OWN = "a process of its own"


def container_differences(
    expected: Expectation, seen: Mapping[str, SeenNode]
) -> Iterator[Difference]:
    """Yield the nodes that run, and not in the container or process that is meant."""
    holders = _holders(seen)
    for name, node in expected.nodes.items():
        if name not in seen or not is_known(node, seen):
            continue
        there = holders.get(name, ())
        if node.container in there or (not node.container and not there):
            continue
        meant, found = node.container or _OWN, ", ".join(there) or _OWN
        if node.container and node.container not in seen:
            if node.container in expected.nodes:
                continue  # it is missing itself
            found = f"{found}, as there is no {node.container}"
        yield Difference(Kind.WRONG_CONTAINER, name, "", meant, found, span=node.span)


def is_known(node: ExpectedNode, seen: Mapping[str, SeenNode]) -> bool:
    """Return whether it is known in which container a node is, as far as that matters."""
    if node.container is None:
        return False
    if not node.container:
        return True  # each container that answers says whether it has it
    container = seen.get(node.container)
    return container is None or not container.container or container.components is not None


def _holders(seen: Mapping[str, SeenNode]) -> Mapping[str, tuple[str, ...]]:
    """Return the containers that say that they have a node, by the name of that."""
    found: dict[str, tuple[str, ...]] = {}
    for each in seen.values():
        for component in each.components or ():
            found[component] = (*found.get(component, ()), each.full_name)
    return found
