"""The robot of the fault tests, for what people do at one."""

from tests.faults.conftest import robot, software

__all__ = ["robot", "software"]
