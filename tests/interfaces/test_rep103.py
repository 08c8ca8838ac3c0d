"""Units of the fields of common messages."""

from __future__ import annotations

import json
from pathlib import Path

from deros.interfaces import rep103
from deros.interfaces.fields import ResolvedField, resolve
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.interfaces.units import UnitRegistry

STORE = InterfaceStore(prefixes=())
TABLE = json.loads(Path(rep103.__file__).with_suffix(".json").read_text(encoding="utf-8"))


NESTED = (
    ("nav_msgs/Odometry", ("twist", "twist", "linear", "x"), "m/s"),
    ("nav_msgs/Odometry", ("twist", "twist", "angular", "z"), "rad/s"),
    ("nav_msgs/Odometry", ("pose", "pose", "position", "y"), "m"),
    ("nav_msgs/Odometry", ("twist", "covariance", 0), None),
    ("nav_msgs/Path", ("poses", 3, "pose", "position", "x"), "m"),
    ("sensor_msgs/Imu", ("angular_velocity", "x"), "rad/s"),
    ("sensor_msgs/Imu", ("orientation", "w"), None),
    ("sensor_msgs/LaserScan", ("ranges", 17), "m"),
    ("sensor_msgs/LaserScan", ("ranges",), "m"),
    ("sensor_msgs/BatteryState", ("percentage",), "1"),
    ("sensor_msgs/Imu", ("header", "stamp", "nanosec"), "ns"),
    ("trajectory_msgs/JointTrajectoryPoint", ("time_from_start", "sec"), "s"),
    ("std_msgs/Float64", ("data",), None),
    ("geometry_msgs/Twist", (), None),
    ("no_such/Thing", ("x", "y"), None),
)


def test_unit_applies_to_nested_fields_and_elements() -> None:
    """A unit applies wherever its message is nested, and to the elements of an array."""
    for kind, path, unit in NESTED:
        package, _, name = kind.partition("/")
        found = rep103.unit_of(STORE, InterfaceType(package, "msg", name), path)
        assert found == unit, (kind, path)


def test_table_has_real_fields_and_known_units() -> None:
    """Every row is a field of its message, and its unit can be parsed."""
    for kind in sorted(TABLE):
        package, _, name = kind.partition("/")
        for field, unit in TABLE[kind].items():
            resolved = resolve(STORE, InterfaceType(package, "msg", name), (field,))
            assert isinstance(resolved, ResolvedField), f"{kind}.{field}"
            plain = unit.removesuffix(" wrapping").removesuffix(" in [0, 1]")
            assert UnitRegistry().parse(plain) is not None, unit
