"""Message fields: the arguments that the monitor takes, and the literals of published states."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deros.generators.monitor.c.interface import Parameter
from deros.generators.text.cpp_fields import scalar
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.fields import FieldPath, Key
from deros.interfaces.message_fields import field_type
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FLOAT_TYPES, FieldType, InterfaceType
from deros.rules.program.ir import PUBLISHER, RECEIPT, Scalar


@dataclass(frozen=True, slots=True)
class Lookup:
    """A variable with the place of an element that a key names, in an array of ``msg``.

    Attributes:
        name: the variable.
        names: the array itself, or the one beside it with what its elements are called.
        test: whether one of these, ``each``, is the one.
        there: whether the message has the array, where it may lack it.
    """

    name: str
    names: str
    test: str
    there: str


class MessageFields:
    """The fields of a message that the monitor reads."""

    def __init__(
        self, store: InterfaceStore, kind: InterfaceType, parameters: Sequence[Parameter]
    ) -> None:
        """Read the ``parameters`` of the monitor from a message of type ``kind``."""
        self._store = store
        self._kind = kind
        self._parameters = parameters
        self._names = UniqueNames()
        self._lookups: dict[FieldPath, Lookup] = {}
        for path in (each.path for each in parameters):
            for end, step in enumerate(path, 1):
                if isinstance(step, Key) and path[:end] not in self._lookups:
                    self._lookups[path[:end]] = self._lookup(path[: end - 1], step)

    @property
    def lookups(self) -> tuple[Lookup, ...]:
        """The variables that the arguments need, in the order in which they are set."""
        return tuple(self._lookups.values())

    def arguments(self) -> Iterator[str]:
        """Yield the arguments of the monitor for its parameters, read from ``msg``."""
        for number, each in enumerate(self._parameters):
            yield from self._arguments(each, number)

    def _arguments(self, parameter: Parameter, number: int) -> Iterator[str]:
        if parameter.path == RECEIPT:
            yield "received"
            return
        if parameter.path == PUBLISHER:
            yield "has_one_publisher"
            return
        place, there = self._place(parameter.path)
        type_ = self._type(parameter.path)
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

    def _place(self, path: FieldPath) -> tuple[str, str]:
        """Return where a field is, and a test that it is there; empty if it always is."""
        place, tests = "msg", []
        for position, step in enumerate(path):
            if isinstance(step, str):
                place += f".{step}"
                continue
            index = str(step)
            if isinstance(step, Key):
                index = self._lookups[path[: position + 1]].name
            if isinstance(step, Key) or self._type(path[:position]).array != "fixed":
                tests.append(f"{place}.size() > {index}")
            place += f"[{index}]"
        return place, " && ".join(tests)

    def _lookup(self, array: FieldPath, key: Key) -> Lookup:
        place, there = self._place(array)
        kind = self._type(array).base
        if isinstance(kind, InterfaceType):
            names, each = place, f"each.{key.name}"
            named = field_type(self._store, kind, (key.name,))
        else:
            beside = (*array[:-1], key.name)
            names, each = self._place(beside)[0], "each"
            named = self._type(beside)
        name = self._names.new("place_of", key)
        return Lookup(name, names, f"{each} == {scalar(str(named.base), key.value)}", there)

    def _type(self, path: FieldPath) -> FieldType:
        return field_type(self._store, self._kind, path)


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


def literal(store: InterfaceStore, kind: InterfaceType, path: FieldPath, value: Scalar) -> str:
    """Return the literal that a field is set to."""
    base = field_type(store, kind, path).base
    assert isinstance(base, str)
    if isinstance(value, int) and not isinstance(value, bool) and base in FLOAT_TYPES:
        value = float(value)
    return scalar(base, value)
