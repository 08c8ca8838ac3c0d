"""Fixtures of the tests that run a generated safety node."""

from tests.support.safety_node import package, robot, start

__all__ = ["package", "robot", "start"]
