"""Operations on the fields of a command, common to gates of all languages."""

from __future__ import annotations

from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType
from deros.rules.compiler.gates.command_types import command_types
from deros.rules.gates.gate_table import numbered_paths
from deros.rules.program.ir import Gate, GateLine, Limit, Source
from tests.support.gates import message_type, span

STORE = InterfaceStore()


def names(kind: str) -> dict[str, tuple[list[str], list[str]]]:
    """Return for each type in a command the fields to check and the fields that zero changes."""
    return {
        command_type.type.name: (
            [name for name, _ in command_type.finite],
            [name for name, _ in command_type.zeros],
        )
        for command_type in command_types(STORE, message_type(kind))
    }


def test_types_in_a_command_are_listed_innermost_first() -> None:
    """Zero changes only the stamp of a header."""
    assert list(names("geometry_msgs.TwistStamped").items()) == [
        ("Vector3", (["x", "y", "z"], ["x", "y", "z"])),
        ("Twist", (["linear", "angular"], ["linear", "angular"])),
        ("TwistStamped", (["twist"], ["header", "twist"])),
    ]


def test_strings_and_layouts_are_unchanged() -> None:
    """They are neither checked nor changed by zero."""
    assert names("std_msgs.String") == {}
    assert names("std_msgs.Int32MultiArray") == {"Int32MultiArray": ([], ["data"])}


def test_message_that_contains_a_stamped_one_is_stamped() -> None:
    """Creating a zero of it requires the time."""
    types = command_types(STORE, message_type("nav_msgs.Path"))
    assert {each.type.name: each.stamped for each in types} == {
        "Point": False,
        "Quaternion": False,
        "Pose": False,
        "PoseStamped": True,
        "Path": True,
    }


def test_zero_of_a_quaternion_is_the_identity() -> None:
    """Only the w of a quaternion becomes 1."""
    types = {e.type.name: e for e in command_types(STORE, message_type("geometry_msgs.Pose"))}
    assert [name for name, _ in types["Quaternion"].zeros if types["Quaternion"].is_one(name)] == [
        "w"
    ]
    assert not types["Point"].is_one("x")


def test_each_limited_field_is_listed_once() -> None:
    """Several lines may limit the same field."""
    kind = message_type("geometry_msgs.Twist")

    def line(*paths: tuple[str, ...]) -> GateLine:
        limits = tuple(Limit(path, FieldType("float64"), -1.0, 1.0) for path in paths)
        return GateLine(0, None, None, limits, span(2))

    lines = (line(("angular", "z"), ("linear", "x")), line(), line(("linear", "x")))
    gate = Gate(0, (Source("/wish"),), "/command", kind, 10, lines, span(1))
    assert numbered_paths(gate) == (("angular", "z"), ("linear", "x"))
