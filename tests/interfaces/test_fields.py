"""Resolving field paths."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.interfaces.fields import (
    FieldError,
    FieldPath,
    Key,
    ResolvedField,
    format_path,
    leaves,
    parse_path,
    resolve,
)
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType

STORE = InterfaceStore(prefixes=())
ODOMETRY = InterfaceType("nav_msgs", "msg", "Odometry")


def message(name: str) -> InterfaceType:
    """Return the message type ``package/Name``."""
    package, _, short = name.partition("/")
    return InterfaceType(package, "msg", short)


@pytest.mark.parametrize(
    ("kind", "path", "type_text", "parent"),
    [
        ("nav_msgs/Odometry", ("twist", "twist", "linear", "x"), "float64", "Vector3"),
        ("nav_msgs/Odometry", ("pose", "covariance"), "float64[36]", "PoseWithCovariance"),
        ("nav_msgs/Odometry", ("pose", "covariance", 35), "float64", "PoseWithCovariance"),
        ("sensor_msgs/JointState", ("position", 2), "float64", "JointState"),
        ("sensor_msgs/JointState", ("name", 0), "string", "JointState"),
        (
            "diagnostic_msgs/DiagnosticArray",
            ("status", 7, "level"),
            "byte",
            "DiagnosticStatus",
        ),
        ("shape_msgs/SolidPrimitive", ("dimensions", 2), "float64", "SolidPrimitive"),
    ],
)
def test_path_resolves_to_field(kind: str, path: FieldPath, type_text: str, parent: str) -> None:
    """Fields, nested fields and array elements have a type and a parent message."""
    field = resolve(STORE, message(kind), path)
    assert isinstance(field, ResolvedField)
    assert str(field.type) == type_text
    assert field.parent is not None
    assert field.parent.type.name == parent
    assert field.name in path


@pytest.mark.parametrize(
    ("kind", "text", "path", "type_text"),
    [
        (
            "diagnostic_msgs/DiagnosticArray",
            'status[name = "a \\"b\\" ]"].values[key = "\u00e4"].value',
            ("status", Key("name", 'a "b" ]'), "values", Key("key", "\u00e4"), "value"),
            "string",
        ),
        (
            "sensor_msgs/JointState",
            'position[name = "elbow"]',
            ("position", Key("name", "elbow")),
            "float64",
        ),
        (
            "diagnostic_msgs/DiagnosticArray",
            "status[level = 2].name",
            ("status", Key("level", 2), "name"),
            "string",
        ),
    ],
)
def test_keys_are_read_written_and_resolved(
    kind: str, text: str, path: FieldPath, type_text: str
) -> None:
    """A key is one of the element, or of an array beside the one that it is in."""
    assert parse_path(text) == path
    assert format_path(path) == text
    found = resolve(STORE, message(kind), path)
    assert isinstance(found, ResolvedField), found
    assert str(found.type) == type_text


def test_empty_path_is_the_whole_message() -> None:
    """``topic /odom`` without a field means the whole message."""
    assert resolve(STORE, ODOMETRY, ()) == ResolvedField(FieldType(ODOMETRY), None, "")


@pytest.mark.parametrize(
    ("kind", "path", "position", "fragment", "candidates"),
    [
        ("nav_msgs/Odometry", ("twist", "twsit"), 1, "has no field 'twsit'", ("twist",)),
        ("std_msgs/Bool", ("zzz",), 0, "std_msgs.Bool has no field", ("data",)),
        ("std_msgs/Bool", ("data", "x"), 1, "'data' (bool) has no fields", ()),
        ("std_msgs/Bool", ("data", 0), 1, "is not an array", ()),
        ("std_msgs/Bool", (0,), 0, "the message (std_msgs/msg/Bool) is not an array", ()),
        ("sensor_msgs/LaserScan", ("ranges", "x"), 1, "an index or a key is needed", ()),
        ("sensor_msgs/Imu", ("orientation_covariance", 9), 1, "has 9 elements, 0 to 8", ()),
        ("shape_msgs/SolidPrimitive", ("dimensions", 3), 1, "has at most 3 elements", ()),
        ("sensor_msgs/JointState", ("position", -1), 1, "start at 0", ()),
        (
            "sensor_msgs/JointState",
            ("position", Key("nmae", "a")),
            1,
            "beside 'position' (float64[]) there is no array 'nmae'",
            ("name",),
        ),
        ("sensor_msgs/JointState", ("position", Key("name", 3)), 1, "is never 3", ()),
        ("sensor_msgs/JointState", ("header", Key("name", "a")), 1, "is not an array", ()),
        ("sensor_msgs/JointState", ("position", Key("velocity", 3)), 1, "no array", ()),
        (
            "diagnostic_msgs/DiagnosticArray",
            ("status", Key("values", "a"), "level"),
            1,
            "the elements of 'status' (diagnostic_msgs/msg/DiagnosticStatus[]) have no field",
            ("name", "message", "hardware_id"),
        ),
        ("diagnostic_msgs/DiagnosticArray", ("status", Key("level", 256)), 1, "is never 256", ()),
        ("no_such/Thing", ("x",), 0, "no_such.Thing is not known", ()),
    ],
)
def test_unresolved_path_gives_position_and_candidates(
    kind: str,
    path: FieldPath,
    position: int,
    fragment: str,
    candidates: tuple[str, ...],
) -> None:
    """The error has the index of the wrong part, the reason, and similar names."""
    error = resolve(STORE, message(kind), path)
    assert isinstance(error, FieldError)
    assert error.position == position
    assert fragment in error.message
    assert error.candidates == candidates


@pytest.mark.parametrize(
    ("path", "names"),
    [
        ((), []),
        (("data", 0), ["Int16MultiArray"]),
        (
            ("layout", "dim", 2, "size"),
            ["Int16MultiArray", "MultiArrayLayout", "MultiArrayDimension"],
        ),
    ],
)
def test_messages_around_a_field_are_all_that_its_path_goes_through(
    path: FieldPath, names: list[str]
) -> None:
    """Not only the one whose field it ends with."""
    kind = message("std_msgs/Int16MultiArray")
    found = resolve(STORE, kind, path)
    assert isinstance(found, ResolvedField)
    assert [each.name for each in found.around] == names


def test_leaves_are_primitive_fields_in_order(tmp_path: Path) -> None:
    """Nested messages are expanded; arrays and unknown messages are leaves."""
    folder = tmp_path / "my_msgs/msg"
    folder.mkdir(parents=True)
    (folder / "Thing.msg").write_text("geometry_msgs/Point p\nfloat32[] r\nGone gone\n")
    store = InterfaceStore([tmp_path], prefixes=())
    paths = [
        (format_path(path), str(kind)) for path, kind in leaves(store, message("my_msgs/Thing"))
    ]
    assert paths == [
        ("p.x", "float64"),
        ("p.y", "float64"),
        ("p.z", "float64"),
        ("r", "float32[]"),
        ("gone", "my_msgs/msg/Gone"),
    ]


def test_format_path_uses_brackets_for_indices() -> None:
    """Indices are in brackets, also at the start and in sequence."""
    assert format_path(("a", 0, 1, "b", "c")) == "a[0][1].b.c"
    assert format_path((3, "x")) == "[3].x"
