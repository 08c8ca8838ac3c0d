"""Values of parameter files, read by the parser of ROS 2 itself: a library that rclpy loads."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
import ctypes
import json
import os
import re
from typing import Any

from ..command_line import yaml
from ..node import Value

# The structures of rcl_yaml_param_parser/types.h, and what rcutils passes by value.


class _Array(ctypes.Structure):
    _fields_ = (('values', ctypes.c_void_p), ('size', ctypes.c_size_t))


class _Texts(ctypes.Structure):
    _fields_ = (('size', ctypes.c_size_t), ('data', ctypes.POINTER(ctypes.c_char_p)))


class _Variant(ctypes.Structure):
    _fields_ = (
        ('bool', ctypes.POINTER(ctypes.c_bool)),
        ('integer', ctypes.POINTER(ctypes.c_int64)),
        ('double', ctypes.POINTER(ctypes.c_double)),
        ('string', ctypes.c_char_p),
        ('bytes', ctypes.POINTER(_Array)),
        ('bools', ctypes.POINTER(_Array)),
        ('integers', ctypes.POINTER(_Array)),
        ('doubles', ctypes.POINTER(_Array)),
        ('texts', ctypes.POINTER(_Texts)),
    )


class _OfNode(ctypes.Structure):
    _fields_ = (
        ('names', ctypes.POINTER(ctypes.c_char_p)),
        ('values', ctypes.POINTER(_Variant)),
        ('count', ctypes.c_size_t),
        ('capacity', ctypes.c_size_t),
    )


class _Parameters(ctypes.Structure):
    _fields_ = (
        ('keys', ctypes.POINTER(ctypes.c_char_p)),
        ('nodes', ctypes.POINTER(_OfNode)),
        ('count', ctypes.c_size_t),
        ('capacity', ctypes.c_size_t),
    )


class _Allocator(ctypes.Structure):
    _fields_ = tuple((name, ctypes.c_void_p) for name in ('a', 'd', 'r', 'z', 'state'))


class _ErrorText(ctypes.Structure):
    _fields_ = (('text', ctypes.c_char * 1024),)


def values_of(files: Sequence[str], full_name: str) -> dict[str, Value]:
    """
    Return what parameter files set for a node, as its process would read them one after the other.

    Raises ValueError, with the words of ROS 2, when it would not start with one of them.
    """
    import rclpy  # noqa: F401 - it loads the libraries, wherever they are

    utils = ctypes.CDLL('librcutils.so')
    parser = ctypes.CDLL('librcl_yaml_param_parser.so')
    utils.rcutils_get_default_allocator.restype = _Allocator
    utils.rcutils_get_error_string.restype = _ErrorText
    parser.rcl_yaml_node_struct_init.argtypes = (_Allocator,)
    parser.rcl_yaml_node_struct_init.restype = ctypes.POINTER(_Parameters)
    parser.rcl_yaml_node_struct_fini.argtypes = (ctypes.POINTER(_Parameters),)
    parser.rcl_parse_yaml_file.argtypes = (ctypes.c_char_p, ctypes.POINTER(_Parameters))
    parser.rcl_parse_yaml_file.restype = ctypes.c_bool
    found = parser.rcl_yaml_node_struct_init(utils.rcutils_get_default_allocator())
    try:
        for file in files:
            if not parser.rcl_parse_yaml_file(os.fsencode(file), found):
                words = utils.rcutils_get_error_string().text.decode(errors='replace')
                utils.rcutils_reset_error()
                raise ValueError(f'{file}: {_without_source(words)}')
        return dict(_values(found.contents, full_name))
    finally:
        parser.rcl_yaml_node_struct_fini(found)


def _without_source(words: str) -> str:
    """Return an error of ROS 2 without the line of C that it comes from."""
    said, _, _ = words.rpartition(', at ')
    return ' '.join((said or words).split())


def _values(found: _Parameters, full_name: str) -> Iterator[tuple[str, Value]]:
    """Yield what matches a node in the order of rclcpp, in which later values win."""
    for number in range(found.count):
        key = found.keys[number].decode()
        if not _is_for(key, full_name):
            continue
        node = found.nodes[number]
        for at in range(node.count):
            name = node.names[at].decode()
            value = _value(node.values[at])
            if value is None:
                raise ValueError(f'the parameter {name!r} below {key!r} has no value')
            yield name, value


def _is_for(key: str, full_name: str) -> bool:
    """Tell whether a key is for a node, as is_node_name_matched() of rclcpp does."""
    pattern = f'/{key.removeprefix("/")}'.replace('/*', r'(/\w+)')
    return re.fullmatch(pattern, full_name, re.ASCII) is not None


def _value(found: _Variant) -> Value | None:
    """Return the value that rclcpp takes, None where it finds none."""
    for kind in ('bool', 'integer', 'double'):
        if pointer := getattr(found, kind):
            single: Value = pointer[0]
            return single
    if found.string is not None:
        text: str = found.string.decode()
        return text
    arrays: dict[str, Any] = {
        'bools': ctypes.c_bool,
        'integers': ctypes.c_int64,
        'doubles': ctypes.c_double,
    }
    for kind, element in arrays.items():
        if pointer := getattr(found, kind):
            items = ctypes.cast(pointer[0].values, ctypes.POINTER(element))
            return [items[at] for at in range(pointer[0].size)]
    if found.texts:
        return [found.texts[0].data[at].decode() for at in range(found.texts[0].size)]
    return None


# The nodes to load -------------------------------------------------------------------------------


def complete(component: Mapping[str, Any]) -> dict[str, Any]:
    """Return a node to load with the values of its files, which give way to its own."""
    if not component['files']:
        return {**component}
    read = values_of(component['files'], component['name'])
    return {**component, 'parameters': {**read, **component['parameters']}}


def unreadable(*pieces: str) -> int:
    """Print for which node of a JSON text the files cannot be read, and why; then return 1."""
    for each in (each for loaded in json.loads(''.join(pieces)).values() for each in loaded):
        try:
            complete(each)
        except ValueError as fault:  # noqa: PERF203
            print(f'  {each["name"]}: {fault}', end='')
            return 1
    return 0


def run_with_values(full_name: str, files: str, *command: str) -> None:
    """Become a command of ros2 that loads a node, with the values of its files."""
    words = [*command]
    own = words.index('--parameter') if '--parameter' in words else len(words)
    read = values_of(json.loads(files), full_name).items()
    words[own:own] = [w for name, value in read for w in ('--parameter', f'{name}:={yaml(value)}')]
    os.execvp(words[0], words)
