"""What a gate does to the fields of a command, in C++: looks for NaN, makes zeros, limits."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from deros.generators.cpp_source import cpp_header, cpp_type
from deros.generators.gate_cpp.source import NUMBERS
from deros.generators.monitor_python.names import Names
from deros.interfaces.fields import FieldPath, ResolvedField, format_path, resolve
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import (
    FLOAT_TYPES,
    STRING_TYPES,
    FieldType,
    InterfaceType,
    MessageDefinition,
)
from deros.monitor.commands import HEADER, LAYOUT, QUATERNION


@dataclass(frozen=True, slots=True)
class TypeView:
    """The functions for one message type.

    Attributes:
        type: its name in ROS 2.
        name: its struct.
        header: what declares it.
        finite: the operands whose conjunction tells whether each float in it is finite.
        zeros: the statements that make zeros of it.
        stamped: whether it, or a message in it, has a header that takes the time.
    """

    type: str
    name: str
    header: str
    finite: tuple[str, ...]
    zeros: tuple[str, ...]
    stamped: bool


@dataclass(frozen=True, slots=True)
class LimitedField:
    """A field that a limit of the gate speaks of.

    Attributes:
        name: an identifier that tells it from the other ones.
        path: its spelling in the rules.
        base: its primitive type, and ``type`` the same in C++.
        access: what follows the message to name it: ``.linear.x``.
        guards: what has to follow ``message`` to be long enough: ``.data.size() > 2``.
    """

    name: str
    path: str
    base: str
    type: str
    access: str
    guards: tuple[str, ...]

    def guarded(self, message: str) -> tuple[str, ...]:
        """Return the operands of the condition that a message has the field; none if each has."""
        return tuple(f"{message}{guard}" for guard in self.guards)


# Whole messages -----------------------------------------------------------------------------------


def type_views(store: InterfaceStore, kind: InterfaceType) -> tuple[TypeView, ...]:
    """Return the views of a message type and of those in it, the innermost first.

    Types that have no number, and so nothing to look at or to change, are left out.
    """
    found: dict[InterfaceType, TypeView] = {}
    _view(store, kind, found)
    return tuple(found.values())


def _view(store: InterfaceStore, kind: InterfaceType, found: dict[InterfaceType, TypeView]) -> None:
    definition = store.message(kind)
    assert definition is not None, kind
    nested = [f.base for _, f in definition.fields if isinstance(f.base, InterfaceType)]
    for base in nested:
        if base not in found and base not in (HEADER, LAYOUT):  # they command nothing
            _view(store, base, found)
    finite = tuple(_finite(definition, found))
    zeros = tuple(_zeros(definition, found))
    if finite or zeros:
        parts = [found.get(base) for base in nested]
        stamped = HEADER in nested or any(part.stamped for part in parts if part)
        name, header = cpp_type(kind), cpp_header(kind)
        found[kind] = TypeView(str(kind), name, header, finite, zeros, stamped)


def _finite(definition: MessageDefinition, found: dict[InterfaceType, TypeView]) -> Iterator[str]:
    for name, field in definition.fields:
        place = f"message.{name}"
        if isinstance(field.base, str):
            if field.base in FLOAT_TYPES:
                yield (
                    f"runtime::all_finite({place})" if field.is_array else f"std::isfinite({place})"
                )
            continue
        view = found.get(field.base)
        if view is None or not view.finite:
            continue
        if field.is_array:
            yield f"runtime::are_all({place}, [](const auto & each) {{return is_finite(each);}})"
        else:
            yield f"is_finite({place})"


def _zeros(definition: MessageDefinition, found: dict[InterfaceType, TypeView]) -> Iterable[str]:
    for name, field in definition.fields:
        if field.base in STRING_TYPES:
            continue
        place = f"message.{name}"
        each = "each" if field.is_array else place
        if definition.type == QUATERNION and name == "w":
            yield f"{place} = 1.0;  // zero would be no rotation at all"
            continue
        if isinstance(field.base, str):
            zero = _zero(field.base)
            yield f"runtime::fill_with_zeros({place});" if field.is_array else f"{place} = {zero};"
            continue
        if field.base == HEADER:
            statement = f"{each}.stamp = stamp;"
        elif (view := found.get(field.base)) and view.zeros:
            statement = f"make_zero({each}{', stamp' if view.stamped else ''});"
        else:
            continue
        loop = f"for (auto & each : {place}) {{\n    {statement}\n  }}"
        yield loop if field.is_array else statement


def _zero(base: str) -> str:
    if base == "bool":
        return "false"
    return {"float32": "0.0F", "float64": "0.0"}.get(base, "0")


# Single fields ------------------------------------------------------------------------------------


def limited_fields(
    store: InterfaceStore, kind: InterfaceType, paths: Iterable[FieldPath], names: Names
) -> tuple[LimitedField, ...]:
    """Return the views of the fields at ``paths``, each once, in the order first named."""
    return tuple(
        _limited_field(store, kind, path, names.new(*path))
        for path in dict.fromkeys(tuple(path) for path in paths)
    )


def _limited_field(
    store: InterfaceStore, kind: InterfaceType, path: FieldPath, name: str
) -> LimitedField:
    access, guards = "", []
    for position, part in enumerate(path):
        if isinstance(part, str):
            access += f".{part}"
            continue
        if _resolved(store, kind, path[:position]).array != "fixed":
            guards.append(f"{access}.size() > {part}")
        access += f"[{part}]"
    base = _resolved(store, kind, path).base
    assert isinstance(base, str), path
    return LimitedField(name, format_path(path), base, NUMBERS[base], access, tuple(guards))


def _resolved(store: InterfaceStore, kind: InterfaceType, path: FieldPath) -> FieldType:
    found = resolve(store, kind, path)
    assert isinstance(found, ResolvedField), found
    return found.type
