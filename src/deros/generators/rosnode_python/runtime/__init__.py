"""Modules that go out into every package with actions, and depend on nothing but ROS 2."""
