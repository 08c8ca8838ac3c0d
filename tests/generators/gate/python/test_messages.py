"""Message functions of generated gates agree with the reference on plain data."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest

from deros.generators.gate.python.messages import type_views
from deros.interfaces.fields import FieldPath, ResolvedField, resolve
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType
from deros.rules.program import commands
from deros.rules.program.ir import Gate, GateLine, Limit, Source, Stop
from tests.support.gates import STORE, message_type, modules_of, span, view_of
from tests.support.messages import Messages, message_types, random_paths

PACKAGES = (
    "builtin_interfaces",
    "diagnostic_msgs",
    "geometry_msgs",
    "nav_msgs",
    "sensor_msgs",
    "std_msgs",
    "test_msgs",
    "trajectory_msgs",
)
NO_COMMANDS = {message_type("std_msgs.Header"), message_type("std_msgs.MultiArrayLayout")}
"""Parts of messages that determine how to read the rest."""

TYPES = [kind for kind in message_types(*PACKAGES) if kind not in NO_COMMANDS]
STAMP_NS = 1_234_567_890_123


def functions(kind: InterfaceType, limits: tuple[Limit, ...] = ()) -> dict[str, Any]:
    """Return the message functions of a gate for commands of a type."""
    lines = (
        GateLine(0, None, None, (), span(2), stop=Stop()),
        *(GateLine(1, None, None, (limit,), span(3)) for limit in limits),
    )
    gate = Gate(0, (Source("/wish"),), "/command", kind, 10, lines, span(1))
    return modules_of(view_of(gate))["message"]


def plain(message: Any, kind: InterfaceType) -> dict[str, Any]:
    """Return a message of rclpy as plain data."""
    definition = STORE.message(kind)
    assert definition is not None
    return {name: _plain(getattr(message, name), field) for name, field in definition.fields}


def _plain(value: Any, field: FieldType) -> Any:
    if field.is_array:
        return [_plain(each, field.element) for each in value]
    if isinstance(field.base, InterfaceType):
        return plain(value, field.base)
    if field.base == "byte":
        return value[0]
    return value.item() if hasattr(value, "item") else value


@pytest.mark.parametrize("kind", TYPES, ids=lambda kind: kind.short)
def test_zeros_and_nan_agree_with_the_reference_for_every_type(kind: InterfaceType) -> None:
    """Each float is checked, each number zeroed, and the rest is unchanged."""
    from builtin_interfaces.msg import Time

    rng = random.Random(str(kind))
    message_functions = functions(kind)
    stamp = Time(sec=STAMP_NS // 10**9, nanosec=STAMP_NS % 10**9)
    takes_stamp = [stamp] if view_of_type(kind).stamped else []
    for _ in range(5):
        message = Messages().draw(kind, rng)
        data = plain(message, kind)
        assert message_functions.get("is_finite", lambda _: True)(message) == commands.is_finite(
            data
        )
        if "make_zero" in message_functions:
            message_functions["make_zero"](message, *takes_stamp)
        assert plain(message, kind) == commands.zero(STORE, kind, data, STAMP_NS)


def view_of_type(kind: InterfaceType) -> Any:
    """Return the view of a gate with one line."""
    line = GateLine(0, None, None, (), span(2), stop=Stop())
    return view_of(Gate(0, (Source("/wish"),), "/command", kind, 10, (line,), span(1)))


@pytest.mark.parametrize(
    "name",
    [
        "geometry_msgs.Twist",
        "geometry_msgs.TwistStamped",
        "nav_msgs.Odometry",
        "sensor_msgs.JointState",
        "std_msgs.Byte",
        "std_msgs.Float64MultiArray",
        "std_msgs.Int32",
        "test_msgs.Arrays",
        "test_msgs.BoundedSequences",
        "test_msgs.MultiNested",
        "test_msgs.UnboundedSequences",
        "trajectory_msgs.JointTrajectory",
        "trajectory_msgs.JointTrajectoryPoint",
    ],
)
def test_limits_on_every_kind_of_field(name: str) -> None:
    """A number alone or in an array is read and limited as in plain data."""
    kind = message_type(name)
    rng = random.Random(name)
    checked = 0
    for _ in range(40):
        limits = tuple(
            limit
            for path in random_paths(STORE, kind, rng)
            if (limit := _limit(kind, path)) is not None
        )
        if not limits:
            continue
        message_functions = functions(kind, limits)
        message = Messages().draw(kind, rng)
        data = plain(message, kind)
        values = message_functions["numbers"](message)
        assert repr(list(values)) == repr([commands.value_at(data, e.path) for e in limits])
        if not commands.is_finite(values):
            continue
        within = [
            None if value is None else max(limit.lower, min(limit.upper, value))
            for value, limit in zip(values, limits, strict=True)
        ]
        message_functions["put"](message, tuple(within))
        assert repr(plain(message, kind)) == repr(commands.limited(data, limits))
        checked += 1
    assert checked > 3


def _limit(kind: InterfaceType, path: FieldPath) -> Limit | None:
    field = resolve(STORE, kind, path)
    assert isinstance(field, ResolvedField)
    if not field.type.is_number:
        return None
    ends = (-0.5, 0.5) if field.type.is_float else (0, 3)
    return Limit(path, field.type, *ends)


def test_types_of_one_name_get_separate_functions(tmp_path: Path) -> None:
    """This holds even if one contains the other, from another package."""
    for package, field in (("inner", "float64 x"), ("outer", "inner/Speed speed")):
        folder = tmp_path / package / "msg"
        folder.mkdir(parents=True)
        (folder / "Speed.msg").write_text(f"{field}\n", encoding="utf-8")
    (tmp_path / "outer" / "msg" / "Command.msg").write_text("Speed speed\n", encoding="utf-8")
    views = type_views(InterfaceStore([tmp_path]), message_type("outer.Command"))
    assert [(view.prefix, view.finite) for view in views] == [
        ("speed_", ("isfinite(msg.x)",)),
        ("outer_speed_", ("speed_is_finite(msg.speed)",)),
        ("", ("outer_speed_is_finite(msg.speed)",)),
    ]
