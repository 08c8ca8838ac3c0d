"""Node descriptions as NoDL 2.

Source: ``nodl.schema.yaml`` and ``parameter.schema.yaml`` of ros-tooling/nodl, version 2.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from deros.exporters.results import Exported, missing
from deros.exporters.yaml_text import Data, yaml_text
from deros.models.common import Interval
from deros.models.node import NodeType, Parameter, ParameterType, Port, PortKind
from deros.models.qos import SYSTEM_DEFAULT, Policies, policies

_SECTIONS = {
    PortKind.PUBLISHER: "publishers",
    PortKind.SUBSCRIPTION: "subscriptions",
    PortKind.SERVICE: "service_servers",
    PortKind.CLIENT: "service_clients",
    PortKind.ACTION: "action_servers",
    PortKind.ACTION_CLIENT: "action_clients",
}
_ACTIONS = (PortKind.ACTION, PortKind.ACTION_CLIENT)
_TOPICS = (PortKind.PUBLISHER, PortKind.SUBSCRIPTION)
_TYPES = {
    ParameterType.BOOL: "bool",
    ParameterType.INTEGER: "int",
    ParameterType.DOUBLE: "double",
    ParameterType.STRING: "string",
    ParameterType.BYTE_ARRAY: "byte_array",
    ParameterType.BOOL_ARRAY: "bool_array",
    ParameterType.INTEGER_ARRAY: "int_array",
    ParameterType.DOUBLE_ARRAY: "double_array",
    ParameterType.STRING_ARRAY: "string_array",
}

_NAME = re.compile(r"[A-Za-z]|[/~A-Za-z][A-Za-z0-9_/]*[A-Za-z0-9_]", re.ASCII)
_TYPE = re.compile(r"[a-zA-Z][a-zA-Z0-9_]*/(?:msg|srv|action)/[A-Z][a-zA-Z0-9]*", re.ASCII)


def file_name(node: NodeType) -> str:
    """Return the name of a node's document, which names the node."""
    return f"{node.name}.nodl.yaml"


def nodl(node: NodeType) -> Exported:
    """Return the document of a node, and what it does not say."""
    said: dict[str, Data] = {"nodl_version": 2}
    if node.description:
        said["description"] = node.description
    parameters: dict[str, Data] = {each.name: _parameter(each) for each in _plain(node)}
    if parameters:
        said["parameters"] = parameters
    for kind, section in _SECTIONS.items():
        ports: list[Data] = [_port(each) for each in node.ports_of(kind) if _fits(each)]
        if ports:
            said[section] = ports
    return Exported(yaml_text(said), tuple(_missing(node)))


def _plain(node: NodeType) -> Iterator[Parameter]:
    return (each for each in node.parameters if not each.keys)


# Ports ------------------------------------------------------------------------------------------


def _fits(port: Port) -> bool:
    """Return whether a document can have the names of a port, and of its type."""
    return bool(_NAME.fullmatch(port.name) and _TYPE.fullmatch(str(port.type)))


def _port(port: Port) -> dict[str, Data]:
    said: dict[str, Data] = {"name": port.name, "type": str(port.type)}
    if port.kind in _TOPICS or (port.qos is not None and port.kind not in _ACTIONS):
        said["qos"] = _qos(policies(port.qos))
    if port.description:
        said["description"] = port.description
    return said


def _qos(found: Policies) -> dict[str, Data]:
    said: dict[str, Data] = {}
    if found.depth is None:
        said["history"] = SYSTEM_DEFAULT.upper()
    elif math.isinf(found.depth):
        said["history"] = "KEEP_ALL"
    else:
        said |= {"history": "KEEP_LAST", "depth": int(found.depth)}
    said["reliability"] = found.reliability.upper()
    said["durability"] = found.durability.upper()
    if found.deadline is not None:
        said["deadline_ns"] = found.deadline
    if found.lifespan is not None:
        said["lifespan_ns"] = found.lifespan
    # Automatic without a lease is what every end starts from.
    if found.liveliness not in ("automatic", SYSTEM_DEFAULT) or found.lease is not None:
        said["liveliness"] = found.liveliness.upper()
    if found.lease is not None:
        said["liveliness_lease_duration_ns"] = found.lease
    return said


