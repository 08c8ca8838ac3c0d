"""Parameters for each entry of a list, ``gains.<joints>.p``, as maps of structs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from deros.generators.text.identifiers import Emitted, camel_case
from deros.models.node import NodeType, Parameter


@dataclass(frozen=True, slots=True)
class ParameterMap:
    """The parameters that one map holds: all of one prefix, for the entries of one list.

    Attributes:
        key: the parameter with the entries.
        prefix: what stands before the entry in the names, ``gains.``.
        parameters: at least one.
    """

    key: str
    prefix: str
    parameters: tuple[Parameter, ...]

    @property
    def name(self) -> str:
        """The name of the map: its prefix, or that of its list if it has none."""
        return self.prefix.strip("._/-") or f"{self.key}_map"

    @property
    def struct(self) -> str | None:
        """The name of the type of a value; ``None`` if the value is a single parameter."""
        if not self.member(self.parameters[0]) and len(self.parameters) == 1:
            return None
        return f"{camel_case(self.prefix)}Of{camel_case(self.key)}".lstrip("_")

    @property
    def shown(self) -> str:
        """The map as readers see it: ``gains.<joints>``."""
        return f"{self.prefix}<{self.key}>"

    def member(self, parameter: Parameter) -> str:
        """Return the part of a parameter's name after the entry, which may be empty."""
        return parameter.name.partition(">")[2].strip("._/-")


def plain_parameters(model: NodeType) -> tuple[Parameter, ...]:
    """Return the parameters that are declared once."""
    return tuple(parameter for parameter in model.parameters if not parameter.keys)


def parameter_maps(model: NodeType) -> tuple[ParameterMap, ...]:
    """Return the maps of a node, in the order of their first parameters."""
    found: dict[tuple[str, str], list[Parameter]] = {}
    for parameter in model.parameters:
        for key in parameter.keys[:1]:
            found.setdefault((key, parameter.name.partition("<")[0]), []).append(parameter)
    return tuple(ParameterMap(*where, tuple(each)) for where, each in found.items())


def map_of(parameter: Parameter, model: NodeType) -> ParameterMap:
    """Return the map that a parameter for each entry of a list is in."""
    return next(each for each in parameter_maps(model) if parameter in each.parameters)


def list_names(model: NodeType) -> frozenset[str]:
    """Return the parameters whose entries others are declared for; they are fixed at start."""
    return frozenset(key for parameter in model.parameters for key in parameter.keys)


def emitted_fields(model: NodeType, identifier: Callable[[str], str]) -> Iterator[Emitted]:
    """Yield the fields of the structure of parameters."""
    for parameter in plain_parameters(model):
        origin = f"parameter {parameter.name!r}"
        yield Emitted(identifier(parameter.name), origin, parameter.name_span)
    for each in parameter_maps(model):
        span = each.parameters[0].name_span
        yield Emitted(identifier(each.name), f"the map {each.shown!r}", span)


def emitted_members(each: ParameterMap, identifier: Callable[[str], str]) -> Iterator[Emitted]:
    """Yield the fields of the values of one map."""
    for parameter in each.parameters:
        name = identifier(each.member(parameter) or "value")
        yield Emitted(name, f"parameter {parameter.name!r}", parameter.name_span)
