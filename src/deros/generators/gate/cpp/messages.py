"""The functions for the fields of commands in C++: finite, zero, limited, sent."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from deros.generators.gate.view import SendWords, TypeBase
from deros.generators.text.cpp import cpp_header, cpp_string, cpp_type
from deros.generators.text.cpp_fields import scalar
from deros.interfaces.fields import format_path
from deros.interfaces.message_fields import field_type, unsized_arrays
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType
from deros.rules.compiler.gates.command_types import CommandType, command_types
from deros.rules.gates.gate_table import numbered_paths
from deros.rules.program.commands import HEADER
from deros.rules.program.ir import Gate, Scalar


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
class NumberField:
    """A field with limits or a ramp.

    Attributes:
        path: its spelling in the rules, and ``literal`` the same in C++.
        base: its primitive type.
        access: what follows the message to name it: ``.linear.x``.
        guards: what has to follow ``message`` to be long enough: ``.data.size() > 2``.
        is_limited: whether a line limits it, and ``falls`` whether one lets it fall along a ramp.
    """

    path: str
    base: str
    access: str
    guards: tuple[str, ...]
    is_limited: bool
    falls: bool

    @property
    def literal(self) -> str:
        """The path as a literal."""
        return cpp_string(self.path)

    def guarded(self, *messages: str) -> tuple[str, ...]:
        """Return the conditions that messages have the field; none if every message has it."""
        return tuple(f"{message}{guard}" for message in messages for guard in self.guards)


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


def number_fields(gate: Gate, store: InterfaceStore) -> tuple[NumberField, ...]:
    """Return the views of the fields of a gate's table."""
    limited = {limit.path for line in gate.lines for limit in line.limits}
    falling = {ramp.path for line in gate.lines if line.stop for ramp in line.stop.ramps}
    return tuple(
        NumberField(
            format_path(path),
            str(field_type(store, gate.type, path).base),
            f".{format_path(path)}",
            tuple(
                f".{format_path(array)}.size() > {index}"
                for array, index in unsized_arrays(store, gate.type, path)
            ),
            path in limited,
            path in falling,
        )
        for path in numbered_paths(gate)
    )


# What lines send ----------------------------------------------------------------------------------


def _assigned(place: str, field: FieldType, value: Scalar | None) -> str:
    if value is None:
        return f"{place}.clear();"
    return f"{place} = {scalar(str(field.base), value)};"


SEND_WORDS = SendWords(
    message="command",
    negation="!",
    conjunction=" && ",
    longer=lambda array, count: f"{array}.size() > {count}",
    empty=lambda array: f"{array}.empty()",
    assigned=_assigned,
    guarded=lambda condition, statement: f"if ({condition}) {{\n  {statement}\n}}",
    literal=lambda field, value: scalar(str(field.base), value),
)
"""How the functions for commands set and test the fields of what lines send."""
