"""The view of a node's parameters: types, defaults, descriptors, and the checks rclpy lacks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from deros.generators.node.parameter_maps import (
    ParameterMap,
    parameter_maps,
    plain_parameters,
)
from deros.generators.node.parameter_requirements import (
    Check,
    bound,
    integer_bounds,
    requirements,
)
from deros.generators.node.parameters import comment, custom_texts, describe, is_fixed
from deros.generators.text.identifiers import python_identifier
from deros.generators.text.python import Call, Text, tuple_entries, wrapped
from deros.models.common import Interval, Name, Scalar
from deros.models.node import NodeType, Parameter, ParameterType

_PYTHON_TYPES = {
    ParameterType.BOOL: "bool",
    ParameterType.INTEGER: "int",
    ParameterType.DOUBLE: "float",
    ParameterType.STRING: "str",
    ParameterType.BYTE_ARRAY: "bytes",
    ParameterType.BOOL_ARRAY: "tuple[bool, ...]",
    ParameterType.INTEGER_ARRAY: "tuple[int, ...]",
    ParameterType.DOUBLE_ARRAY: "tuple[float, ...]",
    ParameterType.STRING_ARRAY: "tuple[str, ...]",
}


@dataclass(frozen=True, slots=True)
class Constraint:
    """A check that the client library does not make: a condition on ``value``, and its text.

    ``stated`` tells whether the descriptor says so in words.
    """

    condition: str
    requirement: str
    stated: bool

    @property
    def entry(self) -> tuple[str, Text]:
        """The pair of test and requirement in the table of the base class."""
        return f"lambda value: {self.condition}", Text("", self.requirement)


@dataclass(frozen=True, slots=True)
class ParameterView:
    """One parameter for the templates.

    Attributes:
        field: its name in the typed structure.
        declaration: the arguments of ``declare_parameter``.
        reading: the argument of ``Parameters`` that reads the value from the node.
        comment: what it is, wrapped, for the structure.
        custom: module and name of each function of the user's that checks the value.
        ranges: the classes of ranges in its descriptor; ``described`` tells whether it has one.
    """

    name: str
    field: str
    python_type: str
    declaration: tuple[str | Call, ...]
    reading: str | Call
    comment: tuple[str, ...]
    described: bool
    ranges: tuple[str, ...]
    constraints: tuple[Constraint, ...]
    custom: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class MapView:
    """The parameters of a map for the templates.

    Attributes:
        field: its name in the typed structure.
        struct: the class of its values, ``None`` where these are values of a parameter.
        shown: what it is for, ``gains.<joints>``.
        entries: the expression of the entries of its list.
        members: its parameters; their ``field`` is that of ``struct``.
        reading: the argument of ``Parameters`` that reads the map from the node.
    """

    field: str
    struct: str | None
    key: str
    shown: str
    entries: str | Call
    members: tuple[ParameterView, ...]
    reading: str | Call

    @property
    def python_type(self) -> str:
        """The type of the field."""
        return f"Mapping[str, {self.struct or self.members[0].python_type}]"


def parameter_views(model: NodeType) -> tuple[ParameterView, ...]:
    """Return the views of the parameters that are declared once, in the order written."""
    return tuple(_view(p, is_fixed(p, model)) for p in plain_parameters(model))


def map_views(model: NodeType) -> tuple[MapView, ...]:
    """Return the views of the parameters that are declared for each entry of a list."""
    return tuple(_map_view(each, model) for each in parameter_maps(model))


def _map_view(each: ParameterMap, model: NodeType) -> MapView:
    key = model.parameter(each.key)
    assert key is not None
    members = tuple(
        replace(_view(p, is_fixed(p, model)), field=python_identifier(each.member(p) or "value"))
        for p in each.parameters
    )
    value: str | Call = members[0].reading
    if each.struct is not None:
        value = Call(each.struct, tuple(_keyword(member) for member in members))
    entries = Call("dict.fromkeys", (_value(key),))
    return MapView(
        field=python_identifier(each.name),
        struct=each.struct,
        key=each.key,
        shown=each.shown,
        entries=entries,
        members=members,
        reading=value,
    )


def _keyword(member: ParameterView) -> str | Call:
    reading = member.reading
    if isinstance(reading, str):
        return f"{member.field}={reading}"
    return replace(reading, head=f"{member.field}={reading.head}")


def _name(parameter: Parameter) -> str:
    """Return the expression of a parameter's name; in a map, that for an ``entry``."""
    return f"f{parameter.name_for('{entry}')!r}" if parameter.keys else repr(parameter.name)


def _view(parameter: Parameter, read_only: bool) -> ParameterView:
    kind = parameter.type
    constraints = tuple(_constraints(parameter))
    descriptor = tuple(_descriptor(parameter, constraints, read_only))
    # rclpy takes an empty sequence for bytes, so it is declared by its type and read as empty.
    empty = parameter.default == ()
    default = f"Parameter.Type.{kind.name}"
    if parameter.default is not None and not empty:
        default = _default(parameter)
    described = (Call("ParameterDescriptor", descriptor),) if descriptor else ()
    return ParameterView(
        name=parameter.name,
        field=python_identifier(parameter.name),
        python_type=_PYTHON_TYPES[kind],
        declaration=(_name(parameter), default, *described),
        reading=_reading(parameter),
        comment=tuple(wrapped(comment(parameter, read_only), indent=6)),
        described=bool(descriptor),
        ranges=tuple(
            name
            for name in ("FloatingPointRange", "IntegerRange")
            if any(isinstance(each, Call) and each.head.endswith(name) for each in descriptor)
        ),
        constraints=constraints,
        custom=tuple(map(custom_function, parameter.custom)),
    )


