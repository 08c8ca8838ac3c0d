"""The view of a node's parameters: types, defaults, descriptors, and the checks rclpy lacks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from deros.generators.names import python_identifier
from deros.generators.python_source import Call, Text, one_line, wrapped
from deros.metamodels.common import Interval, Scalar, Value
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
_INT64 = (-(2**63), 2**63 - 1)


@dataclass(frozen=True, slots=True)
class Constraint:
    """A check that the descriptor cannot state: a condition on ``value``, and what it asks for."""

    condition: str
    requirement: str

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
        ranges: the classes of ranges in its descriptor; ``described`` tells whether it has one.
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
    yaml: str | None
    yaml_note: str


def parameter_views(model: NodeType) -> tuple[ParameterView, ...]:
    """Return the views of all parameters, in the order written."""
    # The topic's name is read once, at start: a change later would be a promise nobody keeps.
    topic_names = {port.via for port in model.ports if port.via is not None}
    return tuple(_view(p, p.read_only or p.name in topic_names) for p in model.parameters)


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
        declaration=(repr(parameter.name), default, *described),
        reading=_reading(parameter),
        comment=tuple(wrapped(_comment(parameter, read_only), indent=6)),
        described=bool(descriptor),
        ranges=tuple(
            name
            for name in ("FloatingPointRange", "IntegerRange")
            if any(isinstance(argument, str) and name in argument for argument in descriptor)
        ),
        constraints=constraints,
        yaml=_yaml(parameter),
        yaml_note=_yaml_note(parameter),
    )


def _reading(parameter: Parameter) -> str | Call:
    name = repr(parameter.name)
    kind = parameter.type
    value: str | Call = f"self.get_parameter({name}).value"
    if parameter.default == ():
        otherwise = f"Parameter({name}, Parameter.Type.{kind.name}, [])"
        value = Call("self.get_parameter_or", (name, otherwise), ".value")
    if kind is ParameterType.BYTE_ARRAY:
        return Call("b''.join", (value,))
    return Call("tuple", (value,)) if kind.is_array else value


# Text ---------------------------------------------------------------------------------------------


def describe(parameter: Parameter) -> str:
    """Return the parameter's description with its unit, as ``ros2 param describe`` shows it."""
    text = one_line(parameter.description)
    unit = f"[{parameter.unit}]" if parameter.unit else ""
    return " ".join(part for part in (text, unit) if part)


def _comment(parameter: Parameter, read_only: bool) -> str:
    parts = [describe(parameter).removesuffix(".")]
    if parameter.interval is not None:
        parts.append(f"in {interval_text(parameter.interval, parameter.type)}")
    if parameter.choices is not None:
        parts.append(f"one of {_enumeration(parameter)}")
    if parameter.size is not None:
        parts.append(f"{parameter.size} elements")
    if read_only:
        parts.append("fixed at start")
    return "; ".join(part for part in parts if part)


def interval_text(interval: Interval, kind: ParameterType) -> str:
    """Return an interval as the models write it, ``[0.1, 2.0)``."""
    lower, upper = (_bound(value, kind) for value in (interval.lower, interval.upper))
    opening = "[" if interval.lower_closed else "("
    closing = "]" if interval.upper_closed else ")"
    return f"{opening}{lower}, {upper}{closing}"


def _bound(value: float, kind: ParameterType) -> str:
    integer = kind in (ParameterType.INTEGER, ParameterType.INTEGER_ARRAY)
    return str(int(value)) if integer and float(value).is_integer() else repr(float(value))


def _enumeration(parameter: Parameter) -> str:
    return ", ".join(_literal(choice, parameter.type) for choice in parameter.choices or ())


# Values -------------------------------------------------------------------------------------------


def _literal(value: Value, kind: ParameterType) -> str:
    """Return the Python literal of a value; sequences as tuples, as in the typed structure."""
    if isinstance(value, tuple):
        items = [_scalar(item, kind) for item in value]
        return f"({', '.join(items)}{',' if len(items) == 1 else ''})"
    return _scalar(value, kind)


def _scalar(value: Scalar, kind: ParameterType) -> str:
    if kind in (ParameterType.DOUBLE, ParameterType.DOUBLE_ARRAY) and not isinstance(value, str):
        return repr(float(value))
    if kind is ParameterType.BYTE_ARRAY and isinstance(value, int):
        return repr(bytes([value & 0xFF]))
    return repr(value)


