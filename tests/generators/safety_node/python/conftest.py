"""Fixtures for tests that run a generated safety node."""

from tests.support.safety_node import node, robot, start

__all__ = ["node", "robot", "start"]
