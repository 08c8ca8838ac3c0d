"""The functions for the fields of commands in C++: finite, zero, limited, sent."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from deros.generators.gate.view import SendWords, TypeBase
from deros.generators.text.cpp import cpp_header, cpp_string, cpp_type
from deros.generators.text.cpp_fields import scalar
from deros.interfaces.fields import FieldPath, format_path
from deros.interfaces.message_fields import field_type, unsized_arrays
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType
from deros.rules.compiler.gates.command_types import CommandType, command_types
from deros.rules.gates.gate_table import numbered_paths
from deros.rules.program.commands import HEADER
from deros.rules.program.ir import Gate, Scalar, StopField


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
            _guards(gate, store, path),
            path in limited,
            path in falling,
        )
        for path in numbered_paths(gate)
    )


def _guards(gate: Gate, store: InterfaceStore, path: FieldPath) -> tuple[str, ...]:
    """Return what has to follow a message for its arrays to be long enough for a field."""
    return tuple(
        f".{format_path(array)}.size() > {index}"
        for array, index in unsized_arrays(store, gate.type, path)
    )


# What lines send ----------------------------------------------------------------------------------


def send_words(gate: Gate, store: InterfaceStore) -> SendWords:
    """Return how the fields of what the lines of a gate send are set, tested and zeroed."""
    return SendWords(
        lambda sent: _assigned(gate, store, sent),
        lambda sent: _is_sent(gate, store, sent),
        lambda sent: _assignment(sent, "rest", sent.zero),
    )


def _assigned(gate: Gate, store: InterfaceStore, sent: StopField) -> str:
    """Return the statement that gives a field its value, if the message has the field."""
    statement = _assignment(sent, "command", sent.value)
    guards = [f"command{guard}" for guard in _guards(gate, store, sent.path)]
    return f"if ({' && '.join(guards)}) {{\n  {statement}\n}}" if guards else statement


def _assignment(sent: StopField, message: str, value: Scalar | None) -> str:
    place = f"{message}.{format_path(sent.path)}"
    if value is None:
        return f"{place}.clear();"
    return f"{place} = {scalar(str(sent.type.base), value)};"


def _is_sent(gate: Gate, store: InterfaceStore, sent: StopField) -> str:
    place = f"command.{format_path(sent.path)}"
    if sent.value is None:
        return f"{place}.empty()"
    if isinstance(sent.value, bool):
        test = place if sent.value else f"!{place}"
    else:
        test = f"{place} == {scalar(str(sent.type.base), sent.value)}"
    guards = [f"command{guard}" for guard in _guards(gate, store, sent.path)]
    return " && ".join([*guards, test])
