"""Checks of parameter values: type, and constraints of the declaration.

Shared by the defaults of node descriptions and the ``param`` lines of system descriptions.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from itertools import combinations

from deros.interfaces.types import INT64
from deros.models.common import Scalar, Value
from deros.models.node import NodeType, Parameter, ParameterType
from deros.names.names import check_parameter_name


def _is_bool(value: Scalar) -> bool:
    return isinstance(value, bool)


def _is_integer(value: Scalar) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value in INT64


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
    """Return whether a range (``in [a, b]``) makes sense for parameters of this type."""
    return kind in _NUMERIC


def type_fault(kind: ParameterType, value: Value) -> str | None:
    """Return why ``value`` is not of the parameter type ``kind``, or ``None``."""
    fits = _FITS[kind]
    if isinstance(value, tuple):
        if not kind.is_array:
            return f"a list is not of type {kind.value}"
        wrong = next((element for element in value if not fits(element)), None)
        if wrong is None:
            return None
        return f"{show(wrong)} is not an element of {kind.value}{_because(kind, wrong)}"
    if kind.is_array:
        return f"{show(value)} is not a list; {kind.value} needs a list in brackets"
    return (
        None if fits(value) else f"{show(value)} is not of type {kind.value}{_because(kind, value)}"
    )


def file_type_fault(kind: ParameterType, value: Value) -> str | None:
    """Return why a value of a parameter file, else of type ``kind``, is not of it for a node.

    In a file, nobody makes a double of an integer, and no spelling makes a list of bytes.
    """
    if kind is ParameterType.BYTE_ARRAY:
        return f"{show(value)} is a list of integers, and a file has no spelling for {kind.value}"
    values = value if isinstance(value, tuple) else (value,)
    if kind in (ParameterType.DOUBLE, ParameterType.DOUBLE_ARRAY):
        wrong = next((each for each in values if isinstance(each, int)), None)
        if wrong is not None:
            return f"{wrong} is an integer, and ROS 2 ends a node that gets one for a double"
    return None


def constraint_fault(parameter: Parameter, value: Value) -> str | None:
    """Return why ``value``, of the right type, breaks the parameter's constraints, or ``None``."""
    elements = value if isinstance(value, tuple) else (value,)
    fault = _size_fault(parameter, value)
    if fault is not None:
        return fault
    if parameter.unique:
        twice = next((one for one, other in combinations(elements, 2) if one == other), None)
        if twice is not None:
            return f"{show(twice)} occurs twice, but the declaration says unique"
    if parameter.interval is not None and is_numeric(parameter.type):
        for element in elements:
            if not isinstance(element, str) and element not in parameter.interval:
                return f"{show(element)} is {outside(parameter)}"
    if parameter.choices is not None:
        for element in elements:
            if element not in parameter.choices:
                return f"{show(element)} is not one of {', '.join(map(show, parameter.choices))}"
    return None


def entry_faults(node: NodeType, key: Parameter, value: Value) -> Iterator[str]:
    """Yield why entries of a list cannot name the parameters that are declared for each of them."""
    if not isinstance(value, tuple):
        return
    declared = [parameter for parameter in node.parameters if parameter.keys == (key.name,)]
    if not declared:
        return
    entries = Counter(entry for entry in value if isinstance(entry, str))
    twice = sorted(entry for entry, count in entries.items() if count > 1)
    for entry in twice:
        yield f"the entry {show(entry)} occurs twice, and both name '{declared[0].name_for(entry)}'"
    for entry in entries:
        for parameter in declared:
            name = parameter.name_for(entry)
            why = check_parameter_name(name)
            if why is not None:
                yield f"the entry {show(entry)} names the parameter '{name}', which {why}"
            elif node.parameter(name) is not None:
                yield f"the entry {show(entry)} names '{name}', which is declared separately"


def _size_fault(parameter: Parameter, value: Value) -> str | None:
    """Compare the number of elements of a list, or of characters of a text, with what it may be."""
    if not isinstance(value, (tuple, str)):
        return None
    size = len(value)
    has = f"it has {size} {'elements' if isinstance(value, tuple) else 'characters'}"
    if parameter.size is not None and size != parameter.size:
        return f"{has}, but the declaration says size {parameter.size}"
    if parameter.not_empty and not size:
        return "it is empty, but the declaration says not_empty"
    if parameter.min_size is not None and size < parameter.min_size:
        return f"{has}, but the declaration says min_size {parameter.min_size}"
    if parameter.max_size is not None and size > parameter.max_size:
        return f"{has}, but the declaration says max_size {parameter.max_size}"
    return None


def show(value: Value) -> str:
    """Return a value in the notation of the languages."""
    if isinstance(value, tuple):
        return f"[{', '.join(map(show, value))}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return f'"{value}"'
    return repr(value)


def outside(parameter: Parameter) -> str:
    """Return in words how a number violates the range of a parameter."""
    interval = parameter.interval
    assert interval is not None
    return f"{'not' if interval.one_sided else 'outside'} {interval.spelled()}"


def _because(kind: ParameterType, value: Scalar) -> str:
    """Return the range of integers if an integer violates it."""
    if isinstance(value, bool) or not isinstance(value, int):
        return ""
    if kind in (ParameterType.INTEGER, ParameterType.INTEGER_ARRAY):
        return " (it needs more than 64 bits)"
    return " (0 to 255)" if kind is ParameterType.BYTE_ARRAY else ""


def names_in(value: Value | None) -> tuple[str, ...]:
    """Return the names that the value of a parameter holds which names topics.

    An empty text is the port's own name; in a list, it is a name that ROS 2 rejects.
    """
    if isinstance(value, tuple):
        return tuple(each for each in value if isinstance(each, str))
    return (value,) if isinstance(value, str) and value else ()


def value_hint(kind: ParameterType, value: Value) -> str:
    """Return a hint for common mistakes: quotes, or a fraction."""
    if kind is ParameterType.STRING and not isinstance(value, tuple):
        return "put the text in quotes"
    if kind is ParameterType.DOUBLE and type(value) is int:
        return f"write '{float(value)}'"
    if kind is ParameterType.DOUBLE_ARRAY and isinstance(value, tuple):
        return "write each number with a point, '1.0'" if all(map(_is_integer, value)) else ""
    if isinstance(value, str) and kind is not ParameterType.STRING and not kind.is_array:
        return "write the value without quotes"
    if kind is ParameterType.INTEGER and isinstance(value, float):
        return "an integer has no fraction"
    return ""
