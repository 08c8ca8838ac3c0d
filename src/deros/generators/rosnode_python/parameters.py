"""The view of a node's parameters: types, defaults, descriptors, and the checks rclpy lacks."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from deros.generators.names import python_identifier
from deros.generators.parameter_maps import (
    ParameterMap,
    list_names,
    parameter_maps,
    plain_parameters,
)
from deros.generators.parameter_requirements import (
    Check,
    bound,
    integer_bounds,
    interval_clause,
    requirements,
    spelled,
)
from deros.generators.python_source import Call, Text, one_line, wrapped
from deros.metamodels.common import Interval, Name, Scalar
from deros.metamodels.node import NodeType, Parameter, ParameterType

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
_PLAIN_KEY = re.compile(r"[A-Za-z_/][A-Za-z0-9_./-]*")
_YAML_WORDS = frozenset(("true", "false", "yes", "no", "on", "off", "y", "n", "null"))


@dataclass(frozen=True, slots=True)
class Constraint:
    """A check that the client library does not make: a condition on ``value``, what it asks for.

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
    """One parameter as the templates need it.

    Attributes:
        field: its name in the typed structure.
        declaration: the arguments of ``declare_parameter``.
        reading: the argument of ``Parameters`` that reads the value from the node.
        comment: what it is, wrapped, for the structure.
        custom: module and name of each function of the user's that checks the value.
        ranges: the classes of ranges in its descriptor; ``described`` tells whether it has one.
        yaml_key: the name in the parameter file.
        yaml: value for the parameter file; ``None`` where there is none to write, and ``yaml_note``
            says why.
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
    yaml: str | None
    yaml_key: str
    yaml_note: str


@dataclass(frozen=True, slots=True)
class MapView:
    """The parameters of a map as the templates need them.

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
    # The topic's name is read once, at start: a change later would be a promise nobody keeps.
    fixed = {port.via for port in model.ports if port.via is not None} | list_names(model)
    return tuple(_view(p, p.read_only or p.name in fixed) for p in plain_parameters(model))


def map_views(model: NodeType) -> tuple[MapView, ...]:
    """Return the views of the parameters that are declared for each entry of a list."""
    return tuple(_map_view(each, model) for each in parameter_maps(model))


def _map_view(each: ParameterMap, model: NodeType) -> MapView:
    key = model.parameter(each.key)
    assert key is not None
    members = tuple(
        replace(_view(p, p.read_only), field=python_identifier(each.member(p) or "value"))
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
        yaml=_yaml(parameter),
        yaml_key=_yaml_key(parameter.name),
        yaml_note=_yaml_note(parameter),
    )


def custom_function(function: Name) -> tuple[str, str]:
    """Return the module and the name of a function of the user's, ``limits::is_even``."""
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


# Text ---------------------------------------------------------------------------------------------


def describe(parameter: Parameter) -> str:
    """Return the parameter's description with its unit, as ``ros2 param describe`` shows it."""
    text = one_line(parameter.description)
    unit = f"[{parameter.unit}]" if parameter.unit else ""
    return " ".join(part for part in (text, unit) if part)


def comment(parameter: Parameter, read_only: bool) -> str:
    """Return what a comment says of a parameter: description, unit and constraints."""
    parts = [describe(parameter).removesuffix(".")]
    if parameter.interval is not None:
        parts.append(interval_clause(parameter.interval, parameter.type))
    if parameter.choices is not None:
        parts.append(f"one of {_enumeration(parameter)}")
    parts += _size_comments(parameter)
    if read_only:
        parts.append("fixed at start")
    return "; ".join(part for part in parts if part)


def _enumeration(parameter: Parameter) -> str:
    return ", ".join(spelled(choice, parameter.type) for choice in parameter.choices or ())


def _size_comments(parameter: Parameter) -> Iterator[str]:
    what = "elements" if parameter.type.is_array else "characters"
    if parameter.size is not None:
        yield f"{parameter.size} {what}"
    if parameter.min_size is not None:
        yield f"at least {parameter.min_size} {what}"
    if parameter.max_size is not None:
        yield f"at most {parameter.max_size} {what}"
    if parameter.not_empty:
        yield "not empty"
    if parameter.unique:
        yield "no element twice"
    for function in parameter.custom:
        yield f"checked by {function.text}"


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


def _yaml_note(parameter: Parameter) -> str:
    """Say why the parameter file has no value; empty when it has one."""
    if parameter.keys:
        by_default = "" if parameter.default is None else f", {_yaml_value(parameter)} by default"
        return f"for each entry of {parameter.keys[0]}{by_default}"
    if parameter.default is None:
        return "has no default: a value must be given"
    if parameter.default == ():
        return "empty, which a parameter file cannot say"
    if parameter.type is ParameterType.BYTE_ARRAY:
        return "bytes, which a parameter file cannot hold"
    return ""


def _yaml(parameter: Parameter) -> str | None:
    return None if _yaml_note(parameter) else _yaml_value(parameter)


def _yaml_value(parameter: Parameter) -> str:
    if isinstance(parameter.default, tuple):
        return f"[{', '.join(_yaml_scalar(v, parameter.type) for v in parameter.default)}]"
    assert parameter.default is not None
    return _yaml_scalar(parameter.default, parameter.type)


def _yaml_key(name: str) -> str:
    """Return a name as a key, in quotes where YAML could read it as something else."""
    plain = _PLAIN_KEY.fullmatch(name) and name.lower() not in _YAML_WORDS
    return name if plain else f'"{name}"'


def _yaml_scalar(value: Scalar, kind: ParameterType) -> str:
    if isinstance(value, str):
        return f'"{"".join(map(_yaml_character, value))}"'
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float) and not math.isfinite(value):
        return ".nan" if math.isnan(value) else ".inf" if value > 0 else "-.inf"
    return _scalar(value, kind)


def _yaml_character(character: str) -> str:
    if character in '"\\':
        return f"\\{character}"
    return character if character.isprintable() else f"\\U{ord(character):08X}"


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


def custom_texts(parameter: Parameter) -> tuple[str, ...]:
    """Return what the descriptor says of the user's own checks."""
    return tuple(f"must pass {function.text}" for function in parameter.custom)


def _constraints(parameter: Parameter) -> list[Constraint]:
    return [
        Constraint(_condition(each.check, parameter), each.text, each.stated)
        for each in requirements(parameter)
    ]


def _condition(check: Check, parameter: Parameter) -> str:
    """Return the expression that is true of a ``value`` which passes a check."""
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
        choices = ", ".join(_scalar(choice, parameter.type) for choice in parameter.choices)
        comma = "," if len(parameter.choices) == 1 else ""
        condition = f"{element} in ({choices}{comma})"
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
