"""The fields that rules speak of, as generators look them up."""

from __future__ import annotations

from deros.interfaces.message_fields import field_type, unsized_arrays
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType

STORE = InterfaceStore()


def test_the_type_of_an_element_is_that_of_one_number() -> None:
    """An index leads into the array."""
    imu = InterfaceType("sensor_msgs", "msg", "Imu")
    assert field_type(STORE, imu, ("orientation_covariance", 8)) == FieldType("float64")


def test_arrays_that_may_be_too_short_come_outermost_first() -> None:
    """An array of a fixed length always has the element."""
    trajectory = InterfaceType("trajectory_msgs", "msg", "JointTrajectory")
    path = ("points", 2, "positions", 1)
    assert list(unsized_arrays(STORE, trajectory, path)) == [
        (("points",), 2),
        (("points", 2, "positions"), 1),
    ]
    imu = InterfaceType("sensor_msgs", "msg", "Imu")
    assert list(unsized_arrays(STORE, imu, ("orientation_covariance", 8))) == []
