"""The headers that generated files include: each only where it is used."""

from __future__ import annotations

from deros.generators.node.cpp.view import NodeView, custom_stem

_DESCRIPTOR = "rcl_interfaces/msg/parameter_descriptor.hpp"
_RESULT = "rcl_interfaces/msg/set_parameters_result.hpp"


def base_header(node: NodeView) -> list[str]:
    """Return the headers that the base class's header includes, those of ROS 2 and the caller's."""
    headers = ["rclcpp/rclcpp.hpp", *(port.header for port in node.ports)]
    if node.lifecycle:
        headers.append("rclcpp_lifecycle/lifecycle_node.hpp")
    if node.lifecycle and node.publishers:
        headers.append("rclcpp_lifecycle/lifecycle_publisher.hpp")
    if node.gated:
        headers.append("rclcpp_lifecycle/managed_entity.hpp")
    if node.actions or node.action_clients:
        headers.append("rclcpp_action/rclcpp_action.hpp")
    if node.actions:
        headers.append(node.runtime.header("goal_threads"))
    if node.links_runtime:
        headers.append(node.runtime.header("version_check"))
    return headers


def base_source(package: str, node: NodeView) -> list[str]:
    """Return the headers that the base class's source includes beside its own."""
    headers = list(node.provided.includes) if node.provided else []
    if node.lifecycle:
        headers.append(node.runtime.header("managed_node"))
    if node.reports_qos:
        headers.append(node.runtime.header("qos_report"))
    if any(parameter.described for parameter in node.declared):
        headers.append(_DESCRIPTOR)
    if node.checked:
        headers.append(_RESULT)
    headers += (f"{package}/{custom_stem(scope)}.hpp" for scope, _ in node.custom)
    return headers


def user_header(package: str, node: NodeView) -> list[str]:
    """Return the headers that the header of the user's class includes."""
    handled = (*node.subscriptions, *node.services, *node.actions)
    headers = [f"{package}/{node.stem}_base.hpp", "rclcpp/rclcpp.hpp"]
    if node.actions:
        headers.append("rclcpp_action/rclcpp_action.hpp")
    return [*headers, *(port.header for port in handled)]
