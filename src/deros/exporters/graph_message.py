"""Systems as a message of ROS 2, ``rosgraph_msgs/msg/Graph``, in YAML.

Source: ``Graph.msg`` of rosgraph_msgs and what it consists of, and ``ParameterDescriptor.msg`` and
``ParameterValue.msg`` of rcl_interfaces; for names inside of actions the ROS 2 design, "Actions",
section "Topics and Services Used".
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from deros.exporters.results import Exported, missing
from deros.exporters.yaml_text import Data, yaml_text
from deros.interfaces.durations import NS_PER_S
from deros.interfaces.standard_services import OF_MANAGED_NODES
from deros.interfaces.types import InterfaceType
from deros.models.common import Value
from deros.models.node import BUILT_IN_PARAMETERS, NodeType, Parameter, ParameterType, PortKind
from deros.models.qos import SYSTEM_DEFAULT, Policies, policies
from deros.systems.arguments.lookups import is_at_start
from deros.systems.flat import FlatLaunch, FlatNode, FlatPort, FlatSystem

_TOPICS = {"publishers": PortKind.PUBLISHER, "subscriptions": PortKind.SUBSCRIPTION}
_SERVICES = {"service_clients": PortKind.CLIENT, "service_servers": PortKind.SERVICE}
_ACTIONS = {"action_clients": PortKind.ACTION_CLIENT, "action_servers": PortKind.ACTION}
_RELIABILITY = {SYSTEM_DEFAULT: 0, "reliable": 1, "best_effort": 2}
_DURABILITY = {SYSTEM_DEFAULT: 0, "transient_local": 1, "volatile": 2}
_LIVELINESS = {SYSTEM_DEFAULT: 0, "automatic": 1, "manual_by_topic": 3}
_KEEP_LAST, _KEEP_ALL = 1, 2
_TYPES = list(ParameterType)
"""In the order of their numbers in ``ParameterType.msg``, from 1."""

_OF_VALUES = {
    bool: ParameterType.BOOL,
    int: ParameterType.INTEGER,
    float: ParameterType.DOUBLE,
    str: ParameterType.STRING,
}


def file_name(system: FlatSystem) -> str:
    """Return the name of a system's file."""
    return f"{system.system.name}.graph.yaml"


def graph_message(system: FlatSystem) -> Exported:
    """Return the graph that a system forms when it runs, and what it does not say.

    Args:
        system: with the values of its arguments, and
            :data:`~deros.systems.arguments.lookups.AT_START` for what is not known here.
    """
    nodes: list[Data] = [_node(each, each.type) for each in system.nodes if each.type is not None]
    lacking = [
        missing(each.instance.span, f"node '{each.full_name}'", "is not in the graph: no type")
        for each in system.nodes
        if each.type is None
    ]
    lacking += (
        missing(
            each.instance.span,
            f"launch file '{each.full_name}'",
            "may start nodes that are not in the graph",
        )
        for each in system.others
        if isinstance(each, FlatLaunch)
    )
    lacking += (each for node in system.nodes for each in _unknown(node))
    return Exported(yaml_text({"nodes": nodes}), tuple(lacking))


def _unknown(node: FlatNode) -> Iterator[str]:
    known = _known(node)
    for name, _ in node.parameters:
        if name not in known:
            what = f"the value of parameter '{name}' of '{node.full_name}'"
            why = "is known only where the system is started"
            yield missing(node.instance.span, what, why)


def _known(node: FlatNode) -> dict[str, Value]:
    """Return the values that the system sets, without those of which nothing is known here."""
    made = {each.name for each in node.instance.parameters if each.xacro is not None}
    return {k: v for k, v in node.parameters if k not in made and not is_at_start(v)}


def _node(node: FlatNode, of: NodeType) -> dict[str, Data]:
    said: dict[str, Data] = {"name": node.full_name}
    parameters = list(_parameters(node, of))
    said["parameters"] = [descriptor for descriptor, _ in parameters]
    said["parameter_values"] = [value for _, value in parameters]
    for key, kind in _TOPICS.items():
        said[key] = [_topic(each) for each in _ports(node, kind)]
    for key, kind in _SERVICES.items():
        services: list[Data] = [_service(p.topic, p.port.type) for p in _ports(node, kind)]
        if kind is PortKind.SERVICE and of.lifecycle:
            own = OF_MANAGED_NODES.items()
            services += (_service(f"{node.full_name}/{name}", kind) for name, kind in own)
        said[key] = services
    for key, kind in _ACTIONS.items():
        said[key] = [_action(each.topic, each.port.type) for each in _ports(node, kind)]
    return said


