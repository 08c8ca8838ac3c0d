"""Messages of rclpy as plain CDR, in both byte orders, and decoders made to be called at once.

The writer is a second, plain implementation of what the middleware does: field by field, each
aligned to its size, in the order of the definition. It is held against the middleware itself.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from deros.generators.decoder.python.interface import Topic, render_decoders
from deros.interfaces.fields import FieldPath
from deros.interfaces.types import FieldType, InterfaceType
from tests.support.messages import STORE, Store, fields

_LETTERS = {"bool": "?", "byte": "B", "char": "B", "int8": "b", "uint8": "B"} | {
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
    "float32": "f",
    "float64": "d",
}


def serialize(message: Any, kind: InterfaceType, big_endian: bool, store: Store = STORE) -> bytes:
    """Return a message with its encapsulation, as it goes over the wire."""
    writer = _Writer(">" if big_endian else "<", store)
    writer.message(message, kind)
    return bytes([0, 0 if big_endian else 1, 0, 0]) + bytes(writer.data)


@dataclass
class _Writer:
    order: str
    store: Store
    data: bytearray = field(default_factory=bytearray)

    def message(self, message: Any, kind: InterfaceType) -> None:
        known = fields(self.store, kind)
        for name, type_ in known:
            self.field(getattr(message, name), type_)
        if not known:
            self.data.append(0)

    def field(self, value: Any, type_: FieldType) -> None:
        if not type_.is_array:
            self.element(value, type_)
            return
        if type_.array != "fixed":
            self.number(len(value), "I")
        for each in value:
            self.element(each, type_.element)

    def element(self, value: Any, type_: FieldType) -> None:
        base = type_.base
        if isinstance(base, InterfaceType):
            self.message(value, base)
        elif base == "string":
            encoded = value.encode() + b"\0"
            self.number(len(encoded), "I")
            self.data += encoded
        elif base == "wstring":
            encoded = value.encode("utf-16-le")
            units = struct.unpack(f"<{len(encoded) // 2}H", encoded)
            self.number(len(units), "I")
            for unit in units:
                self.number(unit, "I")
        else:
            self.number(value[0] if base == "byte" else value, _LETTERS[base])

    def number(self, value: float, letter: str) -> None:
        size = struct.calcsize(letter)
        self.data += bytes(-len(self.data) % size)
        self.data += struct.pack(self.order + letter, value)


# Decoders -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Decoder:
    """A decoder that has been generated, as the function it is.

    Attributes:
        text: of its module.
        errors: the module's ``DECODING_ERRORS``.
    """

    text: str
    decode: Callable[[bytes], Any]
    errors: tuple[type[Exception], ...]

    def values(self, data: bytes) -> list[Any]:
        """Return what is decoded in the terms of :func:`tests.support.messages.read`."""
        result = self.decode(data)
        return [_plain(each) for each in (result if isinstance(result, tuple) else (result,))]


def decoder(kind: InterfaceType, paths: Sequence[FieldPath], store: Any = STORE) -> Decoder:
    """Generate the decoder for some fields, and load it; it returns a tuple even for one path."""
    topic = Topic("topic", kind, paths)
    text = render_decoders([topic], store)
    module: dict[str, Any] = {}
    exec(compile(text, "decoders.py", "exec"), module)
    function = module[topic.function]
    decode = (lambda data: (function(data),)) if len(paths) == 1 else function
    return Decoder(text, decode, module["DECODING_ERRORS"])


def _plain(value: Any) -> Any:
    if isinstance(value, range):
        return len(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    return list(value) if isinstance(value, tuple) else value
