"""Changes of the graph, as events.

rclpy has none. rcl, which is below it, has a guard condition that the middleware triggers whenever
a node, an end or its QoS comes or goes (``rcl_node_get_graph_guard_condition``): that is added to
what the executor of a node waits for. rcl is called by ctypes, with the pointers that rclpy gives.
"""

from __future__ import annotations

import ctypes
from typing import Any

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.waitable import NumberOfEntities, Waitable


class GraphEventsMissingError(Exception):
    """The functions of rcl cannot be called from here."""


class GraphEvents(Waitable):
    """Counts the changes of the graph that the executor of a node has met.

    Attributes:
        count: how many; several changes may count as one, and changes by the node itself count.
    """

    def __init__(self, node: Any) -> None:
        """Prepare to wait for changes, once this is added to the node.

        It has to be the first that is added: an executor asks the ones behind another only when it
        has handled that.

        Raises:
            GraphEventsMissingError: if rcl cannot be called.
        """
        super().__init__(ReentrantCallbackGroup())  # type: ignore[no-untyped-call]
        self.count = 0
        self._index = 0
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
        self._add.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.POINTER(ctypes.c_size_t)]
        self._condition = condition_of(node.handle.pointer)
        if not self._condition:
            raise GraphEventsMissingError("rcl has no guard condition for the node")

    def get_num_entities(self) -> Any:
        """Return what the wait set has to have room for."""
        return NumberOfEntities(num_gcs=1)

    def add_to_wait_set(self, wait_set: Any) -> None:
        """Have the wait set wait for the next change."""
        index = ctypes.c_size_t()
        if self._add(wait_set.pointer, self._condition, ctypes.byref(index)) != 0:
            raise RuntimeError("rcl does not wait for changes of the graph")
        self._index = index.value

    def is_ready(self, wait_set: Any) -> bool:
        """Return whether the graph has changed while the wait set waited, and count that."""
        is_changed = bool(wait_set.is_ready("guard_condition", self._index))
        self.count += is_changed
        return is_changed

    def take_data(self) -> None:
        """Take nothing: the count is all there is."""

    async def execute(self, taken: None) -> None:
        """Do nothing: the count is read by whoever looks at the graph."""
