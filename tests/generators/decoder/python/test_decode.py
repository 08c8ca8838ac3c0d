"""Decoders read what rclpy reads, from any data."""

from __future__ import annotations

import ctypes
import math
import mmap
import random
import struct
import sys
import tracemalloc
from collections.abc import Callable
from pathlib import Path as FilePath
from types import FrameType, SimpleNamespace
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

pytest.importorskip("test_msgs.msg")

import numpy as np
import sensor_msgs.msg
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState, LaserScan, PointCloud2, PointField
from test_msgs.msg import UnboundedSequences, WStrings

from deros.interfaces.fields import FieldPath
from deros.interfaces.types import FieldType, InterfaceType, MessageDefinition
from tests.support.cdr import Decoder, decoder, serialize
from tests.support.messages import (
    STORE,
    Definitions,
    Messages,
    message_class,
    message_types,
    random_paths,
    read,
)
from tests.support.narrow import narrow
from tests.support.profiles import scaled

TYPES = [
    kind
    for kind in message_types(
        "std_msgs",
        "geometry_msgs",
        "sensor_msgs",
        "nav_msgs",
        "test_msgs",
        "diagnostic_msgs",
        "trajectory_msgs",
        "visualization_msgs",
    )
    if random_paths(STORE, kind, random.Random(0))
]


def _draw(kind: InterfaceType, rng: random.Random) -> tuple[Any, list[FieldPath]]:
    """Return a message, and up to five paths into it."""
    return Messages().draw(kind, rng), random_paths(STORE, kind, rng, keys=True)


def _same(left: list[Any], right: list[Any]) -> bool:
    """Compare values and their types; NaN equals NaN."""
    return repr(left) == repr(right)


seeds = st.integers(0, 2**32)


# Values -------------------------------------------------------------------------------------------


@settings(max_examples=scaled(8))
@given(seed=seeds)
@pytest.mark.parametrize("kind", TYPES, ids=str)
def test_decoded_values_match_rclpy(kind: InterfaceType, seed: int) -> None:
    """Any fields of any message, in both byte orders, have the same values and types."""
    message, paths = _draw(kind, random.Random(seed))
    decode = decoder(kind, paths)
    expected = [read(STORE, message, kind, path) for path in paths]
    for data in (serialize_message(message), serialize(message, kind, big_endian=True)):
        assert _same(decode.values(data), expected), (paths, decode.text)


@given(seed=seeds, big_endian=st.booleans())
@example(seed=315, big_endian=False)  # a single value: a short array, or NaN where it is missing
def test_arbitrary_message_types_are_decoded(seed: int, big_endian: bool) -> None:
    """Generated types, with every alignment in every position, are read as well."""
    rng = random.Random(seed)
    types = Definitions.draw(rng)
    message = Messages(types, lambda _: SimpleNamespace()).draw(types.last, rng)
    paths = random_paths(types, types.last, rng, keys=True)
    decode = decoder(types.last, paths, types)
    data = serialize(message, types.last, big_endian, types)
    expected = [read(types, message, types.last, path) for path in paths]
    assert _same(decode.values(data), expected), (types, paths, decode.text)
    _check_truncated(decode, data, rng)


