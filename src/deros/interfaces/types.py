"""Names and types of ROS 2 interfaces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

InterfaceKind = Literal["msg", "srv", "action"]

INTEGER_RANGES: dict[str, tuple[int, int]] = {
    "byte": (0, 2**8 - 1),
    "char": (0, 2**8 - 1),
    "int8": (-(2**7), 2**7 - 1),
    "uint8": (0, 2**8 - 1),
    "int16": (-(2**15), 2**15 - 1),
    "uint16": (0, 2**16 - 1),
    "int32": (-(2**31), 2**31 - 1),
    "uint32": (0, 2**32 - 1),
    "int64": (-(2**63), 2**63 - 1),
    "uint64": (0, 2**64 - 1),
}
"""Least and greatest value of each integer primitive; ``byte`` and ``char`` are octets in ROS 2."""

INT64 = range(INTEGER_RANGES["int64"][0], INTEGER_RANGES["int64"][1] + 1)
"""The integers of 64 bits, which a parameter and a field can have."""

FLOAT32_MAX = (2 - 2**-23) * 2.0**127
"""The greatest finite value of a ``float32``."""

MOST_DIGITS = 400
"""The number of digits beyond which a number is refused, in definitions and models alike."""

FLOAT_TYPES = frozenset({"float32", "float64"})
STRING_TYPES = frozenset({"string", "wstring"})
Primitive = bool | int | float | str
"""A value of a primitive field."""

PRIMITIVES = frozenset(INTEGER_RANGES) | FLOAT_TYPES | STRING_TYPES | {"bool"}


@dataclass(frozen=True, slots=True, order=True)
class InterfaceType:
    """The full name of a message, service or action type.

    ``std_msgs.Bool``, ``std_msgs/Bool`` and ``std_msgs/msg/Bool`` are one and the same.
    """

    package: str
    kind: InterfaceKind
    name: str

    def __str__(self) -> str:
        """Return the ROS 2 spelling, ``package/kind/Name``."""
        return f"{self.package}/{self.kind}/{self.name}"

    @property
    def short(self) -> str:
        """The spelling of the languages of deros, ``package.Name``."""
        return f"{self.package}.{self.name}"


@dataclass(frozen=True, slots=True)
class FieldType:
    """The type of one field: a primitive or a message, alone or as an array.

    Attributes:
        base: a member of :data:`PRIMITIVES`, or the nested message's type.
        array: ``None`` for a single value, else how the length is known.
        size: the length of a ``fixed`` array, the bound of a ``bounded`` one.
        string_bound: the greatest length of a bounded string, in characters.
    """

    base: str | InterfaceType
    array: Literal["fixed", "bounded", "unbounded"] | None = None
    size: int | None = None
    string_bound: int | None = None

    @property
    def is_array(self) -> bool:
        """Whether the field holds a sequence of values."""
        return self.array is not None

    @property
    def is_number(self) -> bool:
        """Whether the field is one integer or floating-point value (a bool is not)."""
        return not self.is_array and (self.base in INTEGER_RANGES or self.base in FLOAT_TYPES)

    @property
    def is_float(self) -> bool:
        """Whether the field is one floating-point value."""
        return not self.is_array and self.base in FLOAT_TYPES

    @property
    def element(self) -> FieldType:
        """The type of one element of an array."""
        return FieldType(self.base, string_bound=self.string_bound)

    def __str__(self) -> str:
        """Return the spelling of ``.msg`` files, as ``float32[9]`` or ``string[<=3]``."""
        suffix = {
            None: "",
            "fixed": f"[{self.size}]",
            "bounded": f"[<={self.size}]",
            "unbounded": "[]",
        }
        bound = "" if self.string_bound is None else f"<={self.string_bound}"
        return f"{self.base}{bound}{suffix[self.array]}"


@dataclass(frozen=True, slots=True)
class Constant:
    """A constant of a message definition, such as ``ERROR=2``."""

    name: str
    type: str
    value: Primitive


@dataclass(frozen=True, slots=True)
class MessageDefinition:
    """Fields, in order, and constants of one message (or a part of a service or action).

    ``defaults`` holds the fields to which the definition gives a value (``float64 w 1``); the rest
    start as zero, false, empty, or the defaults of their own message type.
    """

    type: InterfaceType
    fields: tuple[tuple[str, FieldType], ...]
    constants: tuple[Constant, ...] = ()
    defaults: Mapping[str, Primitive | tuple[Primitive, ...]] = field(
        default_factory=dict, hash=False
    )

    def field(self, name: str) -> FieldType | None:
        """Return the type of the field called ``name``, or ``None``."""
        return next((kind for field_name, kind in self.fields if field_name == name), None)
