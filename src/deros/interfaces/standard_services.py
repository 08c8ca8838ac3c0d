"""Services that nodes have without any description: for their parameters and, managed, their state.

Sources: ``rclcpp/src/rclcpp/parameter_service.cpp``, ``rcl_lifecycle/src/com_interface.c``, and for
``get_type_description`` REP 2016.
"""

from __future__ import annotations

from collections.abc import Mapping

from deros.interfaces.types import InterfaceType


def _services(package: str, **names: str) -> dict[str, InterfaceType]:
    return {name: InterfaceType(package, "srv", kind) for name, kind in names.items()}


OF_EVERY_NODE: Mapping[str, InterfaceType] = {
    **_services(
        "rcl_interfaces",
        describe_parameters="DescribeParameters",
        get_parameter_types="GetParameterTypes",
        get_parameters="GetParameters",
        list_parameters="ListParameters",
        set_parameters="SetParameters",
        set_parameters_atomically="SetParametersAtomically",
    ),
    **_services("type_description_interfaces", get_type_description="GetTypeDescription"),
}
"""The services of every node, by the last part of their names below the node's name."""

OF_MANAGED_NODES: Mapping[str, InterfaceType] = _services(
    "lifecycle_msgs",
    change_state="ChangeState",
    get_available_states="GetAvailableStates",
    get_available_transitions="GetAvailableTransitions",
    get_state="GetState",
    get_transition_graph="GetAvailableTransitions",
)
"""The additional services of every managed node."""
