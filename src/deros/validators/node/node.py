"""Checks of node descriptions: types, names, parameters and their constraints, units of fields."""

from __future__ import annotations

import re
from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.interfaces.store import InterfaceStore
from deros.interfaces.units import UnitRegistry
from deros.models.node import NodeType, Parameter, ParameterType, Port, PortKind
from deros.names.names import (
    check_node_name,
    check_package_name,
    check_parameter_name,
    check_program_name,
    check_timer_name,
    check_topic_name,
)
from deros.validators.findings.context import CheckContext
from deros.validators.findings.hints import did_you_mean
from deros.validators.node.constraints import constraint_findings
from deros.validators.node.field_units import check_field_unit
from deros.validators.node.files import check_defaults
from deros.validators.node.frames import check_frames
from deros.validators.node.interfaces import type_finding
from deros.validators.node.plugins import plugin_findings
from deros.validators.node.values import (
    constraint_fault,
    entry_faults,
    names_in,
    type_fault,
)


def check(node: NodeType, context: CheckContext) -> Iterator[Diagnostic]:
    """Yield all findings of one node description."""
    store = context.store
    units = UnitRegistry()
    yield from _refused(check_node_name(node.name), node.name, node.name_span)
    yield from _refused(check_package_name(node.package), node.package, node.package_span)
    yield from _program(node)
    yield from plugin_findings(node.plugin)
    yield from _duplicates(node)
    for parameter in node.parameters:
        yield from _parameter(node, parameter, units)
        yield from _key(node, parameter)
    yield from check_defaults(node, store)
    for port in node.ports:
        yield from _port(node, port, store, units)
    for timer in node.timers:
        yield from _refused(check_timer_name(timer.name), timer.name, timer.name_span)


def _refused(fault: str | None, name: str, span: Span) -> Iterator[Diagnostic]:
    if fault is not None:
        yield report(codes.INVALID_ROS_NAME, f"ROS 2 rejects the name '{name}': it {fault}", span)


def _program(node: NodeType) -> Iterator[Diagnostic]:
    """Check that the program of an existing node is a plain file name."""
    if node.executable is None:
        return
    fault = check_program_name(node.executable)
    if fault is not None:
        yield report(
            codes.NOT_A_PROGRAM_NAME,
            f"'executable' does not name a program of package '{node.package}': it {fault}",
            node.executable_span or node.name_span,
            hint=f"write the file name alone, as in 'ros2 run {node.package} NAME'",
        )


def _duplicates(node: NodeType) -> Iterator[Diagnostic]:
    """Check that parameters, timers, and the ports of each kind have different names."""
    for word, declared in (
        ("parameter", [(p.name, p.name_span) for p in node.parameters]),
        ("timer", [(t.name, t.name_span) for t in node.timers]),
        *(
            (kind.word, [(p.name.removeprefix("/"), p.name_span) for p in node.ports_of(kind)])
            for kind in PortKind
        ),
    ):
        seen: dict[str, Span] = {}
        for name, span in declared:
            first = seen.setdefault(name, span)
            if first is not span:
                yield report(
                    codes.DUPLICATE_NAME,
                    f"{word} '{name}' is declared twice",
                    span,
                    hint="keep one of the two",
                    related=(Related(first, "the first declaration"),),
                )


# Parameters -------------------------------------------------------------------------------------


def _parameter(node: NodeType, parameter: Parameter, units: UnitRegistry) -> Iterator[Diagnostic]:
    name = re.sub(r"<[^<>]*>", "x", parameter.name)
    yield from _refused(check_parameter_name(name), parameter.name, parameter.name_span)
    faults = list(constraint_findings(parameter, units))
    yield from faults
    if parameter.default is None:
        return
    span = parameter.default_span or parameter.span
    fault = type_fault(parameter.type, parameter.default)
    if fault is not None:
        yield report(
            codes.WRONG_DEFAULT,
            f"default of '{parameter.name}' ({parameter.type.value}): {fault}",
            span,
        )
    elif not faults and (fault := constraint_fault(parameter, parameter.default)) is not None:
        yield report(codes.DEFAULT_OUT_OF_RANGE, f"default of '{parameter.name}': {fault}", span)
    for fault in entry_faults(node, parameter, parameter.default):
        yield report(codes.DEFAULT_OUT_OF_RANGE, f"default of '{parameter.name}': {fault}", span)


