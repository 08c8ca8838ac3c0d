"""Checks of node descriptions: types, names, parameters and their constraints, units of fields."""

from __future__ import annotations

import re
from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.interfaces import names, rep103
from deros.interfaces.fields import FieldError, resolve
from deros.interfaces.names import (
    check_node_name,
    check_package_name,
    check_parameter_name,
    check_program_name,
    check_topic_name,
)
from deros.interfaces.store import InterfaceStore
from deros.interfaces.units import UnitRegistry
from deros.metamodels.node import FieldUnit, NodeType, Parameter, ParameterType, Port, PortKind
from deros.validators.hints import did_you_mean
from deros.validators.interfaces import type_finding
from deros.validators.values import constraint_fault, is_numeric, type_fault


def check_node(node: NodeType, store: InterfaceStore) -> Iterator[Diagnostic]:
    """Yield all findings of one node description."""
    units = UnitRegistry()
    yield from _refused(check_node_name(node.name), node.name, node.name_span)
    yield from _refused(check_package_name(node.package), node.package, node.package_span)
    yield from _program(node)
    yield from _duplicates(node)
    for parameter in node.parameters:
        yield from _parameter(parameter, units)
    for port in node.ports:
        yield from _port(node, port, store, units)
    for timer in node.timers:
        yield from _refused(check_parameter_name(timer.name), timer.name, timer.name_span)


def _refused(fault: str | None, name: str, span: Span) -> Iterator[Diagnostic]:
    if fault is not None:
        yield report(codes.INVALID_ROS_NAME, f"ROS 2 refuses the name '{name}': it {fault}", span)


def _program(node: NodeType) -> Iterator[Diagnostic]:
    """The program of an existing node is a file of its package, never another one."""
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
    """Names must differ among parameters, among timers, and among ports (whatever their kind).

    One topic may be both published and subscribed by a node; a wiring could not tell the two apart,
    so it has to be named apart in the description.
    """
    for word, declared in (
        ("parameter", [(p.name, p.name_span) for p in node.parameters]),
        ("port", [(p.name.removeprefix("/"), p.name_span) for p in node.ports]),
        ("timer", [(t.name, t.name_span) for t in node.timers]),
    ):
        seen: dict[str, Span] = {}
        for name, span in declared:
            first = seen.setdefault(name, span)
            if first is not span:
                yield report(
                    codes.DUPLICATE_NAME,
                    f"{word} '{name}' is declared twice",
                    span,
                    hint="rename one of the two: wirings know a port by its name alone"
                    if word == "port"
                    else "keep one of the two",
                    related=(Related(first, "the first declaration"),),
                )


# Parameters -------------------------------------------------------------------------------------


def _parameter(parameter: Parameter, units: UnitRegistry) -> Iterator[Diagnostic]:
    yield from _refused(check_parameter_name(parameter.name), parameter.name, parameter.name_span)
    if parameter.unit is not None and units.parse(parameter.unit) is None:
        yield _unknown_unit(units, parameter.unit, parameter.unit_span or parameter.span)
    faults = list(_constraints(parameter))
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


def _constraints(parameter: Parameter) -> Iterator[Diagnostic]:
    kind = parameter.type
    fault: str | None = None
    span = parameter.interval_span or parameter.span
    if parameter.interval is not None:
        if not is_numeric(kind):
            fault = f"a range says nothing of {kind.value}; use 'one_of' for a choice of values"
        elif parameter.interval.lower > parameter.interval.upper:
            fault = (
                f"the range runs from {parameter.interval.lower} down to {parameter.interval.upper}"
            )
        if fault is not None:
            yield _bad_constraint(parameter, fault, span)
    if parameter.size is not None and not kind.is_array:
        yield _bad_constraint(
            parameter, f"'size' is for lists, and {kind.value} is none", parameter.span
        )
    if parameter.unit is not None and not is_numeric(kind):
        yield _bad_constraint(
            parameter, f"{kind.value} has no unit", parameter.unit_span or parameter.span
        )
    if parameter.choices is not None:
        element = _ELEMENT.get(kind, kind)
        for choice in parameter.choices:
            wrong = type_fault(kind if isinstance(choice, tuple) else element, choice)
            if wrong is not None:
                yield _bad_constraint(parameter, f"'one_of': {wrong}", parameter.span)
        if not parameter.choices:
            yield _bad_constraint(parameter, "'one_of' leaves no value", parameter.span)


