"""Field lookups for generators."""

from __future__ import annotations

from deros.interfaces.message_fields import field_type, unsized_arrays
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType

STORE = InterfaceStore()


def test_type_of_an_array_element_is_that_of_one_number() -> None:
    """The type of an indexed element is that of one number."""
    imu = InterfaceType("sensor_msgs", "msg", "Imu")
    assert field_type(STORE, imu, ("orientation_covariance", 8)) == FieldType("float64")


def test_unsized_arrays_are_listed_outermost_first() -> None:
    """An array of fixed length always has the element."""
    trajectory = InterfaceType("trajectory_msgs", "msg", "JointTrajectory")
    path = ("points", 2, "positions", 1)
    assert list(unsized_arrays(STORE, trajectory, path)) == [
        (("points",), 2),
        (("points", 2, "positions"), 1),
    ]
    imu = InterfaceType("sensor_msgs", "msg", "Imu")
    assert list(unsized_arrays(STORE, imu, ("orientation_covariance", 8))) == []
