"""The parameter file of a node: each parameter with its default."""

from __future__ import annotations

import math
from dataclasses import dataclass

from deros.generators.node.parameter_maps import parameter_maps, plain_parameters
from deros.generators.node.parameters import comment, is_fixed
from deros.generators.text.python import wrapped
from deros.generators.text.yaml import is_plain_key
from deros.models.common import Scalar
from deros.models.node import NodeType, Parameter, ParameterType

_DOUBLES = (ParameterType.DOUBLE, ParameterType.DOUBLE_ARRAY)


@dataclass(frozen=True, slots=True)
class FileParameter:
    """One parameter as the file shows it.

    Attributes:
        key: its name, in quotes where YAML asks for them.
        comment: what it is, in lines.
        value: its default; ``None`` where there is none to write, and ``note`` says why.
    """

    key: str
    comment: tuple[str, ...]
    value: str | None
    note: str


def file_parameters(model: NodeType) -> tuple[FileParameter, ...]:
    """Return the parameters that are declared once, then those of maps, in the order written."""
    plain = [_entry(p, _key(p.name), is_fixed(p, model)) for p in plain_parameters(model)]
    mapped = [
        _entry(parameter, parameter.name, is_fixed(parameter, model))
        for each in parameter_maps(model)
        for parameter in each.parameters
    ]
    return (*plain, *mapped)


def _entry(parameter: Parameter, key: str, fixed: bool) -> FileParameter:
    note = _note(parameter)
    lines = tuple(wrapped(comment(parameter, fixed), indent=6))
    return FileParameter(key, lines, None if note else _value(parameter), note)


def _note(parameter: Parameter) -> str:
    """Return why the parameter file has no value; empty if it has one."""
    if parameter.keys:
        by_default = "" if parameter.default is None else f", {_value(parameter)} by default"
        return f"for each entry of {parameter.keys[0]}{by_default}"
    if parameter.default is None:
        return "has no default: a value must be given"
    if parameter.default == ():
        return "empty, which a parameter file cannot say"
    if parameter.type is ParameterType.BYTE_ARRAY:
        return "bytes, which a parameter file cannot hold"
    return ""


def _value(parameter: Parameter) -> str:
    if isinstance(parameter.default, tuple):
        return f"[{', '.join(_scalar(v, parameter.type) for v in parameter.default)}]"
    assert parameter.default is not None
    return _scalar(parameter.default, parameter.type)


def _key(name: str) -> str:
    """Return a name as a key, in quotes if YAML could read it as something else."""
    return name if is_plain_key(name) else f'"{name}"'


def _scalar(value: Scalar, kind: ParameterType) -> str:
    if isinstance(value, str):
        return f'"{"".join(map(_character, value))}"'
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float) and not math.isfinite(value):
        return ".nan" if math.isnan(value) else ".inf" if value > 0 else "-.inf"
    return repr(float(value)) if kind in _DOUBLES else repr(value)


def _character(character: str) -> str:
    if character in '"\\':
        return f"\\{character}"
    return character if character.isprintable() else f"\\U{ord(character):08X}"
