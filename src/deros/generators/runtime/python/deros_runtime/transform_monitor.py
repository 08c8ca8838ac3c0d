"""
A node that publishes one of the transforms that are broadcast, for rules and for whoever looks.

On /tf, transforms of several nodes arrive in any order, so the silence of one of them does not
show there: here it does.
"""

from __future__ import annotations

from geometry_msgs.msg import TransformStamped
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.exceptions import ParameterException
from rclpy.node import Node
from tf2_msgs.msg import TFMessage

from .instance import Refusal
from .process import run as run_node

DEPTH = 100
"""Messages that may wait on /tf, as for the listeners of tf2: there come many at once."""


class TransformMonitor:
    """Publishes each transform from one frame to another, as it has been broadcast."""

    def __init__(self, node: Node) -> None:
        """
        Listen from now on.

        Raises Refusal if a parameter of the node cannot be used.
        """
        self._node = node
        try:
            self._parent = self._declare('parent', 'The frame that the transform leads from')
            self._child = self._declare('child', 'The frame that the transform leads to')
        except ParameterException as error:
            raise Refusal(str(error)) from None
        self._others: set[str] = set()
        self._publisher = node.create_publisher(TransformStamped, 'transform', 10)
        self._subscription = node.create_subscription(TFMessage, '/tf', self._pass, DEPTH)

    def _declare(self, name: str, description: str) -> str:
        descriptor = ParameterDescriptor(description=description, read_only=True)
        frame = _bare(str(self._node.declare_parameter(name, '', descriptor).value))
        if not frame:
            raise Refusal(f"parameter '{name}' has to name a frame")
        return frame

    def _pass(self, message: TFMessage) -> None:
        """Publish the transform, if the message has it."""
        for transform in message.transforms:
            if _bare(transform.child_frame_id) != self._child:
                continue
            parent = _bare(transform.header.frame_id)
            if parent == self._parent:
                self._publisher.publish(transform)
            else:
                self._report_other(parent)

    def _report_other(self, parent: str) -> None:
        """Say once of each other parent that the frame has it."""
        if parent not in self._others:
            self._others.add(parent)
            self._node.get_logger().warning(
                f"'{self._child}' is broadcast in '{parent}', too: only what is broadcast in"
                f" '{self._parent}' is published"
            )


def _bare(frame: str) -> str:
    """Return a frame as tf2 calls it: '/odom' and 'odom' are one."""
    return frame.removeprefix('/')


def make_node() -> Node:
    """Return the node, which listens; raises Refusal if a parameter cannot be used."""
    node = Node('transform_monitor')
    TransformMonitor(node)
    return node


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run_node(make_node, args)


if __name__ == '__main__':
    main()
