"""The view of a node's parameters: types, defaults, descriptors, and the checks rclcpp lacks."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from deros.generators.node.parameter_maps import (
    ParameterMap,
    parameter_maps,
    plain_parameters,
)
from deros.generators.node.parameter_requirements import Check as Kind
from deros.generators.node.parameter_requirements import integer_bounds, requirements
from deros.generators.node.parameters import comment, custom_texts, describe, is_fixed
from deros.generators.text.cpp import (
    Call,
    Chain,
    Expression,
    Items,
    Text,
    cpp_double,
    cpp_identifier,
    cpp_int64,
    cpp_string,
)
from deros.models.common import Interval, Scalar, Value
from deros.models.node import NodeType, Parameter, ParameterType

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
_ELEMENTS = {
    ParameterType.BYTE_ARRAY: ParameterType.INTEGER,
    ParameterType.BOOL_ARRAY: ParameterType.BOOL,
    ParameterType.INTEGER_ARRAY: ParameterType.INTEGER,
    ParameterType.DOUBLE_ARRAY: ParameterType.DOUBLE,
    ParameterType.STRING_ARRAY: ParameterType.STRING,
}
_INTEGERS = (ParameterType.INTEGER, ParameterType.INTEGER_ARRAY)


@dataclass(frozen=True, slots=True)
class Check:
    """A check of ``value`` that the descriptor cannot state.

    Attributes:
        prepared: what the condition needs, as head and value of a statement; empty for nothing.
        violated: the condition under which the value is refused.
        requirement: what the check asks for.
        helper: the function that the condition calls, one of ``helpers.hpp.j2``.
    """

    prepared: tuple[str, Expression] | None
    violated: str
    requirement: Text
    helper: str | None = None


@dataclass(frozen=True, slots=True)
class ParameterView:
    """One parameter as the templates need it.

    Attributes:
        literal: the expression of its name; in a map, that for an ``entry``.
        pattern: its name as the model has it, as a C++ text.
        custom: the functions of the user's that check it.
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
    pattern: str
    field: str
    type: str
    default: str
    declared: Expression
    reading: str
    comment: str
    described: tuple[tuple[str, Expression], ...]
    reader: str
    checks: tuple[Check, ...]
    custom: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class MapView:
    """The parameters of a map as the templates need them.

    Attributes:
        field: its name in the typed structure.
        struct: the type of its values, ``None`` where these are values of a parameter.
        shown: what it is for, ``gains.<joints>``.
        entries: the expression of the entries of its list.
        members: its parameters; their ``field`` is that of ``struct``.
    """

    field: str
    struct: str | None
    key: str
    shown: str
    entries: str
    members: tuple[ParameterView, ...]

    @property
    def type(self) -> str:
        """The type of the field."""
        return f"std::map<std::string, {self.struct or self.members[0].type}>"

    @property
    def equal(self) -> Chain:
        """The comparison of two values."""
        fields = [parameter.field for parameter in self.members]
        return Chain("", tuple(f"{name} == other.{name}" for name in fields), " && ")


def cpp_parameter_views(model: NodeType) -> tuple[ParameterView, ...]:
    """Return the views of the parameters that are declared once, in the order written."""
    return tuple(_view(p, is_fixed(p, model)) for p in plain_parameters(model))


def cpp_map_views(model: NodeType) -> tuple[MapView, ...]:
    """Return the views of the parameters that are declared for each entry of a list."""
    return tuple(_map_view(each, model) for each in parameter_maps(model))


def _map_view(each: ParameterMap, model: NodeType) -> MapView:
    members = tuple(
        replace(_view(p, is_fixed(p, model)), field=cpp_identifier(each.member(p) or "value"))
        for p in each.parameters
    )
    entries = f"get_parameter({cpp_string(each.key)}).as_string_array()"
    return MapView(cpp_identifier(each.name), each.struct, each.key, each.shown, entries, members)


