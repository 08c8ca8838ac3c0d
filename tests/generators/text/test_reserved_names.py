"""Packages and nodes whose names would hide names used by generated programs are rejected."""

from __future__ import annotations

import pytest

from deros.generators.node.cpp.generate import generate as generate_cpp
from deros.generators.node.python.generate import generate as generate_python
from tests.support.node_targets import files_of, in_each_language, refusal

PORT = "publishes topic odom : nav_msgs.Odometry"


@pytest.mark.parametrize(
    "package", ["signal", "rclpy", "std_msgs", "nav_msgs", "launch", "numpy", "yaml", "typing"]
)
def test_python_package_hides_no_module(package: str) -> None:
    """This covers the standard library, dependencies, message packages, and their imports."""
    code, message, line = refusal(generate_python, f"node a\n: {package} {PORT}")
    assert (code, line) == ("DRS405", 2)
    assert message.startswith(f"package {package!r} hides")


@pytest.mark.parametrize("node", ["signal", "rclpy", "std_msgs", "os", "queue"])
def test_python_node_hides_no_module(node: str) -> None:
    """Its module is found first if a module of its package is run as a program."""
    code, message, line = refusal(generate_python, f"node\n{node} : drive {PORT}")
    assert (code, line) == ("DRS405", 2)
    assert message.startswith(f"node {node!r} hides")


def test_custom_module_hides_no_module() -> None:
    """The module of the user's functions is named after their namespace."""
    text = 'node a : drive parameters name x : int = 1 custom "math::is_even"'
    code, message, _ = refusal(generate_python, text)
    assert code == "DRS405"
    assert message.startswith("module 'math' hides")


@pytest.mark.parametrize(
    "package",
    ["signal", "time", "rclcpp", "std_msgs", "nav_msgs", "rcl_interfaces", "rmw", "select"],
)
def test_cpp_namespace_hides_no_name(package: str) -> None:
    """C functions, libraries and message packages have these names already."""
    code, message, line = refusal(generate_cpp, f"node a\n: {package} {PORT}")
    assert (code, line) == ("DRS405", 2)
    assert message.startswith(f"package {package!r} hides")


def test_custom_namespace_hides_no_name() -> None:
    """The code would not compile."""
    text = 'node a : drive parameters name x : int = 1\ncustom "time::is_even"'
    code, message, line = refusal(generate_cpp, text)
    assert (code, line) == ("DRS405", 2)
    assert message.startswith("namespace 'time' hides")


@in_each_language
@pytest.mark.parametrize("name", ["drive", "signals", "odometry", "robot_safety", "navigation"])
def test_other_names_are_accepted(name: str, generate: object) -> None:
    """A node may have the name of its package."""
    target = generate_cpp if generate is generate_cpp else generate_python
    assert files_of(target, f"node {name} : {name} {PORT}")
