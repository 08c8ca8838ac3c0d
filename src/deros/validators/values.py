"""Whether a value fits a parameter: its type, and the constraints of its declaration.

Shared by the defaults of node descriptions and the ``param`` lines of system descriptions.
"""

from __future__ import annotations

from collections.abc import Callable

from deros.metamodels.common import Scalar, Value
from deros.metamodels.node import Parameter, ParameterType

_INT64 = range(-(2**63), 2**63)


def _is_bool(value: Scalar) -> bool:
    return isinstance(value, bool)


def _is_integer(value: Scalar) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value in _INT64


def _is_double(value: Scalar) -> bool:
    # ``0`` stands for 0.0, as every reader expects; the generators write it as a double.
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _is_string(value: Scalar) -> bool:
    return isinstance(value, str)


def _is_byte(value: Scalar) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= 255


_FITS: dict[ParameterType, Callable[[Scalar], bool]] = {
    ParameterType.BOOL: _is_bool,
    ParameterType.INTEGER: _is_integer,
    ParameterType.DOUBLE: _is_double,
    ParameterType.STRING: _is_string,
    ParameterType.BYTE_ARRAY: _is_byte,
    ParameterType.BOOL_ARRAY: _is_bool,
    ParameterType.INTEGER_ARRAY: _is_integer,
    ParameterType.DOUBLE_ARRAY: _is_double,
    ParameterType.STRING_ARRAY: _is_string,
}

_NUMERIC = frozenset(
    {
        ParameterType.INTEGER,
        ParameterType.DOUBLE,
        ParameterType.INTEGER_ARRAY,
        ParameterType.DOUBLE_ARRAY,
    }
)


def is_numeric(kind: ParameterType) -> bool:
    """Tell whether a range (``in [a, b]``) makes sense for parameters of this type."""
    return kind in _NUMERIC


def type_fault(kind: ParameterType, value: Value) -> str | None:
    """Return why ``value`` is no value for a parameter of type ``kind``, or ``None``."""
    fits = _FITS[kind]
    if isinstance(value, tuple):
        if not kind.is_array:
            return f"a list is no {kind.value}"
        wrong = next((element for element in value if not fits(element)), None)
        if wrong is None:
            return None
        return f"{show(wrong)} is no element of {kind.value}{_because(kind, wrong)}"
    if kind.is_array:
        return f"{show(value)} is no list, {kind.value} needs one in brackets"
    return None if fits(value) else f"{show(value)} is no {kind.value}{_because(kind, value)}"


def constraint_fault(parameter: Parameter, value: Value) -> str | None:
    """Return why ``value``, of the right type, breaks the parameter's constraints, or ``None``."""
    elements = value if isinstance(value, tuple) else (value,)
    if parameter.size is not None and len(elements) != parameter.size:
        return f"{len(elements)} elements where the declaration says size {parameter.size}"
    if parameter.interval is not None and is_numeric(parameter.type):
        for element in elements:
            if not isinstance(element, str) and element not in parameter.interval:
                return f"{show(element)} is outside {show_interval(parameter)}"
    if parameter.choices is not None:
        for element in () if value in parameter.choices else elements:
            if element not in parameter.choices:
                return f"{show(element)} is none of {', '.join(map(show, parameter.choices))}"
    return None


def show(value: Value) -> str:
    """Spell a value as the languages do."""
    if isinstance(value, tuple):
        return f"[{', '.join(map(show, value))}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return f'"{value}"'
    return repr(value)


def show_interval(parameter: Parameter) -> str:
    """Spell the range of a parameter, as ``[0.1, 2.0]``."""
    interval = parameter.interval
    assert interval is not None
    left = "[" if interval.lower_closed else "("
    right = "]" if interval.upper_closed else ")"
    return f"{left}{interval.lower}, {interval.upper}{right}"


def _because(kind: ParameterType, value: Scalar) -> str:
    """Name the range of integers where it is what an integer breaks."""
    if isinstance(value, bool) or not isinstance(value, int):
        return ""
    if kind in (ParameterType.INTEGER, ParameterType.INTEGER_ARRAY):
        return " (it needs more than 64 bits)"
    return " (0 to 255)" if kind is ParameterType.BYTE_ARRAY else ""