@pytest.mark.parametrize("width", [20, 40])
def test_narrow_decoders_read_the_same(width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where lines break changes no value; an array in brackets would be a tuple of one."""
    narrow(width, monkeypatch)
    for seed in range(60):
        rng = random.Random(seed)
        types = Definitions.draw(rng)
        message = Messages(types, lambda _: SimpleNamespace()).draw(types.last, rng)
        paths = random_paths(types, types.last, rng, keys=True)
        decode = decoder(types.last, paths, types)
        expected = [read(types, message, types.last, path) for path in paths]
        data = serialize(message, types.last, False, types)
        assert _same(decode.values(data), expected), (types, paths, decode.text)


@pytest.mark.parametrize("big_endian", [False, True])
@pytest.mark.parametrize("length", [0, 1, 2, 3])
@pytest.mark.parametrize(
    "element", ["uint8", "float64", "uint8 uint16", "uint8 float64", "uint16 float64 uint8"]
)
def test_field_after_an_array_is_found(element: str, length: int, big_endian: bool) -> None:
    """The number, alignment and size of the elements do not matter."""
    item, kind = (InterfaceType("made_up", "msg", name) for name in ("Item", "Message"))
    parts = tuple((f"part_{n}", FieldType(base)) for n, base in enumerate(element.split()))
    for base in ("uint8", "uint32", "float64"):
        whole = (("array", FieldType(item, "unbounded")), ("after", FieldType(base)))
        types = Definitions(
            {item: MessageDefinition(item, parts), kind: MessageDefinition(kind, whole)}
        )
        items = [SimpleNamespace(**{name: n for name, _ in parts}) for n in range(length)]
        data = serialize(SimpleNamespace(array=items, after=42), kind, big_endian, types)
        decode = decoder(kind, [("after",), ("array",)], types)
        assert decode.values(data) == [42, length]


@given(kind=st.sampled_from(TYPES), seed=seeds)
def test_test_serializer_agrees_with_the_middleware(kind: InterfaceType, seed: int) -> None:
    """The big-endian data of these tests is valid: the middleware reads the same message."""
    message = Messages().draw(kind, random.Random(seed))
    for big_endian in (False, True):
        data = serialize(message, kind, big_endian)
        assert repr(deserialize_message(data, message_class(kind))) == repr(message)


@settings(max_examples=scaled(20))
@given(seed=seeds, big_endian=st.booleans())
@pytest.mark.parametrize("name", ["Imu", "BatteryState", "CameraInfo", "LaserScan", "PointCloud2"])
def test_rosbags_data_is_decoded(name: str, seed: int, big_endian: bool) -> None:
    """Data of a writer that is independent of the middleware is read as well."""
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    kind = InterfaceType("sensor_msgs", "msg", name)
    message, paths = _draw(kind, random.Random(seed))
    if name == "CameraInfo":
        message.d = message.d or [0.5]  # rosbags pads empty sequences, unlike the middleware
    theirs = store.deserialize_cdr(serialize(message, kind, big_endian=False), str(kind))
    data = bytes(store.serialize_cdr(theirs, str(kind), little_endian=not big_endian))
    expected = [read(STORE, message, kind, path) for path in paths]
    assert _same(decoder(kind, paths).values(data), expected), paths


def test_wide_characters_are_utf_16_units() -> None:
    """A character outside the basic plane takes two units; a null is an ordinary character."""
    message = WStrings(wstring_value="a\0\u20ac\U0001f600", array_of_wstrings=["", "b", "c"])
    kind = InterfaceType("test_msgs", "msg", "WStrings")
    decode = decoder(kind, [("wstring_value",), ("array_of_wstrings", 2), ("array_of_wstrings",)])
    expected = ["a\0\u20ac\U0001f600", "c", ["", "b", "c"]]
    assert decode.values(serialize_message(message)) == expected
    assert decode.values(serialize(message, kind, big_endian=True)) == expected


def test_strings_are_decoded_like_rclpy() -> None:
    """A null ends the string, invalid UTF-8 is replaced, and the final null may be missing."""
    from std_msgs.msg import String

    decode = decoder(InterfaceType("std_msgs", "msg", "String"), [("data",)])
    for text in (b"stop\0", b"stop", b"st\0op\0", b"st\xffop\0", b"\0", b""):
        data = b"\0\1\0\0" + struct.pack("<I", len(text)) + text
        assert decode.values(data) == [deserialize_message(data, String).data]


def test_numbers_are_python_numbers_and_arrays_are_views() -> None:
    """Elements keep their precision, and long arrays are not copied."""
    message = LaserScan(ranges=[0.5, 1.5], range_max=10.0)
    kind = InterfaceType("sensor_msgs", "msg", "LaserScan")
    data = serialize_message(message)
    (element, ranges, longest) = decoder(kind, [("ranges", 1), ("ranges",), ("range_max",)]).decode(
        data
    )
    assert (type(element), type(longest)) == (float, float)
    assert isinstance(ranges, np.ndarray)
    assert not ranges.flags.writeable
    assert not ranges.flags.owndata


def test_missing_element_is_nan() -> None:
    """This holds at each depth, even if all elements before it exist."""
    kind = InterfaceType("sensor_msgs", "msg", "JointState")
    data = serialize_message(JointState(name=["a", "b"], position=[1.0, 2.0]))
    values = decoder(kind, [("position", 1), ("position", 2), ("name", 2), ("effort", 0)])
    second, *others = values.values(data)
    assert second == 2.0
    assert all(map(math.isnan, others))


# Invalid data -------------------------------------------------------------------------------------


@settings(max_examples=scaled(60))
@given(kind=st.sampled_from(TYPES), seed=seeds, big_endian=st.booleans())
def test_truncated_data_is_rejected(kind: InterfaceType, seed: int, big_endian: bool) -> None:
    """Wherever a message ends, the result is an error, or complete values from its start."""
    rng = random.Random(seed)
    message, paths = _draw(kind, rng)
    decode = decoder(kind, paths)
    _check_truncated(decode, serialize(message, kind, big_endian), rng)


def _check_truncated(decode: Decoder, data: bytes, rng: random.Random) -> None:
    whole = decode.values(data)
    ends = range(len(data)) if len(data) < 400 else rng.sample(range(len(data)), 400)
    for end in ends:
        try:
            values = decode.values(data[:end])
        except decode.errors:
            continue
        assert _same(values, whole), end


@given(kind=st.sampled_from(TYPES), seed=seeds)
def test_damaged_data_raises_only_the_documented_error(kind: InterfaceType, seed: int) -> None:
    """Whatever the bytes, including lengths of billions, the decoder returns quickly."""
    rng = random.Random(seed)
    message, paths = _draw(kind, rng)
    decode = decoder(kind, paths)
    whole = serialize(message, kind, rng.random() < 0.5)
    for _ in range(20):
        data = bytearray(whole)
        for _ in range(rng.randint(1, 3)):
            at = rng.randrange(len(data))
            data[at : at + 4] = rng.choice((b"\xff\xff\xff\xff", b"\x7f", rng.randbytes(4)))
        try:
            decode.values(bytes(data))
        except decode.errors:
            continue


@pytest.mark.parametrize("length", [1000, 2**31, 2**32 - 1])
@pytest.mark.parametrize(
    "path",
    [
        ("bool_values",),
        ("float64_values",),
        ("string_values",),
        ("basic_types_values",),
        ("constants_values",),
        ("alignment_check",),
    ],
    ids=str,
)
def test_length_beyond_the_data_allocates_nothing(path: FieldPath, length: int) -> None:
    """A sequence that claims too many elements is rejected at once."""
    kind = InterfaceType("test_msgs", "msg", "UnboundedSequences")
    names = [name for name in UnboundedSequences.get_fields_and_field_types() if "def" not in name]
    claimed = path[0] if path[0] in names[:-1] else "basic_types_values"
    decode = decoder(kind, [path])
    data = b"\0\1\0\0" + bytes(4 * names.index(str(claimed))) + struct.pack("<I", length)
    data += bytes(400)
    tracemalloc.start()
    with pytest.raises(decode.errors):
        decode.decode(data)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 100_000


@pytest.mark.parametrize("start", [b"", b"\0", b"\0\2\0\0", b"\0\7\0\0", b"\1\1\0\0"])
def test_only_plain_cdr_is_accepted(start: bytes) -> None:
    """Parameter lists and the second version of CDR have other layouts."""
    kind = InterfaceType("std_msgs", "msg", "Float64")
    for paths in ([("data",)], []):
        decode = decoder(kind, paths)
        with pytest.raises(ValueError, match="not plain CDR"):
            decode.decode(start + bytes(8) if len(start) == 4 else start)


# Cost ---------------------------------------------------------------------------------------------


def test_unselected_data_is_not_touched() -> None:
    """Of 10 MB between the selected fields, no page is read and nothing is copied."""
    fields = [PointField(name=name, count=1) for name in ("x", "y", "z", "intensity")]
    message = PointCloud2(width=10_000_000, height=1, fields=fields, is_dense=True)
    message.data.frombytes(bytes(10_000_000))
    data = serialize_message(message)
    kind = InterfaceType("sensor_msgs", "msg", "PointCloud2")
    decode = decoder(kind, [("width",), ("is_dense",), ("data",)])
    page = mmap.PAGESIZE
    shared = mmap.mmap(-1, len(data))  # a page of it exists once it is written or read
    for start in range(0, len(data), page):
        if any(data[start : start + page]):
            shared[start : start + page] = data[start : start + page]
    before = _resident_kb(shared)
    tracemalloc.start()
    width, is_dense, points = decode.decode(shared)  # type: ignore[arg-type]
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert (width, is_dense, len(points)) == (10_000_000, True, 10_000_000)
    assert peak < 100_000
    assert _resident_kb(shared) <= before + 100
    assert not any(points)
    assert _resident_kb(shared) > 9000  # pages that are read do count


def _resident_kb(shared: mmap.mmap) -> int:
    """Return how much of a mapping this process has touched."""
    address = f"{ctypes.addressof(ctypes.c_char.from_buffer(shared)):08x}-"
    lines = iter(FilePath("/proc/self/smaps").read_text(encoding="utf-8").splitlines())
    next(line for line in lines if line.startswith(address))
    return int(next(line for line in lines if line.startswith("Rss:")).split()[1])


@pytest.mark.parametrize(
    ("kind", "path"),
    [
        ("LaserScan", ("range_max",)),
        ("LaserScan", ("ranges",)),
        ("PointCloud2", ("is_dense",)),
        ("JointState", ("position",)),
    ],
)
def test_work_does_not_grow_with_the_numbers(kind: str, path: FieldPath) -> None:
    """A decoder takes as many steps for a thousand numbers as for one."""
    decode = decoder(InterfaceType("sensor_msgs", "msg", kind), [path])

    def steps(count: int) -> int:
        message = getattr(sensor_msgs.msg, kind)()
        for name in ("ranges", "intensities", "data", "position", "velocity", "effort"):
            if hasattr(message, name):
                setattr(message, name, [1] * count if name == "data" else [1.0] * count)
        data = serialize_message(message)
        return _steps(lambda: decode.decode(data))

    assert steps(1000) == steps(1) > 5


def _steps(function: Callable[[], object]) -> int:
    """Return how many instructions of Python a call takes."""
    count = 0

    def trace(frame: FrameType, event: str, _argument: object) -> Any:
        nonlocal count
        frame.f_trace_opcodes = True
        count += event == "opcode"
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        function()
    finally:
        sys.settrace(before)
    return count