def _key(node: NodeType, parameter: Parameter) -> Iterator[Diagnostic]:
    """Check the list that a parameter of the form ``gains.<joints>.p`` refers to."""
    if len(parameter.keys) > 1:
        yield report(
            codes.UNKNOWN_KEY_PARAMETER,
            f"'{parameter.name}' has more than one '<…>'",
            parameter.name_span,
            "a parameter can be declared for the entries of one list only",
        )
        return
    for key in parameter.keys:
        of = node.parameter(key)
        if of is not None and of.type is ParameterType.STRING_ARRAY and not of.keys:
            continue
        lists = [p.name for p in node.parameters if p.type is ParameterType.STRING_ARRAY]
        fault = "is not declared" if of is None else f"is {of.type.value}"
        yield report(
            codes.UNKNOWN_KEY_PARAMETER,
            f"'{parameter.name}' is declared for each entry of '{key}', which {fault}",
            parameter.name_span,
            hint=did_you_mean(key, lists, f"declare it: 'name {key or 'joints'} : string[]'"),
        )


# Ports ------------------------------------------------------------------------------------------


def _port(
    node: NodeType, port: Port, store: InterfaceStore, units: UnitRegistry
) -> Iterator[Diagnostic]:
    yield from _refused(check_topic_name(port.name), port.name, port.name_span)
    missing = list(type_finding(store, port.type, port.type_span))
    yield from missing
    if port.via is not None:
        yield from _via(node, port)
    yield from check_frames(node, port)
    if port.units and not missing and port.kind in (PortKind.PUBLISHER, PortKind.SUBSCRIPTION):
        for annotation in port.units:
            yield from check_field_unit(port.type, annotation, store, units)


def _via(node: NodeType, port: Port) -> Iterator[Diagnostic]:
    assert port.via is not None
    span = port.via_span or port.span
    parameter = node.parameter(port.via)
    if parameter is None:
        names = [p.name for p in node.parameters if _via_fault(p, port.kind) is None]
        mapped = node.parameter_for(port.via)
        if mapped is not None and _via_fault(mapped, port.kind) is None:
            hint = f"write 'via {mapped.name}', for all entries"
        else:
            hint = did_you_mean(port.via, names, f"declare it: 'name {port.via} : string'")
        yield report(
            codes.UNKNOWN_VIA_PARAMETER,
            f"port '{port.name}' takes its name from parameter '{port.via}', which is not declared",
            span,
            hint=hint,
        )
    elif (fault := _via_fault(parameter, port.kind)) is not None:
        hint = "use a string parameter"
        if parameter.keys and parameter.type is ParameterType.STRING:
            hint = (
                "declare a port for each entry, and a string parameter without '<…>' for its name"
            )
        yield report(
            codes.UNKNOWN_VIA_PARAMETER,
            f"parameter '{port.via}' {fault}",
            span,
            hint=hint,
            related=(Related(parameter.span, "declared here"),),
        )
    else:
        place = parameter.default_span or parameter.span
        for name in names_in(parameter.default):
            yield from _refused(check_topic_name(name), name, place)


def _via_fault(parameter: Parameter, kind: PortKind) -> str | None:
    """Return why a parameter cannot name the topics of a port, if it cannot."""
    is_list = parameter.type is ParameterType.STRING_ARRAY
    if not is_list and parameter.type is not ParameterType.STRING:
        return f"is {parameter.type.value} and cannot hold the name of a port"
    if is_list and parameter.keys:
        return (
            f"is {parameter.type.value} for each entry of a list, and a subscription can be one for"
            " each entry of one list only"
        )
    if kind is PortKind.SUBSCRIPTION or not (is_list or parameter.keys):
        return None
    if is_list:
        what = f"is {parameter.type.value}"
        return f"{what}, and only a subscription can be one for each entry of a list"
    return "has a value for each entry of a list, and only a subscription can be one for each"
