"""Reads the messages of a trace: JSON data merged into the defaults of a message definition."""

from __future__ import annotations

import contextlib
import math
import re
import struct
from collections.abc import Mapping
from decimal import Decimal
from typing import Any

from deros.interfaces.fields import (
    BRACKETS,
    FieldError,
    FieldPath,
    Key,
    PathStep,
    resolve,
    step_of,
)
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import (
    FLOAT_TYPES,
    INTEGER_RANGES,
    STRING_TYPES,
    FieldType,
    InterfaceType,
    MessageDefinition,
)
from deros.names.names import did_you_mean, near
from deros.rules.engine.state import LeafValue

_STEP = re.compile(rf"(?:^|\.)(?P<name>[A-Za-z]\w*)|{BRACKETS}", re.ASCII)
_NOT_FINITE = {"NaN": math.nan, "Infinity": math.inf, "-Infinity": -math.inf}
_LONGEST_ARRAY = 1_000_000  # of those that grow because a single element is given


class DataError(Exception):
    """Data does not fit the message.

    Attributes:
        key: the key of the data at fault, as written.
        unknown: whether the message has no such field; otherwise the value does not fit the field.
        hint: a suggestion.
    """

    def __init__(self, key: str, message: str, *, unknown: bool = False, hint: str = "") -> None:
        super().__init__(message)
        self.key = key
        self.unknown = unknown
        self.hint = hint


class MessageReader:
    """Reads the data of messages of one type.

    A message is held as a dictionary of the fields that the data gives; messages within it
    likewise, arrays as lists. All else has its default.
    """

    def __init__(self, store: InterfaceStore, kind: InterfaceType) -> None:
        """Read messages of the type ``kind``, which ``store`` must have."""
        self._store = store
        self._definition = self._resolve(kind, "")

    def read(self, data: Mapping[str, Any]) -> dict[str, Any]:
        """Return the message that ``data`` gives: nested, or with dotted keys, or both mixed.

        Raises:
            DataError: a field is unknown, or a value does not fit its field.
        """
        message: dict[str, Any] = {}
        self._fill(message, self._definition, data, "")
        return message

    def leaf(self, message: Mapping[str, Any], path: FieldPath) -> LeafValue:
        """Return the value of a field, ``None`` where an array has no such element."""
        value: Any = message
        kind = FieldType(self._definition.type)
        around: tuple[Any, MessageDefinition] = message, self._definition
        for position, step in enumerate(path):
            if isinstance(step, str):
                around = value, self._resolve(kind.base, step)
                value, kind = self._field(*around, step)
                continue
            index = step
            if isinstance(index, Key):
                index = self._place(*around, str(path[position - 1]), index)
            if index >= len(value):
                return None
            value, kind = value[index], kind.element
        result: LeafValue = value
        return result

    def _place(
        self, message: Mapping[str, Any], definition: MessageDefinition, array: str, key: Key
    ) -> int:
        """Return the index of the element with a key of an array; the length for none."""
        elements, kind = self._field(message, definition, array)
        if isinstance(kind.base, InterfaceType):
            inner = self._resolve(kind.base, array)
            names = [self._field(each, inner, key.name)[0] for each in elements]
        else:
            names, _ = self._field(message, definition, key.name)
            names = list(names)
        return names.index(key.value) if key.value in names else max(len(names), len(elements))

    def whole(self, message: Mapping[str, Any]) -> dict[str, Any]:
        """Return the message with all of its fields, those of messages in it included."""
        return self._whole(message, self._definition)

    def _whole(self, message: Mapping[str, Any], definition: MessageDefinition) -> dict[str, Any]:
        return {
            name: self._whole_value(*self._field(message, definition, name))
            for name, _ in definition.fields
        }

    def _whole_value(self, value: Any, kind: FieldType) -> Any:
        if not isinstance(kind.base, InterfaceType):
            return value
        definition = self._resolve(kind.base, "")
        if kind.is_array:
            return [self._whole(each, definition) for each in value]
        return self._whole(value, definition)

    # Definitions --------------------------------------------------------------------------------

    def _resolve(self, kind: InterfaceType | str, key: str) -> MessageDefinition:
        definition = self._store.message(kind) if isinstance(kind, InterfaceType) else None
        if definition is None:
            raise DataError(key, f"{kind} has no definition here", unknown=True)
        return definition

    def _field(
        self, message: Mapping[str, Any], definition: MessageDefinition, name: str
    ) -> tuple[Any, FieldType]:
        kind = definition.field(name)
        assert kind is not None, f"{definition.type} has no field {name}"
        if name in message:
            return message[name], kind
        if name in definition.defaults:
            return definition.defaults[name], kind
        return _default(kind), kind

    # Data ---------------------------------------------------------------------------------------

    def _fill(
        self,
        message: dict[str, Any],
        definition: MessageDefinition,
        data: Mapping[str, Any],
        within: str,
    ) -> None:
        for key, value in data.items():
            whole = f"{within}.{key}" if within else key
            self._put(message, definition, _steps(key, whole), value, whole)

    def _put(
        self,
        message: dict[str, Any],
        definition: MessageDefinition,
        steps: FieldPath,
        value: Any,
        key: str,
    ) -> None:
        name, rest = str(steps[0]), steps[1:]
        kind = definition.field(name)
        if kind is None:
            hint = did_you_mean(near(name, [field for field, _ in definition.fields]), name)
            text = f"{definition.type} has no field '{name}'"
            raise DataError(key, text, unknown=True, hint=hint)
        if rest and not kind.is_array and isinstance(rest[0], Key):
            raise DataError(key, f"'{name}' is a {kind}, not an array", unknown=True)
        if rest and not kind.is_array and not isinstance(kind.base, InterfaceType):
            raise DataError(key, f"'{name}' is a {kind}, it has no fields", unknown=True)
        if rest and isinstance(rest[0], Key) and kind.is_array:
            index = self._called(message, definition, name, rest[0], key)
            rest = (index, *rest[1:])
        present, _ = self._field(message, definition, name)
        message[name] = self._laid_over(present, kind, rest, value, key)

    def _called(
        self,
        message: dict[str, Any],
        definition: MessageDefinition,
        array: str,
        key: Key,
        whole: str,
    ) -> int:
        """Return the index of the element with a key, which is added where there is none."""
        found = resolve(self._store, definition.type, (array, key))
        if isinstance(found, FieldError):
            hint = did_you_mean(found.candidates)
            raise DataError(whole, found.message, unknown=True, hint=hint)
        index = self._place(message, definition, array, key)
        inside = isinstance(found.type.base, InterfaceType)
        called = (array, index, key.name) if inside else (key.name, index)
        self._put(message, definition, called, key.value, whole)
        return index

    def _laid_over(
        self, present: Any, kind: FieldType, steps: FieldPath, value: Any, key: str
    ) -> Any:
        """Return ``present``, of the type ``kind``, with ``value`` at the path ``steps``."""
        if kind.is_array:
            return self._array(present, kind, steps, value, key)
        if not isinstance(kind.base, InterfaceType):
            return convert(str(kind.base), value, key)
        definition = self._resolve(kind.base, key)
        if steps:
            self._put(present, definition, steps, value, key)
        elif isinstance(value, Mapping):
            self._fill(present, definition, value, key)
        else:
            raise DataError(key, f"'{key}' is a {kind.base}, so it needs an object")
        return present

    def _array(
        self, present: Any, kind: FieldType, steps: FieldPath, value: Any, key: str
    ) -> list[Any]:
        if not steps:
            if not isinstance(value, list):
                raise DataError(key, f"'{key}' is a {kind}, so it needs an array")
            fixed = kind.array == "fixed" and len(value) != kind.size
            if fixed or (kind.array == "bounded" and len(value) > (kind.size or 0)):
                raise DataError(key, f"'{key}' is a {kind}, and cannot have {len(value)} elements")
            return [
                self._laid_over(_default(kind.element), kind.element, (), each, f"{key}[{n}]")
                for n, each in enumerate(value)
            ]
        index, elements = steps[0], list(present)
        if not isinstance(index, int):
            raise DataError(
                key, f"'{key}' lacks the index of an element of the {kind}", unknown=True
            )
        if index >= (_LONGEST_ARRAY if kind.array == "unbounded" else kind.size or 0):
            raise DataError(key, f"'{key}' lies beyond the end of the {kind}", unknown=True)
        elements += [_default(kind.element) for _ in range(index + 1 - len(elements))]
        elements[index] = self._laid_over(elements[index], kind.element, steps[1:], value, key)
        return elements


