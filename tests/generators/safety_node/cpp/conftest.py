"""Fixtures for tests that run the node."""

from tests.support.safety_node import robot

__all__ = ["robot"]
