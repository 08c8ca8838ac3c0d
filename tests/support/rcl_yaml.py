"""Parameter files read by ROS 2's own library, ``librcl_yaml_param_parser.so``."""

from __future__ import annotations

import ctypes
import functools
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from deros.models.common import Value

_SIZE = ctypes.c_size_t


class _Array(ctypes.Structure):
    _fields_ = (("values", ctypes.c_void_p), ("size", _SIZE))


class _Texts(ctypes.Structure):
    _fields_ = (("size", _SIZE), ("data", ctypes.POINTER(ctypes.c_char_p)))


class _Variant(ctypes.Structure):
    _fields_ = (
        ("bool", ctypes.POINTER(ctypes.c_bool)),
        ("integer", ctypes.POINTER(ctypes.c_int64)),
        ("double", ctypes.POINTER(ctypes.c_double)),
        ("string", ctypes.c_char_p),
        ("bytes", ctypes.POINTER(_Array)),
        ("bools", ctypes.POINTER(_Array)),
        ("integers", ctypes.POINTER(_Array)),
        ("doubles", ctypes.POINTER(_Array)),
        ("texts", ctypes.POINTER(_Texts)),
    )


class _Node(ctypes.Structure):
    _fields_ = (
        ("names", ctypes.POINTER(ctypes.c_char_p)),
        ("values", ctypes.POINTER(_Variant)),
        ("count", _SIZE),
        ("capacity", _SIZE),
    )


class _Parameters(ctypes.Structure):
    _fields_ = (
        ("names", ctypes.POINTER(ctypes.c_char_p)),
        ("nodes", ctypes.POINTER(_Node)),
        ("count", _SIZE),
    )


class _Allocator(ctypes.Structure):
    _fields_ = tuple((name, ctypes.c_void_p) for name in ("a", "d", "r", "z", "state"))


Read = list[tuple[str, list[tuple[str, Value | None]]]]
"""The keys of files, and the names and values under each, in ROS 2's order."""


@functools.cache
def _libraries() -> tuple[Any, Any]:
    import rclpy  # noqa: F401 - loads what the library needs

    folder = Path(sys.prefix) / "lib"
    utils = ctypes.CDLL(str(folder / "librcutils.so"))
    library = ctypes.CDLL(str(folder / "librcl_yaml_param_parser.so"))
    utils.rcutils_get_default_allocator.restype = _Allocator
    library.rcl_yaml_node_struct_init.argtypes = (_Allocator,)
    library.rcl_yaml_node_struct_init.restype = ctypes.POINTER(_Parameters)
    library.rcl_yaml_node_struct_fini.argtypes = (ctypes.POINTER(_Parameters),)
    library.rcl_parse_yaml_file.argtypes = (ctypes.c_char_p, ctypes.POINTER(_Parameters))
    library.rcl_parse_yaml_file.restype = ctypes.c_bool
    return utils, library


def read(*files: Path) -> Read | None:
    """Read files one after the other; ``None``: the library refuses one of them."""
    utils, library = _libraries()
    found = library.rcl_yaml_node_struct_init(utils.rcutils_get_default_allocator())
    try:
        for each in files:
            if not library.rcl_parse_yaml_file(str(each).encode(), found):
                utils.rcutils_reset_error()
                return None
        return list(_nodes(found.contents))
    finally:
        library.rcl_yaml_node_struct_fini(found)


def _nodes(found: _Parameters) -> Iterator[tuple[str, list[tuple[str, Value | None]]]]:
    for number in range(found.count):
        node = found.nodes[number]
        values = [(node.names[i].decode(), _value(node.values[i])) for i in range(node.count)]
        yield found.names[number].decode(), values


def _value(found: _Variant) -> Value | None:
    """Return a value as ``rclcpp::parameter_value_from`` does; ``None`` where that throws."""
    for name in ("bool", "integer", "double"):
        if pointer := getattr(found, name):
            return pointer[0]  # type: ignore[no-any-return]
    if found.string is not None:
        return found.string.decode()  # type: ignore[no-any-return]
    kinds: dict[str, Any] = {
        "bools": ctypes.c_bool,
        "integers": ctypes.c_int64,
        "doubles": ctypes.c_double,
    }
    for name, kind in kinds.items():
        if pointer := getattr(found, name):
            array = pointer[0]
            items = ctypes.cast(array.values, ctypes.POINTER(kind))
            return tuple(items[i] for i in range(array.size))
    if found.texts:
        return tuple(found.texts[0].data[i].decode() for i in range(found.texts[0].size))
    return None
