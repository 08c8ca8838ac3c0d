"""Message fields: the arguments that the monitor takes, and the literals of published states."""

from __future__ import annotations

from collections.abc import Iterator

from deros.generators.monitor.c.interface import Parameter
from deros.generators.text.cpp_fields import scalar
from deros.interfaces.fields import format_path
from deros.interfaces.message_fields import field_type, unsized_arrays
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FLOAT_TYPES, FieldType, InterfaceType
from deros.rules.program.ir import PUBLISHER, RECEIPT, Scalar


def arguments(
    store: InterfaceStore, kind: InterfaceType, parameter: Parameter, number: int
) -> Iterator[str]:
    """Yield the arguments for the parameter of the monitor with a number, read from ``msg``."""
    if parameter.path == RECEIPT:
        yield "received"
        return
    if parameter.path == PUBLISHER:
        yield "has_one_publisher"
        return
    place = f"msg.{format_path(parameter.path)}"
    there = " && ".join(
        f"msg.{format_path(array)}.size() > {index}"
        for array, index in unsized_arrays(store, kind, parameter.path)
    )
    type_ = field_type(store, kind, parameter.path)
    match parameter.form:
        case "given":
            pass
        case "count":
            yield _if(there, f"{place}.size()", "0")
        case "array":
            yield _if(there, _entries(type_, place, number), "nullptr")
            yield _if(there, f"{place}.size()", "0")
        case "text":
            text = f"runtime::utf8({place})" if type_.base == "wstring" else place
            yield _if(there, f"{text}.data()", "nullptr")
            yield _if(there, f"{text}.size()", "0")
        case _:
            yield _value(type_, there, place)
    if parameter.given:
        yield there or "true"


def _entries(type_: FieldType, place: str, number: int) -> str:
    """Return where the entries of an array begin."""
    if type_.base == "bool" and type_.array != "fixed":
        return f"runtime::flags<{number}>({place})"
    if type_.array == "bounded":  # its data() is a template that no argument decides
        return f"({place}.empty() ? nullptr : &{place}.front())"
    return f"{place}.data()"


def _value(type_: FieldType, there: str, place: str) -> str:
    if type_.base in FLOAT_TYPES:
        return _if(there, f"static_cast<double>({place})" if there else place, "NOT_GIVEN")
    if type_.base == "bool":
        return _if(there, place, "false")
    kind = "uint64_t" if type_.base == "uint64" else "int64_t"
    return _if(there, f"std::{kind}{{{place}}}" if there else place, f"std::{kind}{{0}}")


def _if(condition: str, value: str, otherwise: str) -> str:
    return f"{condition} ? {value} : {otherwise}" if condition else value


def literal(
    store: InterfaceStore, kind: InterfaceType, path: tuple[str | int, ...], value: Scalar
) -> str:
    """Return the literal that a field is set to."""
    base = field_type(store, kind, path).base
    assert isinstance(base, str)
    if isinstance(value, int) and not isinstance(value, bool) and base in FLOAT_TYPES:
        value = float(value)
    return scalar(base, value)
