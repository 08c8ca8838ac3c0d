"""Whether the graph has changed.

rclpy does not tell. rcl, which is below it, has a guard condition that the middleware triggers
whenever a node, an end or its QoS comes or goes (``rcl_node_get_graph_guard_condition``). rcl is
called by ctypes, with the pointers that rclpy gives.
"""

from __future__ import annotations

import ctypes
from typing import Any

from rclpy.impl.implementation_singleton import rclpy_implementation


class GraphEventsMissingError(Exception):
    """The functions of rcl cannot be called from here."""


class GraphEvents:
    """Counts the changes of the graph, those by the node itself among them."""

    def __init__(self, node: Any) -> None:
        """Count from now on.

        Args:
            node: of rclpy; it has to be there as long as changes are counted.

        Raises:
            GraphEventsMissingError: if rcl cannot be called.
        """
        try:
            # Symbols are looked up in what the extension of rclpy is linked with, rcl among it.
            rcl = ctypes.CDLL(rclpy_implementation.__file__)
            condition_of = rcl.rcl_node_get_graph_guard_condition
            self._add = rcl.rcl_wait_set_add_guard_condition
        except (AttributeError, OSError) as error:
            raise GraphEventsMissingError(str(error)) from error
        condition_of.restype = ctypes.c_void_p
        condition_of.argtypes = [ctypes.c_void_p]
        self._add.restype = ctypes.c_int
        self._add.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]
        self._condition = condition_of(node.handle.pointer)
        if not self._condition:
            raise GraphEventsMissingError("rcl has no guard condition for the node")
        self._wait_set = rclpy_implementation.WaitSet(0, 1, 0, 0, 0, 0, node.context.handle)
        self._count = 0

    def count(self) -> int:
        """Return how many changes there were; all since the last call count as one.

        Raises:
            RuntimeError: if rcl refuses to look.
        """
        self._wait_set.clear_entities()
        if self._add(self._wait_set.pointer, self._condition, None) != 0:
            raise RuntimeError("rcl does not wait for changes of the graph")
        self._wait_set.wait(0)
        self._count += bool(self._wait_set.is_ready("guard_condition", 0))
        return self._count
