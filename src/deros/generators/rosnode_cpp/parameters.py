"""The view of a node's parameters: types, defaults, descriptors, and the checks rclcpp lacks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deros.generators.cpp_source import (
    Call,
    Expression,
    Items,
    Text,
    cpp_double,
    cpp_identifier,
    cpp_int64,
    cpp_string,
)
from deros.generators.rosnode_python.parameters import ParameterView as SharedView
from deros.generators.rosnode_python.parameters import (
    describe,
    integer_bounds,
    interval_text,
    parameter_views,
)
from deros.metamodels.common import Interval, Scalar, Value
from deros.metamodels.node import NodeType, Parameter, ParameterType

_TYPES = {
    ParameterType.BOOL: "bool",
    ParameterType.INTEGER: "int64_t",
    ParameterType.DOUBLE: "double",
    ParameterType.STRING: "std::string",
    ParameterType.BYTE_ARRAY: "std::vector<uint8_t>",
    ParameterType.BOOL_ARRAY: "std::vector<bool>",
    ParameterType.INTEGER_ARRAY: "std::vector<int64_t>",
    ParameterType.DOUBLE_ARRAY: "std::vector<double>",
    ParameterType.STRING_ARRAY: "std::vector<std::string>",
}
_READERS = {
    ParameterType.BOOL: "as_bool",
    ParameterType.INTEGER: "as_int",
    ParameterType.DOUBLE: "as_double",
    ParameterType.STRING: "as_string",
    ParameterType.BYTE_ARRAY: "as_byte_array",
    ParameterType.BOOL_ARRAY: "as_bool_array",
    ParameterType.INTEGER_ARRAY: "as_integer_array",
    ParameterType.DOUBLE_ARRAY: "as_double_array",
    ParameterType.STRING_ARRAY: "as_string_array",
}
_INTEGERS = (ParameterType.INTEGER, ParameterType.INTEGER_ARRAY)


@dataclass(frozen=True, slots=True)
class Check:
    """A check of ``value`` that the descriptor cannot state.

    Attributes:
        prepared: what the condition needs, as head and value of a statement; empty for nothing.
        violated: the condition under which the value is refused.
        requirement: what the check asks for.
    """

    prepared: tuple[str, Expression] | None
    violated: str
    requirement: Text


@dataclass(frozen=True, slots=True)
class ParameterView:
    """One parameter as the templates need it.

    Attributes:
        literal: its name as a C++ text.
        field: its name in the typed structure.
        default: the initialiser of the field; ``{}`` where the model gives no default.
        declared: the second argument of ``declare_parameter``.
        reading: what reads the value from the node.
        comment: what it is, for the structure.
        described: statements that fill in the descriptor ``about``; head and value of each.
        reader: the method of ``rclcpp::Parameter`` that gives the value.
    """

    name: str
    literal: str
    field: str
    type: str
    default: str
    declared: Expression
    reading: str
    comment: str
    described: tuple[tuple[str, Expression], ...]
    reader: str
    checks: tuple[Check, ...]


def cpp_parameter_views(model: NodeType) -> tuple[ParameterView, ...]:
    """Return the views of all parameters, in the order written."""
    shared = parameter_views(model)
    topic_names = {port.via for port in model.ports if port.via is not None}
    return tuple(
        _view(parameter, other, parameter.read_only or parameter.name in topic_names)
        for parameter, other in zip(model.parameters, shared, strict=True)
    )


def _view(parameter: Parameter, shared: SharedView, read_only: bool) -> ParameterView:
    kind = parameter.type
    literal = cpp_string(parameter.name)
    requirements = tuple(constraint.requirement for constraint in shared.constraints)
    checks = [
        Check(prepared, violated, Text(requirement))
        for (prepared, violated), requirement in zip(
            _violations(parameter), requirements, strict=True
        )
    ]
    if parameter.interval is not None and kind is ParameterType.DOUBLE:
        # The range in the descriptor says the same, but rclcpp lets NaN and infinity pass it.
        violated = f"!({_within(parameter.interval, kind, 'value')})"
        text = f"must lie in {interval_text(parameter.interval, kind)}"
        if text not in requirements:
            checks.append(Check(None, violated, Text(text)))
    declared: Expression = f"rclcpp::ParameterType::PARAMETER_{kind.name}"
    if parameter.default is not None:
        declared = Call("rclcpp::ParameterValue", (_typed(parameter.default, kind),))
    return ParameterView(
        name=parameter.name,
        literal=literal,
        field=cpp_identifier(parameter.name),
        type=_TYPES[kind],
        default=_initialiser(parameter),
        declared=declared,
        reading=f"get_parameter({literal}).{_READERS[kind]}()",
        comment=" ".join(shared.comment),
        described=tuple(_described(parameter, requirements, read_only)),
        reader=_READERS[kind],
        checks=tuple(checks),
    )


# Values -------------------------------------------------------------------------------------------


def _scalar(value: Scalar, kind: ParameterType) -> str:
    if isinstance(value, str):
        return cpp_string(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if kind in (ParameterType.DOUBLE, ParameterType.DOUBLE_ARRAY):
        return cpp_double(value)
    return cpp_int64(int(value)) if kind in _INTEGERS else str(int(value))


def _items(value: Value, kind: ParameterType) -> str:
    assert isinstance(value, tuple)
    return f"{{{', '.join(_scalar(item, kind) for item in value)}}}"


def _typed(value: Value, kind: ParameterType) -> str:
    """Return a value as an expression of the parameter's own type."""
    if kind.is_array:
        return f"{_TYPES[kind]}{_items(value, kind)}"
    assert not isinstance(value, tuple)
    text = _scalar(value, kind)
    return f"int64_t{{{text}}}" if kind is ParameterType.INTEGER else text