# Parameters -------------------------------------------------------------------------------------


def _parameter(parameter: Parameter) -> dict[str, Data]:
    said: dict[str, Data] = {"type": _TYPES[parameter.type]}
    if parameter.default is not None:
        said["default_value"] = parameter.default
    if parameter.read_only:
        said["read_only"] = True
    if parameter.description:
        said["description"] = parameter.description
    if checks := dict(_validation(parameter)):
        said["validation"] = checks
    return said


def _validation(parameter: Parameter) -> Iterator[tuple[str, Data]]:
    is_list = parameter.type.is_array
    if parameter.interval is not None:
        yield from _range(parameter.interval, is_list=is_list)
    if parameter.choices is not None:
        yield "subset_of<>" if is_list else "one_of<>", [list(parameter.choices)]
    if parameter.size is not None:
        yield "fixed_size<>", [parameter.size]
    if parameter.min_size is not None and parameter.min_size > 0:
        yield "size_gt<>", [parameter.min_size - 1]
    if parameter.max_size is not None:
        yield "size_lt<>", [parameter.max_size + 1]
    if parameter.not_empty:
        yield "not_empty<>", []
    if parameter.unique:
        yield "unique<>", []
    for function in parameter.custom:
        yield function.text, None


def _range(found: Interval, *, is_list: bool) -> Iterator[tuple[str, Data]]:
    """Yield the functions for a range; those for lists know no open ends."""
    lower, upper = found.lower, found.upper
    has_lower, has_upper = not math.isinf(lower), not math.isinf(upper)
    if has_lower and has_upper and found.lower_closed and found.upper_closed:
        yield "element_bounds<>" if is_list else "bounds<>", [lower, upper]
        return
    if has_lower and found.lower_closed:
        yield "lower_element_bounds<>" if is_list else "gt_eq<>", [lower]
    elif has_lower and not is_list:
        yield "gt<>", [lower]
    if has_upper and found.upper_closed:
        yield "upper_element_bounds<>" if is_list else "lt_eq<>", [upper]
    elif has_upper and not is_list:
        yield "lt<>", [upper]


# What is missing --------------------------------------------------------------------------------


def _missing(node: NodeType) -> Iterator[str]:
    if node.lifecycle:
        yield missing(node.name_span, "'lifecycle'", "is not in the document")
    if node.plugin is not None:
        yield missing(node.plugin.span, f"'plugin {node.plugin}'", "is not in the document")
    if node.takes_any_parameter:
        yield missing(node.name_span, "'parameters open'", "is not in the document")
    for parameter in node.parameters:
        yield from _missing_of(parameter)
    for port in node.ports:
        what = f"{port.kind.word} '{port.name}'"
        if not _fits(port):
            why = "is not in the document, which has no such names"
            yield missing(port.span, f"{what} : {port.type}", why)
            continue
        for word, is_there in (
            ("units", port.units),
            ("frames", port.frames),
            ("'via'", port.via is not None),
            ("'stops after'", port.stops_after_ns is not None),
            ("QoS", port.qos is not None and port.kind in _ACTIONS),
        ):
            if is_there:
                yield missing(port.span, what, f"has {word} that the document does not say")
    for timer in node.timers:
        yield missing(timer.span, f"timer '{timer.name}'", "is not in the document")


def _missing_of(parameter: Parameter) -> Iterator[str]:
    what = f"parameter '{parameter.name}'"
    if parameter.keys:
        why = "is not in the document, which has no parameters for entries of a list"
        yield missing(parameter.span, what, why)
        return
    if parameter.unit is not None:
        why = f"has unit [{parameter.unit}], which the document does not say"
        yield missing(parameter.span, what, why)
    interval = parameter.interval
    if interval is not None and parameter.type.is_array:
        ends = (
            (interval.lower, interval.lower_closed),
            (interval.upper, interval.upper_closed),
        )
        if any(not math.isinf(end) and not is_closed for end, is_closed in ends):
            why = f"has range {interval.spelled()}; the document has no open ends for lists"
            yield missing(parameter.span, what, why)
