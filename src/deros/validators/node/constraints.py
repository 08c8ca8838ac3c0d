"""Checks of the constraints that parameters and arguments are declared with."""

from __future__ import annotations

import re
from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Span, report
from deros.interfaces.units import UnitRegistry
from deros.models.node import Parameter, ParameterType
from deros.validators.node.field_units import unknown_unit
from deros.validators.node.values import is_numeric, outside, show, type_fault


def constraint_findings(parameter: Parameter, units: UnitRegistry) -> Iterator[Diagnostic]:
    """Yield the constraints of a parameter, or of an argument, that contradict it or each other."""
    span = parameter.interval_span or parameter.span
    for fault in _range_faults(parameter):
        yield _bad_constraint(parameter, fault, span)
    for fault in _size_faults(parameter):
        yield _bad_constraint(parameter, fault, parameter.span)
    yield from _unit_faults(parameter, units)
    for fault in _choice_faults(parameter):
        yield _bad_constraint(parameter, f"'one_of' {fault}", parameter.span)
    for function in parameter.custom:
        if _FUNCTION.fullmatch(function.text) is None:
            yield report(
                codes.BAD_CUSTOM_FUNCTION,
                f"constraint of '{parameter.name}': '{function.text}' does not name a function",
                function.span,
                'name the function with its namespace: custom "limits::is_even"',
            )


def _unit_faults(parameter: Parameter, units: UnitRegistry) -> Iterator[Diagnostic]:
    unit, span = parameter.unit, parameter.unit_span or parameter.span
    if unit is None:
        return
    if not is_numeric(parameter.type):
        fault = f"a parameter of type {parameter.type.value} has no unit"
        yield _bad_constraint(parameter, fault, span)
    elif units.parse(unit) is None:
        yield unknown_unit(units, unit, span)


def _range_faults(parameter: Parameter) -> Iterator[str]:
    interval, kind = parameter.interval, parameter.type
    if interval is None:
        return
    if not is_numeric(kind):
        yield f"a range does not apply to {kind.value}; use 'one_of' for a choice of values"
    elif interval.lower > interval.upper:
        yield f"the range runs from {interval.lower} down to {interval.upper}"
    elif interval.is_empty:
        yield f"no number lies in {interval.spelled()}"


def _size_faults(parameter: Parameter) -> Iterator[str]:
    """Yield sizes of values without a size, and sizes that contradict each other."""
    kind = parameter.type
    has_size = kind.is_array or kind is ParameterType.STRING
    sizes = {
        "size": parameter.size,
        "min_size": parameter.min_size,
        "max_size": parameter.max_size,
        "not_empty": parameter.not_empty or None,
    }
    stated = [word for word, value in sizes.items() if value is not None]
    if not has_size:
        for word in stated:
            yield f"'{word}' applies to lists and strings, not to {kind.value}"
    if parameter.unique and not kind.is_array:
        yield f"'unique' applies to lists, not to {kind.value}"
    most = [each for each in (parameter.size, parameter.max_size) if each is not None]
    if has_size and most and parameter.least_size > min(most):
        yield f"{', '.join(map(repr, stated))} contradict each other: no size satisfies all of them"


def _choice_faults(parameter: Parameter) -> Iterator[str]:
    if parameter.choices is None:
        return
    if not parameter.choices:
        yield "lists no values"
    element = _ELEMENT.get(parameter.type, parameter.type)
    for choice in parameter.choices:
        wrong = type_fault(element, choice)
        if wrong is not None:
            yield f"has a value of another type: {wrong}"
        elif choice != choice:  # only nan is
            yield "has nan, which equals no value"
        elif (
            parameter.interval is not None
            and not isinstance(choice, str)
            and choice not in parameter.interval
        ):
            yield f"has {show(choice)}, which is {outside(parameter)}"


_FUNCTION = re.compile(r"[A-Za-z_]\w*(?:::[A-Za-z_]\w*)+", re.ASCII)
_ELEMENT = {
    ParameterType.BYTE_ARRAY: ParameterType.INTEGER,
    ParameterType.BOOL_ARRAY: ParameterType.BOOL,
    ParameterType.INTEGER_ARRAY: ParameterType.INTEGER,
    ParameterType.DOUBLE_ARRAY: ParameterType.DOUBLE,
    ParameterType.STRING_ARRAY: ParameterType.STRING,
}


def _bad_constraint(parameter: Parameter, fault: str, span: Span) -> Diagnostic:
    return report(codes.BAD_CONSTRAINT, f"constraint of '{parameter.name}': {fault}", span)