def _default(parameter: Parameter) -> str:
    assert parameter.default is not None
    if isinstance(parameter.default, tuple):
        return f"[{', '.join(_scalar(item, parameter.type) for item in parameter.default)}]"
    return _scalar(parameter.default, parameter.type)


def _yaml_note(parameter: Parameter) -> str:
    """Say why the parameter file has no value; empty when it has one."""
    if parameter.default is None:
        return "has no default: a value must be given"
    if parameter.default == ():
        return "empty, which a parameter file cannot say"
    if parameter.type is ParameterType.BYTE_ARRAY:
        return "bytes, which a parameter file cannot hold"
    return ""


def _yaml(parameter: Parameter) -> str | None:
    if _yaml_note(parameter):
        return None
    if isinstance(parameter.default, tuple):
        return f"[{', '.join(_yaml_scalar(v, parameter.type) for v in parameter.default)}]"
    assert parameter.default is not None
    return _yaml_scalar(parameter.default, parameter.type)


def _yaml_scalar(value: Scalar, kind: ParameterType) -> str:
    if isinstance(value, str):
        return f'"{"".join(map(_yaml_character, value))}"'
    if isinstance(value, bool):
        return "true" if value else "false"
    return _scalar(value, kind)


def _yaml_character(character: str) -> str:
    if character in '"\\':
        return f"\\{character}"
    return character if character.isprintable() else f"\\U{ord(character):08X}"


# Descriptors and checks ---------------------------------------------------------------------------


def _descriptor(
    parameter: Parameter, constraints: Sequence[Constraint], read_only: bool
) -> list[str | Text]:
    """Return the arguments of the parameter's ``ParameterDescriptor``."""
    arguments: list[str | Text] = []
    if text := describe(parameter):
        arguments.append(Text("description=", text))
    if constraints:
        text = "; ".join(constraint.requirement for constraint in constraints)
        arguments.append(Text("additional_constraints=", text))
    if read_only:
        arguments.append("read_only=True")
    interval = parameter.interval
    if interval is not None and parameter.type is ParameterType.DOUBLE:
        bounds = f"from_value={float(interval.lower)!r}, to_value={float(interval.upper)!r}"
        arguments.append(f"floating_point_range=[FloatingPointRange({bounds})]")
    if interval is not None and parameter.type is ParameterType.INTEGER:
        low, high = integer_bounds(interval)
        arguments.append(f"integer_range=[IntegerRange(from_value={low}, to_value={high})]")
    return arguments


def integer_bounds(interval: Interval) -> tuple[int, int]:
    """Return the least and greatest integer of an interval, which closes its open ends exactly."""
    low = math.ceil(max(interval.lower, _INT64[0]))
    high = math.floor(min(interval.upper, _INT64[1]))
    low += low == interval.lower and not interval.lower_closed
    high -= high == interval.upper and not interval.upper_closed
    return max(low, _INT64[0]), min(high, _INT64[1])


def _constraints(parameter: Parameter) -> list[Constraint]:
    found: list[Constraint] = []
    if parameter.size is not None:
        elements = "1 element" if parameter.size == 1 else f"{parameter.size} elements"
        found.append(Constraint(f"len(value) == {parameter.size}", f"must have {elements}"))
    if parameter.choices is not None:
        choices = _enumeration(parameter)
        value = "tuple(value)" if parameter.type.is_array else "value"
        comma = "," if len(parameter.choices) == 1 else ""
        found.append(Constraint(f"{value} in ({choices}{comma})", f"must be one of {choices}"))
    if parameter.interval is not None:
        found.extend(_interval_constraints(parameter.interval, parameter.type))
    return found


def _interval_constraints(interval: Interval, kind: ParameterType) -> list[Constraint]:
    """Return the part of an interval that no range of a descriptor can state.

    The ranges of ``rcl_interfaces`` are closed, and rclpy applies none to arrays.
    """
    text = interval_text(interval, kind)
    lower, upper = (_bound(value, kind) for value in (interval.lower, interval.upper))
    above = f"{lower} {'<=' if interval.lower_closed else '<'} "
    below = f" {'<=' if interval.upper_closed else '<'} {upper}"
    if kind.is_array:
        condition = f"all({above}item{below} for item in value)"
        return [Constraint(condition, f"must have all elements in {text}")]
    if kind is ParameterType.INTEGER or (interval.lower_closed and interval.upper_closed):
        return []
    return [Constraint(f"{above}value{below}", f"must lie in {text}")]
