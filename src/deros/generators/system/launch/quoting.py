"""Texts that ``launch_ros`` writes without quotes, and ROS 2 then reads as something else.

PyYAML, which writes the parameters of a node, puts quotes around what it would read otherwise
itself; but ``y`` is no bool to it, and ``1e3`` or ``inf`` no number.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from deros.generators.system.computed import Computed, Setting
from deros.generators.system.programs import NodeView
from deros.metamodels.parameter_files.scalars import is_misread
from deros.models.arguments import Argument, Chosen, Expression, Literally, Lookup, merged
from deros.models.node import Parameter, ParameterType

MISREAD = (
    r"[yn]|[+-]?(?:inf(?:inity)?|nan(?:\(\w*\))?|0x[\da-f.]+(?:p[+-]?\d+)?"
    r"|(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)"
)
"""What ROS 2 reads as a bool or a number, in lower case; PyYAML writes some of it with quotes."""
NO_TEXT = "ROS 2 would read it as a bool or a number"
_OF_NUMBERS = frozenset("0123456789abcdefinptxy+-.")
"""What texts that are misread are made of, in lower case."""


def misread_texts(
    nodes: Iterable[NodeView], arguments: Mapping[str, Parameter]
) -> Iterator[tuple[NodeView, str, str | Computed]]:
    """Yield texts that are misread, or may be, with their nodes and names of parameters."""
    for node in nodes:
        for name, found in node.parameters if node.container is None else ():
            for each in found if isinstance(found, tuple) else (found,):
                if isinstance(each, str | Computed) and may_be_misread(each, arguments):
                    yield node, name, each


def may_be_misread(found: Setting, arguments: Mapping[str, Parameter]) -> bool:
    """Return whether a value is, or may turn out to be, a text that is misread; or has one."""
    if isinstance(found, tuple):
        return any(may_be_misread(each, arguments) for each in found)
    if isinstance(found, bool | int | float):
        return False
    if isinstance(found, str):
        return is_misread(found)
    return found.type is ParameterType.STRING and _may_be(merged(found.pieces), arguments)


def _may_be(pieces: tuple[str | Expression, ...], arguments: Mapping[str, Parameter]) -> bool:
    if len(pieces) == 1:
        return _piece_may_be(pieces[0], arguments)
    texts = (each for each in pieces if isinstance(each, str))
    return all(_OF_NUMBERS.issuperset(each.lower()) for each in texts)


def _piece_may_be(found: str | Expression, arguments: Mapping[str, Parameter]) -> bool:
    match found:
        case str():
            return is_misread(found)
        case Literally(value):
            return is_misread(str(value))
        case Argument(name):
            declared = arguments[name]
            if declared.choices is not None:
                return any(is_misread(str(each)) for each in declared.choices)
            return declared.type is ParameterType.STRING
        case Lookup(function=function):
            return function == "env"  # all others are paths
        case Chosen(chosen=chosen, otherwise=otherwise):
            both = (_may_be(merged((each,)), arguments) for each in (chosen, otherwise))
            return any(both)
    return False  # integers, which stand between quotes