def _name(parameter: Parameter) -> str:
    """Return the expression of a parameter's name; in a map, that for an ``entry``."""
    if not parameter.keys:
        return cpp_string(parameter.name)
    before, _, rest = parameter.name.partition("<")
    after = rest.partition(">")[2]
    parts = [cpp_string(before) if before else "", "entry", cpp_string(after) if after else ""]
    return " + ".join(filter(None, parts))


def _view(parameter: Parameter, read_only: bool) -> ParameterView:
    kind = parameter.type
    required = requirements(parameter)
    stated = (*(each.text for each in required if each.stated), *custom_texts(parameter))
    declared: Expression = f"rclcpp::ParameterType::PARAMETER_{kind.name}"
    if parameter.default is not None:
        declared = Call("rclcpp::ParameterValue", (_typed(parameter.default, kind),))
    name = _name(parameter)
    return ParameterView(
        name=parameter.name,
        literal=name,
        pattern=cpp_string(parameter.name),
        field=cpp_identifier(parameter.name),
        type=_TYPES[kind],
        default=_initialiser(parameter),
        declared=declared,
        reading=f"get_parameter({name}).{_READERS[kind]}()",
        comment=comment(parameter, read_only),
        described=tuple(_described(parameter, stated, read_only)),
        reader=_READERS[kind],
        checks=tuple(_check(each.check, each.text, parameter) for each in required),
        custom=tuple(function.text for function in parameter.custom),
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


def _check(kind: Kind, text: str, parameter: Parameter) -> Check:
    """Return the check that refuses a value, as the Python target's requirement does."""
    size = "value.size()" if parameter.type.is_array else "characters(value)"
    helper = None if parameter.type.is_array else "characters"
    least = max(parameter.min_size or 0, int(parameter.not_empty))
    if kind is Kind.MIN_SIZE and least == 1:
        return Check(None, "value.empty()", Text(text))
    sizes = {Kind.SIZE: f"!= {parameter.size}", Kind.MIN_SIZE: f"< {least}"}
    sizes[Kind.MAX_SIZE] = f"> {parameter.max_size}"
    if kind in sizes:
        return Check(None, f"{size} {sizes[kind]}", Text(text), helper)
    if kind is Kind.UNIQUE:
        return Check(None, "has_twice(value)", Text(text), "has_twice")
    return _choices(parameter, text) if kind is Kind.CHOICES else _range(parameter, text)


def _choices(parameter: Parameter, text: str) -> Check:
    kind = parameter.type
    assert parameter.choices is not None
    element = _ELEMENTS.get(kind, kind)
    listed = Items(tuple(_typed(choice, element) for choice in parameter.choices))
    item = "uint8_t" if kind is ParameterType.BYTE_ARRAY else _TYPES[element]
    prepared = (f"const std::vector<{item}> choices =", listed)
    if kind.is_array:
        return Check(prepared, "!are_among(value, choices)", Text(text), "are_among")
    violated = "std::find(choices.begin(), choices.end(), value) == choices.end()"
    return Check(prepared, violated, Text(text))


def _range(parameter: Parameter, text: str) -> Check:
    kind, interval = parameter.type, parameter.interval
    assert interval is not None
    if kind.is_array:
        item = "int64_t" if kind in _INTEGERS else "double"
        test = f"[]({item} item) {{return {_within(interval, kind, 'item')};}}"
        violated = "!std::all_of(value.begin(), value.end(), fits)"
        return Check(("const auto fits =", test), violated, Text(text))
    # A range in the descriptor may say the same, but rclcpp lets NaN and infinity pass it.
    return Check(None, f"!({_within(interval, kind, 'value')})", Text(text))


def _within(interval: Interval, kind: ParameterType, value: str) -> str:
    above = below = "<="
    if kind in _INTEGERS:
        low, high = map(cpp_int64, integer_bounds(interval))
    else:
        low, high = cpp_double(interval.lower), cpp_double(interval.upper)
        above = "<=" if interval.lower_closed else "<"
        below = "<=" if interval.upper_closed else "<"
    from_below = [] if math.isinf(interval.lower) else [f"{low} {above} {value}"]
    from_above = [] if math.isinf(interval.upper) else [f"{value} {below} {high}"]
    return " && ".join([*from_below, *from_above])
