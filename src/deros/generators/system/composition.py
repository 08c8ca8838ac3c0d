"""What is loaded into which container, for those who start a system."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from deros.generators.system.computed import Text
from deros.generators.system.view import NodeView, SystemView


def composes(view: SystemView) -> bool:
    """Return whether nodes are loaded into containers."""
    return any(node.container is not None for node in view.nodes)


class Loads:
    """The nodes that are loaded where a container stands, or where it would stand."""

    def __init__(self, view: SystemView) -> None:
        """Look for the containers of a system, and for those of others that it uses."""
        self._nodes = tuple(view.nodes)
        self._own = [node.address for node in self._nodes if node.address is not None]
        self._first: dict[int, Text] = {}
        elsewhere: list[Text] = []
        for node in self._nodes:
            target = node.container
            if target is not None and target not in (*self._own, *elsewhere):
                elsewhere.append(target)
                self._first[id(node)] = target

    def into(self, container: NodeView) -> tuple[NodeView, ...]:
        """Return what a container of the system is given, in the order written."""
        assert container.address is not None
        found = self._into(container.address)
        return tuple(
            replace(node, when=None) if node.when == container.when else node for node in found
        )

    def elsewhere(self, node: NodeView) -> tuple[NodeView, ...]:
        """Return what a container of others is given, at the first of these nodes; else nothing."""
        target = self._first.get(id(node))
        return () if target is None else tuple(self._into(target))

    def _into(self, target: Text) -> Iterator[NodeView]:
        return (node for node in self._nodes if node.container == target)
