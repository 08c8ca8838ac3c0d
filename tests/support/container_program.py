"""A container in Python, which lists its nodes as those of ROS 2 do: ``... NAME COMPONENT ...``.

The components are nodes of the same process. It prints ``up`` when all are there. It makes one
more, ``/late``, when the hidden service ``/NAME_take`` is called, and lists it for true alone.
"""

from __future__ import annotations

import contextlib
import sys
from typing import Any

import rclpy
from composition_interfaces.srv import ListNodes
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import SetBool


def main() -> None:
    """Run the container with its components, until it is interrupted."""
    rclpy.init()
    executor = SingleThreadedExecutor()
    container = Node(sys.argv[1])
    executor.add_node(container)
    loaded: dict[str, Node] = {}
    hidden: set[str] = set()

    def load(full: str) -> None:
        space, _, name = full.rpartition("/")
        loaded[full] = Node(name, namespace=space or "/")
        loaded[full].create_publisher(Bool, "~/image", 1)
        executor.add_node(loaded[full])

    def listed(_: Any, response: Any) -> Any:
        response.full_node_names = [name for name in loaded if name not in hidden]
        response.unique_ids = range(1, len(response.full_node_names) + 1)
        return response

    def take(request: Any, response: Any) -> Any:
        hidden.discard("/late") if request.data else hidden.add("/late")
        if "/late" not in loaded:
            load("/late")
        response.success = True
        return response

    container.create_service(ListNodes, "~/_container/list_nodes", listed)
    control = Node("_control")
    control.create_service(SetBool, f"/{sys.argv[1]}_take", take)
    executor.add_node(control)
    for each in sys.argv[2:]:
        load(each)
    print("up", flush=True)
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        executor.spin()


if __name__ == "__main__":
    main()