def convert(kind: str, value: Any, key: str) -> bool | int | float | str:
    """Return a JSON value (numbers as ``int`` or ``Decimal``) as a primitive of ROS.

    A ``float32`` is rounded to one, as it would be in a message.

    Raises:
        DataError: the value does not fit.
    """
    if kind == "bool" and isinstance(value, bool):
        return value
    if kind in STRING_TYPES and isinstance(value, str):
        return value
    if kind in INTEGER_RANGES and isinstance(value, int | Decimal) and not isinstance(value, bool):
        least, greatest = INTEGER_RANGES[kind]
        if least <= value <= greatest and value == int(value):
            return int(value)
    if kind in FLOAT_TYPES:
        number = _float(value)
        if number is not None and (kind == "float64" or _fits_float32(number)):
            return number if kind == "float64" else _as_float32(number)
    shown = str(value) if isinstance(value, Decimal) else repr(value)
    shown = {"True": "true", "False": "false", "None": "null"}.get(shown, shown)
    raise DataError(key, f"'{key}' is a {kind}, and cannot hold {shown[:40]}")


def _float(value: Any) -> float | None:
    if isinstance(value, str):
        return _NOT_FINITE.get(value)
    if isinstance(value, bool) or not isinstance(value, int | float | Decimal):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    finite = not isinstance(value, float)  # the JSON literals NaN and Infinity come as floats
    return None if finite and math.isinf(number) else number


def _fits_float32(number: float) -> bool:
    try:
        struct.pack("<f", number)
    except OverflowError:
        return False
    return True


def _as_float32(number: float) -> float:
    rounded: float = struct.unpack("<f", struct.pack("<f", number))[0]
    return rounded


def _default(kind: FieldType) -> Any:
    if kind.array == "fixed":
        return [_default(kind.element) for _ in range(kind.size or 0)]
    if kind.is_array:
        return []
    if isinstance(kind.base, InterfaceType):
        return {}
    if kind.base in STRING_TYPES:
        return ""
    if kind.base == "bool":
        return False
    return 0.0 if kind.base in FLOAT_TYPES else 0


def _steps(key: str, whole: str) -> FieldPath:
    """Split ``position[2].x`` into its steps."""
    steps: list[PathStep] = []
    end = 0
    with contextlib.suppress(ValueError):  # of a backslash that means nothing
        while match := _STEP.match(key, end):
            steps.append(step_of(match))
            end = match.end()
    if end != len(key) or not steps or not isinstance(steps[0], str):
        raise DataError(whole, f"'{whole}' is not the path of a field", unknown=True)
    return tuple(steps)
