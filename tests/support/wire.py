"""Messages as bytes between a test and compiled code: field by field, in a form of its own.

Numbers stand in their width, little end first; arrays (but those of fixed length) and texts follow
their length. :func:`encode` writes that from plain data, :func:`cpp` makes the C++ that reads it.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator
from typing import Any

from deros.generators.text.cpp import cpp_header, cpp_type
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType

_LETTERS = "bool ? byte B char B float32 f float64 d int8 b int16 h int32 i int64 q"
_LETTERS += " uint8 B uint16 H uint32 I uint64 Q"
_FORMATS = dict(zip(_LETTERS.split()[::2], _LETTERS.split()[1::2], strict=True))
_NUMBERS = {name: struct.Struct(f"<{letter}") for name, letter in _FORMATS.items()}
_LENGTH = struct.Struct("<I")


def encode(store: InterfaceStore, kind: InterfaceType, message: Any) -> bytes:
    """Return a message, given as plain data, as bytes."""
    return b"".join(_message(store, kind, message))


def _message(store: InterfaceStore, kind: InterfaceType, message: Any) -> Iterator[bytes]:
    definition = store.message(kind)
    assert definition is not None, kind
    for name, field in definition.fields:
        if not field.is_array:
            yield from _value(store, field, message[name])
            continue
        if field.array != "fixed":
            yield _LENGTH.pack(len(message[name]))
        for each in message[name]:
            yield from _value(store, field, each)


def _value(store: InterfaceStore, field: FieldType, value: Any) -> Iterator[bytes]:
    if isinstance(field.base, InterfaceType):
        yield from _message(store, field.base, value)
    elif field.base in _NUMBERS:
        yield _NUMBERS[field.base].pack(value)
    else:
        units = value.encode("utf-16-le" if field.base == "wstring" else "utf-8")
        yield _LENGTH.pack(len(units) // (2 if field.base == "wstring" else 1))
        yield units


class Reader:
    """Takes bytes apart that begin with numbers and messages."""

    def __init__(self, store: InterfaceStore, data: bytes) -> None:
        """Begin at the first byte."""
        self._store = store
        self._data = data
        self._place = 0

    @property
    def is_at_end(self) -> bool:
        """Whether nothing is left."""
        return self._place == len(self._data)

    def take(self, form: str) -> Any:
        """Return the next number, of a format of :mod:`struct`."""
        (value,) = struct.unpack_from(form, self._data, self._place)
        self._place += struct.calcsize(form)
        return value

    def skip(self, kind: InterfaceType) -> bytes:
        """Return the bytes of the next message."""
        before = self._place
        self._skip(kind)
        return self._data[before : self._place]

    def _skip(self, kind: InterfaceType) -> None:
        definition = self._store.message(kind)
        assert definition is not None, kind
        for _, field in definition.fields:
            if not field.is_array:
                self._skip_value(field)
                continue
            count = field.size if field.array == "fixed" else self.take("<I")
            for _ in range(count or 0):
                self._skip_value(field)

    def _skip_value(self, field: FieldType) -> None:
        if isinstance(field.base, InterfaceType):
            self._skip(field.base)
        elif field.base in _NUMBERS:
            self._place += _NUMBERS[field.base].size
        else:
            count = self.take("<I")
            self._place += count * (2 if field.base == "wstring" else 1)


# The other end ------------------------------------------------------------------------------------

_HEAD = """
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>
#include "rosidl_runtime_cpp/bounded_vector.hpp"

namespace wire
{

/// Bytes to be read, or written.
struct Bytes
{
  std::string data{};
  std::size_t place{0};
};

template<typename Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
void get(Bytes & from, Number & number)
{
  std::memcpy(&number, from.data.data() + from.place, sizeof(number));
  from.place += sizeof(number);
}

template<typename Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
void put(Bytes & to, Number number)
{
  to.data.append(reinterpret_cast<const char *>(&number), sizeof(number));
}

template<typename Array>
void get_all(Bytes & from, Array & array)
{
  for (std::size_t i = 0; i < array.size(); ++i) {
    typename Array::value_type value{};
    get(from, value);
    array[i] = value;
  }
}

template<typename Array>
void get_sequence(Bytes & from, Array & array)
{
  std::uint32_t length = 0;
  get(from, length);
  array.resize(length);
  get_all(from, array);
}

template<typename Array>
void put_all(Bytes & to, const Array & array)
{
  for (const typename Array::value_type & each : array) {
    put(to, each);
  }
}

template<typename Array>
void put_sequence(Bytes & to, const Array & array)
{
  put(to, static_cast<std::uint32_t>(array.size()));
  put_all(to, array);
}

template<typename T, std::size_t N>
void get(Bytes & from, std::array<T, N> & array) {get_all(from, array);}
template<typename T, std::size_t N>
void put(Bytes & to, const std::array<T, N> & array) {put_all(to, array);}
template<typename T, typename A>
void get(Bytes & from, std::vector<T, A> & array) {get_sequence(from, array);}
template<typename T, typename A>
void put(Bytes & to, const std::vector<T, A> & array) {put_sequence(to, array);}
template<typename T, std::size_t N, typename A>
void get(Bytes & from, rosidl_runtime_cpp::BoundedVector<T, N, A> & array)
{
  get_sequence(from, array);
}
template<typename T, std::size_t N, typename A>
void put(Bytes & to, const rosidl_runtime_cpp::BoundedVector<T, N, A> & array)
{
  put_sequence(to, array);
}
template<typename C, typename R, typename A>
void get(Bytes & from, std::basic_string<C, R, A> & text) {get_sequence(from, text);}
template<typename C, typename R, typename A>
void put(Bytes & to, const std::basic_string<C, R, A> & text) {put_sequence(to, text);}

}  // namespace wire
"""


def head() -> str:
    """Return the C++ that is the same for all messages."""
    return _HEAD


def cpp(store: InterfaceStore, kinds: Iterable[InterfaceType]) -> str:
    """Return C++ functions ``get`` and ``put`` for messages of some types and for those in them."""
    found: dict[InterfaceType, None] = {}
    for kind in kinds:
        _collect(store, kind, found)
    includes = "".join(f'#include "{cpp_header(kind)}"\n' for kind in sorted(found))
    functions = "".join(_functions(store, kind) for kind in found)
    return f"{includes}\nnamespace wire\n{{\n{functions}\n}}  // namespace wire\n"


def _collect(store: InterfaceStore, kind: InterfaceType, found: dict[InterfaceType, None]) -> None:
    definition = store.message(kind)
    assert definition is not None, kind
    for _, field in definition.fields:
        if isinstance(field.base, InterfaceType) and field.base not in found:
            _collect(store, field.base, found)
    found[kind] = None


def _functions(store: InterfaceStore, kind: InterfaceType) -> str:
    definition = store.message(kind)
    assert definition is not None, kind
    struct_name = cpp_type(kind)
    lines = []
    for function, const in (("get", ""), ("put", "const ")):
        lines.append(f"\ninline void {function}(Bytes & bytes, {const}{struct_name} & message)\n{{")
        lines += [f"  {function}(bytes, message.{name});" for name, _ in definition.fields]
        lines += ["" if definition.fields else "  (void)bytes; (void)message;", "}"]
    return "\n".join(lines) + "\n"