def custom_function(function: Name) -> tuple[str, str]:
    """Return the module and the name of a user's function, ``limits::is_even``."""
    *scopes, name = function.text.split("::")
    return python_identifier("_".join(scopes)), python_identifier(name)


def _reading(parameter: Parameter) -> str | Call:
    value = _value(parameter)
    if parameter.type is ParameterType.BYTE_ARRAY:
        return Call("b''.join", (value,))
    return Call("tuple", (value,)) if parameter.type.is_array else value


def _value(parameter: Parameter) -> str | Call:
    name = _name(parameter)
    if parameter.default == ():
        otherwise = f"Parameter({name}, Parameter.Type.{parameter.type.name}, [])"
        return Call("self.get_parameter_or", (name, otherwise), ".value")
    return f"self.get_parameter({name}).value"


# Values -------------------------------------------------------------------------------------------


def _scalar(value: Scalar, kind: ParameterType) -> str:
    if kind in (ParameterType.DOUBLE, ParameterType.DOUBLE_ARRAY) and not isinstance(value, str):
        return float_literal(value)
    if kind is ParameterType.BYTE_ARRAY and isinstance(value, int):
        return repr(bytes([value & 0xFF]))
    return repr(value)


def float_literal(value: float) -> str:
    """Return an expression for a float, NaN and the infinities included."""
    text = repr(float(value))
    return text if math.isfinite(value) else f"float({text!r})"


def _default(parameter: Parameter) -> str:
    assert parameter.default is not None
    if isinstance(parameter.default, tuple):
        return f"[{', '.join(_scalar(item, parameter.type) for item in parameter.default)}]"
    return _scalar(parameter.default, parameter.type)


# Descriptors and checks ---------------------------------------------------------------------------


def _descriptor(
    parameter: Parameter, constraints: Sequence[Constraint], read_only: bool
) -> list[str | Text | Call]:
    """Return the arguments of the parameter's ``ParameterDescriptor``."""
    arguments: list[str | Text | Call] = []
    if text := describe(parameter):
        arguments.append(Text("description=", text))
    text = "; ".join([*(c.requirement for c in constraints if c.stated), *custom_texts(parameter)])
    if text:
        arguments.append(Text("additional_constraints=", text))
    if read_only:
        arguments.append("read_only=True")
    interval = parameter.interval
    if interval is not None and parameter.type is ParameterType.DOUBLE:
        lower, upper = float_literal(interval.lower), float_literal(interval.upper)
        bounds = (f"from_value={lower}", f"to_value={upper}")
        arguments.append(Call("floating_point_range=[FloatingPointRange", bounds, "]"))
    if interval is not None and parameter.type is ParameterType.INTEGER:
        low, high = integer_bounds(interval)
        bounds = (f"from_value={low}", f"to_value={high}")
        arguments.append(Call("integer_range=[IntegerRange", bounds, "]"))
    return arguments


def _constraints(parameter: Parameter) -> list[Constraint]:
    return [
        Constraint(_condition(each.check, parameter), each.text, each.stated)
        for each in requirements(parameter)
    ]


def _condition(check: Check, parameter: Parameter) -> str:
    """Return the condition that a ``value`` passes a check."""
    least = max(parameter.min_size or 0, int(parameter.not_empty))
    sizes = {Check.SIZE: f"== {parameter.size}", Check.MIN_SIZE: f">= {least}"}
    sizes[Check.MAX_SIZE] = f"<= {parameter.max_size}"
    if check in sizes:
        return f"len(value) {sizes[check]}"
    if check is Check.UNIQUE:
        if parameter.type is ParameterType.DOUBLE_ARRAY:  # a set would take one NaN for another
            return "all(one != other for one, other in combinations(value, 2))"
        return "len(set(value)) == len(value)"
    element = "item" if parameter.type.is_array else "value"
    if check is Check.CHOICES:
        assert parameter.choices is not None
        choices = tuple_entries(_scalar(choice, parameter.type) for choice in parameter.choices)
        condition = f"{element} in ({', '.join(choices)})"
    else:
        assert parameter.interval is not None
        condition = _within(parameter.interval, parameter.type, element)
    return f"all({condition} for item in value)" if parameter.type.is_array else condition


def _within(interval: Interval, kind: ParameterType, value: str) -> str:
    lower, upper = (bound(each, kind) for each in (interval.lower, interval.upper))
    above = f"{lower} {'<=' if interval.lower_closed else '<'} "
    below = f" {'<=' if interval.upper_closed else '<'} {upper}"
    if math.isinf(interval.lower):
        return f"{value}{below}"
    return f"{above}{value}" if math.isinf(interval.upper) else f"{above}{value}{below}"
