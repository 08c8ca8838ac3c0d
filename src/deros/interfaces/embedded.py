"""The definitions that deros knows without ROS 2 on the machine.

Messages come from rosbags' Jazzy type store. It has no services, no actions and no default values;
``embedded.json`` adds those that are used most.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deros.interfaces.definitions import DefinitionError, parse_definition
from deros.interfaces.types import (
    PRIMITIVES,
    STRING_TYPES,
    Constant,
    FieldType,
    InterfaceKind,
    InterfaceType,
    MessageDefinition,
)

if TYPE_CHECKING:
    from deros.interfaces.sources import Definition

# The member that an IDL structure must have, where the .msg file has none.
_PLACEHOLDER = "structure_needs_at_least_one_member"


class EmbeddedSource:
    """The embedded definitions as a source."""

    def has_package(self, package: str) -> bool:
        """Return whether any interface of ``package`` is embedded."""
        return package in self.packages()

    def packages(self) -> frozenset[str]:
        """Return the embedded packages."""
        return _packages()

    def names(self, package: str, kind: InterfaceKind) -> frozenset[str]:
        """Return the names of the package's embedded interfaces of one kind."""
        return _names().get((package, kind), frozenset())

    def definition(self, kind: InterfaceType) -> Definition:
        """Return the embedded definition of ``kind``, or ``None``."""
        text = _supplement()["definitions"].get(str(kind))
        if text is not None:
            found = parse_definition(kind, text)
            assert not isinstance(found, DefinitionError), f"{kind}: {found}"
            return found
        fields = _rosbags().get(str(kind))
        return None if fields is None else (_from_rosbags(kind, fields),)

    def inputs(self) -> tuple[Path, ...]:
        """Return nothing: the embedded definitions are part of deros."""
        return ()


def _from_rosbags(kind: InterfaceType, definition: Any) -> MessageDefinition:
    constants, fields = definition
    return MessageDefinition(
        kind,
        tuple((name, _field_type(what)) for name, what in fields if name != _PLACEHOLDER),
        tuple(Constant(name, base, value) for name, base, value in constants),
        _supplement()["defaults"].get(str(kind), {}),
    )


def _field_type(description: Any) -> FieldType:
    """Translate rosbags' ``(node type, argument)``: BASE, NAME, or ARRAY and SEQUENCE of these."""
    node, argument = description
    if node.name in ("ARRAY", "SEQUENCE"):
        element, size = argument
        base = _field_type(element)
        bounded = "bounded" if size else "unbounded"
        array = "fixed" if node.name == "ARRAY" else bounded
        return FieldType(base.base, array, size or None, base.string_bound)  # type: ignore[arg-type]
    if node.name == "NAME":
        package, _, name = argument.split("/")
        return FieldType(InterfaceType(package, "msg", name))
    base_name, bound = argument
    assert base_name in PRIMITIVES, base_name
    return FieldType(base_name, string_bound=bound or None if base_name in STRING_TYPES else None)


@cache
def _rosbags() -> Mapping[str, Any]:
    # Loading the store takes a tenth of a second, mostly its message classes.
    from rosbags.typesys.stores.ros2_jazzy import FIELDDEFS

    return FIELDDEFS


@cache
def _supplement() -> dict[str, Any]:
    text = Path(__file__).with_name("embedded.json").read_text(encoding="utf-8")
    supplement: dict[str, Any] = json.loads(text)
    return supplement


@cache
def _names() -> dict[tuple[str, str], frozenset[str]]:
    grouped: dict[tuple[str, str], set[str]] = {}
    for full_name in [*_rosbags(), *_supplement()["definitions"]]:
        package, kind, name = full_name.split("/")
        grouped.setdefault((package, kind), set()).add(name)
    return {key: frozenset(names) for key, names in grouped.items()}


@cache
def _packages() -> frozenset[str]:
    return frozenset(package for package, _ in _names())