def _ports(node: FlatNode, kind: PortKind) -> Iterator[FlatPort]:
    return (each for each in node.ports if each.port.kind is kind)


def _topic(port: FlatPort) -> dict[str, Data]:
    profile = _qos(policies(port.port.qos))
    return {"name": port.topic, "type": {"name": str(port.port.type)}, "qos": profile}


def _service(name: str, of_type: InterfaceType) -> dict[str, Data]:
    return _service_of(name, str(of_type))


def _service_of(name: str, of_type: str) -> dict[str, Data]:
    return {
        "name": name,
        "request_type": {"name": f"{of_type}_Request"},
        "response_type": {"name": f"{of_type}_Response"},
    }


def _action(name: str, of_type: InterfaceType) -> dict[str, Data]:
    below = f"{name}/_action"
    return {
        "name": name,
        "send_goal": _service_of(f"{below}/send_goal", f"{of_type}_SendGoal"),
        "get_result": _service_of(f"{below}/get_result", f"{of_type}_GetResult"),
        "cancel_goal": _service_of(f"{below}/cancel_goal", "action_msgs/srv/CancelGoal"),
        "feedback": {"name": f"{below}/feedback", "type": {"name": f"{of_type}_FeedbackMessage"}},
        "status": {"name": f"{below}/status", "type": {"name": "action_msgs/msg/GoalStatusArray"}},
    }


def _qos(found: Policies) -> dict[str, Data]:
    depth = found.depth
    is_bounded = depth is not None and not math.isinf(depth)
    history = 0 if depth is None else _KEEP_LAST if is_bounded else _KEEP_ALL
    return {
        "depth": int(depth) if depth is not None and is_bounded else 0,
        "deadline": _time(found.deadline),
        "lifespan": _time(found.lifespan),
        "history": history,
        "reliability": _RELIABILITY[found.reliability],
        "durability": _DURABILITY[found.durability],
        "liveliness": _LIVELINESS[found.liveliness],
        "liveliness_lease_duration": _time(found.lease),
    }


def _time(nanoseconds: int | None) -> dict[str, Data]:
    seconds, rest = divmod(nanoseconds or 0, NS_PER_S)
    return {"sec": seconds, "nanosec": rest}


# Parameters -------------------------------------------------------------------------------------


def _parameters(node: FlatNode, of: NodeType) -> Iterator[tuple[dict[str, Data], dict[str, Data]]]:
    """Yield descriptors and values: of what the system sets, and of what has a default."""
    values = {
        each.name: each.default
        for each in of.parameters
        if each.default is not None and not each.keys
    }
    set_here = {name for name, _ in node.parameters}
    values = {name: value for name, value in values.items() if name not in set_here}
    values |= _known(node)
    for name in sorted(values):
        declared = of.parameter_for(name)
        kind = declared.type if declared is not None else _type_of(name, values[name])
        descriptor: dict[str, Data] = {"name": name, "type": _number(kind)}
        if declared is not None:
            descriptor |= _described(declared)
        field = kind.value.replace("[]", "_array") + "_value"
        yield descriptor, {"type": _number(kind), field: values[name]}


def _number(kind: ParameterType) -> int:
    return _TYPES.index(kind) + 1


def _type_of(name: str, value: Value) -> ParameterType:
    """Return the type of a parameter that nobody declares."""
    if name in BUILT_IN_PARAMETERS:
        return BUILT_IN_PARAMETERS[name]
    if isinstance(value, tuple):
        item = _OF_VALUES[type(value[0])] if value else ParameterType.STRING
        return ParameterType(f"{item.value}[]")
    return _OF_VALUES[type(value)]


def _described(parameter: Parameter) -> dict[str, Data]:
    said: dict[str, Data] = {"description": parameter.description}
    said["read_only"] = parameter.read_only
    interval = parameter.interval
    if interval is None or interval.one_sided or parameter.type.is_array:
        return said
    if not (interval.lower_closed and interval.upper_closed):
        return said
    ends = interval.lower, interval.upper
    if parameter.type is ParameterType.DOUBLE:
        lower, upper = map(float, ends)
        said["floating_point_range"] = [{"from_value": lower, "to_value": upper, "step": 0.0}]
    else:
        whole = math.ceil(ends[0]), math.floor(ends[1])
        said["integer_range"] = [{"from_value": whole[0], "to_value": whole[1], "step": 0}]
    return said
