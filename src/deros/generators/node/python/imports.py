"""The imports of generated modules: each name only where it is used."""

from __future__ import annotations

from collections.abc import Iterable

from deros.generators.node.python.view import (
    QOS_REPORT,
    NodeView,
    PackageView,
    PortView,
    interface_imports,
)
from deros.generators.text.python import import_lines


def base_imports(package: str, node: NodeView, runtime: str) -> tuple[list[str], list[str]]:
    """Return the import statements of the base class: standard library, then the rest.

    Args:
        package: the package of the node.
        node: the node.
        runtime: the package that the modules of the runtime are imported from.
    """
    standard: dict[str, set[str]] = {"typing": {"Any"}}
    if not node.raw:
        standard |= {"os": set(), "signal": set(), "threading": {"Thread"}}
        standard["typing"].add("Callable")
    if node.has_handlers:
        standard["abc"] = {"ABC", "abstractmethod"}
    if node.parameters:
        standard["dataclasses"] = {"dataclass"}
    if node.checked or node.action_clients or node.gated:
        standard["typing"].add("Callable")
    if node.maps:
        standard["typing"].add("Mapping")
    if any(port.by_entry for port in node.subscriptions):
        standard["functools"] = {"partial"}
    if any("combinations(" in c.condition for p in node.constrained for c in p.constraints):
        standard["itertools"] = {"combinations"}

    rest: dict[str, set[str]] = interface_imports(
        dict(node.interfaces), (kind for kind, _ in node.interfaces)
    )
    add = _Adder(rest)
    if not node.raw:
        add("rclpy")
        add("rclpy.executors", "SingleThreadedExecutor")
        add("rclpy.signals", "SignalHandlerOptions")
        add("rclpy.task", "Future")
    if node.reports_qos:
        add(f"{runtime}.{QOS_REPORT}", "QosReport")
    if node.lifecycle:
        add(f"{runtime}.managed_node", "ManagedNode")
        if node.gated:
            add("rclpy.lifecycle.managed_entity", "SimpleManagedEntity")
    else:
        add("rclpy.node", "Node")
    _parameter_imports(node, add)
    for module in sorted({module for p in node.custom for module, _ in p.custom}):
        add(package, module)
    if node.actions:
        add("rclpy.action", "CancelResponse", "GoalResponse")
        add("rclpy.action.server", "ServerGoalHandle")
        add(f"{runtime}.goal_threads", "GoalServer", "GoalThreads")
    if node.action_clients:
        add("rclpy.action", "ActionClient")
    if node.clients or node.action_clients:
        add("rclpy.task", "Future")
    if node.timers:
        add("rclpy.clock", "Clock", "ClockType")
    for port in _ports(node):
        for module, name in port.qos_imports:
            add(module, name)
    return import_lines(standard), import_lines(rest)


def user_imports(package: PackageView, node: NodeView) -> list[str]:
    """Return the import statements of the user's module."""
    handled = {port.type for port in (*node.subscriptions, *node.services, *node.actions)}
    used = [kind for kind, name in node.interfaces if name in handled]
    rest: dict[str, set[str]] = interface_imports(dict(node.interfaces), used)
    add = _Adder(rest)
    if node.actions:
        add("rclpy.action.server", "ServerGoalHandle")
    add(f"{package.name}.{node.base_module}", node.base_class, "run")
    return import_lines(rest)


def _parameter_imports(node: NodeView, add: _Adder) -> None:
    if not node.parameters:
        return
    add("rclpy.parameter", "Parameter")
    if any(p.described for p in node.declared):
        add(
            "rcl_interfaces.msg",
            "ParameterDescriptor",
            *(r for p in node.declared for r in p.ranges),
        )
    if node.checked:
        add("rcl_interfaces.msg", "SetParametersResult")


def _ports(node: NodeView) -> Iterable[PortView]:
    return (*node.publishers, *node.subscriptions, *node.services, *node.clients)


class _Adder:
    """Collects names to import by module."""

    def __init__(self, imports: dict[str, set[str]]) -> None:
        self._imports = imports

    def __call__(self, module: str, *names: str) -> None:
        self._imports.setdefault(module, set()).update(names)
