"""The clock of a node, which is chosen once: at its start."""

from __future__ import annotations

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

USE_SIM_TIME = 'use_sim_time'


def refuse_clock_change(node: Node) -> None:
    """
    Refuse, with a reason, to change use_sim_time from now on.

    Timers and deadlines of a running node belong to the clock that it started with. rclpy obeys a
    change at once, and destroys the subscription to /clock in the middle of its use.
    """
    chosen = node.get_parameter(USE_SIM_TIME).value

    def check(parameters: list[Parameter]) -> SetParametersResult:
        if all(each.name != USE_SIM_TIME or each.value == chosen for each in parameters):
            return SetParametersResult(successful=True)
        reason = f'{USE_SIM_TIME} cannot change while the node runs: start it anew'
        return SetParametersResult(successful=False, reason=reason)

    node.add_on_set_parameters_callback(check)  # in front of rclpy's own