_ELEMENT = {
    ParameterType.BYTE_ARRAY: ParameterType.INTEGER,
    ParameterType.BOOL_ARRAY: ParameterType.BOOL,
    ParameterType.INTEGER_ARRAY: ParameterType.INTEGER,
    ParameterType.DOUBLE_ARRAY: ParameterType.DOUBLE,
    ParameterType.STRING_ARRAY: ParameterType.STRING,
}


def _bad_constraint(parameter: Parameter, fault: str, span: Span) -> Diagnostic:
    return report(codes.BAD_CONSTRAINT, f"constraint of '{parameter.name}': {fault}", span)


def _unknown_unit(units: UnitRegistry, text: str, span: Span) -> Diagnostic:
    return report(
        codes.UNKNOWN_UNIT,
        f"unknown unit '{text}'",
        span,
        hint=names.did_you_mean(units.suggest(text)),
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
    if port.units and not missing and port.kind in (PortKind.PUBLISHER, PortKind.SUBSCRIPTION):
        for annotation in port.units:
            yield from _field_unit(port, annotation, store, units)


def _via(node: NodeType, port: Port) -> Iterator[Diagnostic]:
    assert port.via is not None
    span = port.via_span or port.span
    parameter = node.parameter(port.via)
    if parameter is None:
        strings = [p.name for p in node.parameters if p.type is ParameterType.STRING]
        yield report(
            codes.UNKNOWN_VIA_PARAMETER,
            f"port '{port.name}' takes its name from parameter '{port.via}', which is not declared",
            span,
            hint=did_you_mean(port.via, strings, f"declare it: 'name {port.via} : string'"),
        )
    elif parameter.type is not ParameterType.STRING:
        yield report(
            codes.UNKNOWN_VIA_PARAMETER,
            f"parameter '{port.via}' is {parameter.type.value} and cannot hold the name of a port",
            span,
            hint="a topic's name is a string",
            related=(Related(parameter.span, "declared here"),),
        )
    elif isinstance(parameter.default, str) and parameter.default:
        place = parameter.default_span or parameter.span
        yield from _refused(check_topic_name(parameter.default), parameter.default, place)


def _field_unit(
    port: Port, annotation: FieldUnit, store: InterfaceStore, units: UnitRegistry
) -> Iterator[Diagnostic]:
    path = _parts(annotation.path)
    found = resolve(store, port.type, path)
    if isinstance(found, FieldError):
        yield report(
            codes.UNKNOWN_FIELD_OF_PORT,
            f"{port.type.short}: {found.message}",
            annotation.span,
            hint=names.did_you_mean(found.candidates),
        )
    unit = units.parse(annotation.unit)
    if unit is None:
        yield _unknown_unit(units, annotation.unit, annotation.unit_span)
        return
    usual = rep103.unit_of(store, port.type, path)
    expected = units.parse(usual) if usual is not None else None
    if expected is not None and not units.compatible(unit, expected):
        yield report(
            codes.UNIT_CONFLICTS_WITH_REP103,
            f"'{annotation.path}' of {port.type.short} is in {expected.text} by REP 103, "
            f"which {unit.text} does not measure",
            annotation.unit_span,
            hint=f"publish the field in {expected.text}, and leave the unit out",
        )


def _parts(path: str) -> tuple[str | int, ...]:
    """Split a field path as written, ``covariance[3]`` becoming ``("covariance", 3)``."""
    return tuple(int(part) if part.isdecimal() else part for part in re.findall(r"\w+", path))
