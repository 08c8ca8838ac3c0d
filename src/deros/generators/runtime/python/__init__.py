"""Modules that go out into packages where nodes need them; they depend on nothing but ROS 2."""
