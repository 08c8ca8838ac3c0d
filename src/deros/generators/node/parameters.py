"""Comments and descriptors of a node's parameters."""

from __future__ import annotations

from collections.abc import Iterator

from deros.generators.node.parameter_maps import list_names
from deros.generators.node.parameter_requirements import interval_clause, spelled
from deros.generators.text.prose import printable_line
from deros.models.node import NodeType, Parameter


def is_fixed(parameter: Parameter, model: NodeType) -> bool:
    """Return whether a parameter keeps the value that it has at the start.

    The name of a topic is read once, at the start, and so is the list of a map's entries: to
    accept a later change would promise what nobody keeps.
    """
    fixed = {port.via for port in model.ports if port.via is not None} | list_names(model)
    return parameter.read_only or parameter.name in fixed


def describe(parameter: Parameter) -> str:
    """Return the parameter's description with its unit, as ``ros2 param describe`` shows it."""
    text = printable_line(parameter.description)
    unit = f"[{parameter.unit}]" if parameter.unit else ""
    return " ".join(part for part in (text, unit) if part)


def comment(parameter: Parameter, read_only: bool) -> str:
    """Return the comment of a parameter: description, unit and constraints."""
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


def custom_texts(parameter: Parameter) -> tuple[str, ...]:
    """Return the description of the user's checks for the descriptor."""
    return tuple(f"must pass {function.text}" for function in parameter.custom)
