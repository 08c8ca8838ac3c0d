"""
A node that publishes the processor load of another one, for rules and for whoever looks.

It is a process of its own: a node that hangs cannot report that it does. While the other one does
not run it publishes nothing, which the timeout of a rule's input notices.
"""

from __future__ import annotations

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.exceptions import ParameterException
from rclpy.node import Node
from std_msgs.msg import Float64

from .instance import Refusal
from .process import run as run_node
from .processor_load import LoadMeter, NoProcess

LEAST_PERIOD, MOST_PERIOD = 0.1, 60.0
"""Bounds of the period in s. The system counts processor time in steps of 0.01 s."""


class LoadMonitor:
    """Publishes the load since its last message, in percent of one processor."""

    def __init__(self, node: Node) -> None:
        """
        Look for the process at once, and measure from then on.

        Raises Refusal if a parameter of the node cannot be used.
        """
        self._node = node
        try:
            watched = self._declare_watched()
            period = self._declare_period()
        except ParameterException as error:
            raise Refusal(str(error)) from None
        if not watched.strip('/'):
            raise Refusal("parameter 'node' has to name the node whose load is measured")
        if not watched.startswith('/'):
            watched = f'{node.get_namespace().rstrip("/")}/{watched}'
        self._watched = watched
        self._meter = LoadMeter(watched)
        self._process: int | None = None
        self._fault = ''
        self._publisher = node.create_publisher(Float64, 'load', 10)
        self._measure()
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(period, self._measure, clock=steady)

    def _declare_watched(self) -> str:
        descriptor = ParameterDescriptor(
            description='The node whose load is measured', read_only=True
        )
        return str(self._node.declare_parameter('node', '', descriptor).value)

    def _declare_period(self) -> float:
        descriptor = ParameterDescriptor(
            description='Time, in s, from one message to the next',
            read_only=True,
            floating_point_range=[
                FloatingPointRange(from_value=LEAST_PERIOD, to_value=MOST_PERIOD)
            ],
        )
        return float(self._node.declare_parameter('period', 0.5, descriptor).value)

    def _measure(self) -> None:
        """Publish the load since the last call, if the process is the same one."""
        try:
            load = self._meter.measure()
        except NoProcess as fault:
            self._report_fault(str(fault))
            return
        if load is not None:
            self._publisher.publish(Float64(data=load))
        if self._meter.process != self._process:
            self._process = self._meter.process
            self._fault = ''
            self._node.get_logger().info(f'{self._watched} is process {self._process}')

    def _report_fault(self, fault: str) -> None:
        """Say once that nothing is published, and why."""
        self._process = None
        if fault != self._fault:
            self._fault = fault
            self._node.get_logger().warning(f'no load is published: {fault}')


def make_node() -> Node:
    """Return the node, which measures; raises Refusal if a parameter cannot be used."""
    node = Node('load_monitor')
    LoadMonitor(node)
    return node


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run_node(make_node, args)


if __name__ == '__main__':
    main()