def _initialiser(parameter: Parameter) -> str:
    if parameter.default is None:
        return "{}"
    if parameter.type.is_array:
        return _items(parameter.default, parameter.type)
    assert not isinstance(parameter.default, tuple)
    return f"{{{_scalar(parameter.default, parameter.type)}}}"


# Descriptors and checks ---------------------------------------------------------------------------


def _described(
    parameter: Parameter, requirements: tuple[str, ...], read_only: bool
) -> Iterator[tuple[str, Expression]]:
    if text := describe(parameter):
        yield "about.description =", Text(text)
    if requirements:
        yield "about.additional_constraints =", Text("; ".join(requirements))
    if read_only:
        yield "about.read_only =", "true"
    interval = parameter.interval
    if interval is None or parameter.type.is_array:
        return
    if parameter.type is ParameterType.DOUBLE:
        name = "about.floating_point_range"
        low, high = cpp_double(interval.lower), cpp_double(interval.upper)
    else:
        name = "about.integer_range"
        low, high = map(cpp_int64, integer_bounds(interval))
    yield "", f"{name}.resize(1)"
    yield f"{name}[0].from_value =", low
    yield f"{name}[0].to_value =", high


def _violations(parameter: Parameter) -> Iterator[tuple[tuple[str, Expression] | None, str]]:
    """Yield what refuses a value, in the order of the Python target's requirements."""
    kind = parameter.type
    if parameter.size is not None:
        yield None, f"value.size() != {parameter.size}"
    if parameter.choices is not None:
        listed = Items(tuple(_typed(choice, kind) for choice in parameter.choices))
        yield (
            (f"const std::vector<{_TYPES[kind]}> choices =", listed),
            "std::find(choices.begin(), choices.end(), value) == choices.end()",
        )
    interval = parameter.interval
    if interval is None:
        return
    if kind.is_array:
        item = "int64_t" if kind in _INTEGERS else "double"
        test = f"[]({item} item) {{return {_within(interval, kind, 'item')};}}"
        yield ("const auto fits =", test), "!std::all_of(value.begin(), value.end(), fits)"
    elif kind is ParameterType.DOUBLE and not (interval.lower_closed and interval.upper_closed):
        yield None, f"!({_within(interval, kind, 'value')})"


def _within(interval: Interval, kind: ParameterType, value: str) -> str:
    if kind in _INTEGERS:
        low, high = map(cpp_int64, integer_bounds(interval))
        return f"{low} <= {value} && {value} <= {high}"
    low, high = cpp_double(interval.lower), cpp_double(interval.upper)
    above = "<=" if interval.lower_closed else "<"
    below = "<=" if interval.upper_closed else "<"
    return f"{low} {above} {value} && {value} {below} {high}"
