"""How launch sees values: those of arguments are texts, those of parameters have types."""

from __future__ import annotations

from deros.generators.system.computed import Computed
from deros.models.common import Value
from deros.models.node import Parameter, ParameterType

VALUE_TYPES = {
    ParameterType.BOOL: "bool",
    ParameterType.INTEGER: "int",
    ParameterType.DOUBLE: "float",
    ParameterType.STRING: "str",
}
"""What launch calls the types of parameters."""


def declared(argument: Parameter) -> tuple[str | Computed | None, tuple[str, ...]]:
    """Return default and choices of an argument as texts."""
    choices: tuple[str, ...] = ()
    if argument.type is ParameterType.BOOL:
        choices = ("true", "false")
    elif argument.type is ParameterType.STRING and argument.choices is not None:
        choices = tuple(map(str, argument.choices))
    if argument.default_from is not None:
        return Computed((argument.default_from,)), choices
    return (None if argument.default is None else _text(argument.default)), choices


def _text(value: Value) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
