"""The functions for the fields of commands in C++: finite, zero, limited."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from deros.generators.gate.view import TypeBase
from deros.generators.text.cpp import cpp_header, cpp_string, cpp_type
from deros.interfaces.fields import FieldPath, format_path
from deros.interfaces.message_fields import field_type, unsized_arrays
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType
from deros.rules.compiler.command_types import CommandType, command_types
from deros.rules.program.commands import HEADER


@dataclass(frozen=True, slots=True)
class TypeView(TypeBase):
    """The functions for one type, which are overloaded."""

    @property
    def name(self) -> str:
        """The struct of its messages."""
        return cpp_type(self.type)

    @property
    def header(self) -> str:
        """The header that declares it."""
        return cpp_header(self.type)


@dataclass(frozen=True, slots=True)
class LimitedField:
    """A field with limits.

    Attributes:
        path: its spelling in the rules, and ``literal`` the same in C++.
        base: its primitive type.
        access: what follows the message to name it: ``.linear.x``.
        guards: what has to follow ``message`` to be long enough: ``.data.size() > 2``.
    """

    path: str
    base: str
    access: str
    guards: tuple[str, ...]

    @property
    def literal(self) -> str:
        """The path as a literal."""
        return cpp_string(self.path)

    def guarded(self, message: str) -> tuple[str, ...]:
        """Return the conditions that a message has the field; none if every message has it."""
        return tuple(f"{message}{guard}" for guard in self.guards)


# Whole messages -----------------------------------------------------------------------------------


def type_views(store: InterfaceStore, kind: InterfaceType) -> tuple[TypeView, ...]:
    """Return the views of a message type and of the nested types with numbers, innermost first."""
    views: dict[InterfaceType, TypeView] = {}
    for each in command_types(store, kind):
        finite = tuple(_is_finite(name, field) for name, field in each.finite)
        zeros = tuple(_make_zero(each, name, field, views) for name, field in each.zeros)
        tests = tuple(_is_zero(name, field) for name, field in each.numbers)
        views[each.type] = TypeView(each.type, finite, zeros, tests, each.stamped)
    return tuple(views.values())


def _is_finite(name: str, field: FieldType) -> str:
    place = f"message.{name}"
    if isinstance(field.base, str):
        return f"runtime::all_finite({place})" if field.is_array else f"std::isfinite({place})"
    if field.is_array:
        return f"runtime::are_all({place}, [](const auto & each) {{return is_finite(each);}})"
    return f"is_finite({place})"


def _is_zero(name: str, field: FieldType) -> str:
    place = f"message.{name}"
    if isinstance(field.base, str):
        if field.is_array:
            return f"runtime::all_zero({place})"
        return f"!{place}" if field.base == "bool" else f"{place} == {_zero(field.base)}"
    if field.is_array:
        return f"runtime::are_all({place}, [](const auto & each) {{return is_zero(each);}})"
    return f"is_zero({place})"


def _make_zero(
    command: CommandType, name: str, field: FieldType, views: Mapping[InterfaceType, TypeView]
) -> str:
    place = f"message.{name}"
    if command.is_one(name):
        return f"{place} = 1.0;  // zero would be no rotation at all"
    if isinstance(field.base, str):
        zero = _zero(field.base)
        return f"runtime::fill_with_zeros({place});" if field.is_array else f"{place} = {zero};"
    each = "each" if field.is_array else place
    if field.base == HEADER:
        statement = f"{each}.stamp = stamp;"
    else:
        statement = f"make_zero({each}{', stamp' if views[field.base].stamped else ''});"
    loop = f"for (auto & each : {place}) {{\n    {statement}\n  }}"
    return loop if field.is_array else statement


def _zero(base: str) -> str:
    if base == "bool":
        return "false"
    return {"float32": "0.0F", "float64": "0.0"}.get(base, "0")


# Single fields ------------------------------------------------------------------------------------


def limited_field(store: InterfaceStore, kind: InterfaceType, path: FieldPath) -> LimitedField:
    """Return the view of the field at ``path``."""
    guards = tuple(
        f".{format_path(array)}.size() > {index}"
        for array, index in unsized_arrays(store, kind, path)
    )
    base = field_type(store, kind, path).base
    assert isinstance(base, str), path
    spelt = format_path(path)
    return LimitedField(spelt, base, f".{spelt}", guards)
