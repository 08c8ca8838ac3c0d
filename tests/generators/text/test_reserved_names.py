"""Packages and nodes whose names hide what the generated programs need are refused."""

from __future__ import annotations

import pytest

from deros.generators.node.cpp.generate import generate as generate_cpp
from deros.generators.node.python.generate import generate as generate_python
from tests.support.node_targets import files_of, in_each_language, refusal

PORT = "publishes topic odom : nav_msgs.Odometry"


@pytest.mark.parametrize(
    "package", ["signal", "rclpy", "std_msgs", "nav_msgs", "launch", "numpy", "yaml", "typing"]
)
def test_a_python_package_hides_no_module(package: str) -> None:
    """Standard library, dependencies, packages with messages, and what these import."""
    code, message, line = refusal(generate_python, f"node a\n: {package} {PORT}")
    assert (code, line) == ("DRS405", 2)
    assert message.startswith(f"package {package!r} hides")


@pytest.mark.parametrize("node", ["signal", "rclpy", "std_msgs", "os", "queue"])
def test_a_python_node_hides_no_module(node: str) -> None:
    """Its module is found first where a module of its package is run as a program."""
    code, message, line = refusal(generate_python, f"node\n{node} : drive {PORT}")
    assert (code, line) == ("DRS405", 2)
    assert message.startswith(f"node {node!r} hides")


def test_a_custom_module_hides_none() -> None:
    """The module of the user's functions is called after their namespace."""
    text = 'node a : drive parameters name x : int = 1 custom "math::is_even"'
    code, message, _ = refusal(generate_python, text)
    assert code == "DRS405"
    assert message.startswith("module 'math' hides")


@pytest.mark.parametrize(
    "package",
    ["signal", "time", "rclcpp", "std_msgs", "nav_msgs", "rcl_interfaces", "rmw", "select"],
)
def test_a_namespace_is_no_other_name(package: str) -> None:
    """Functions of C, libraries, and packages with messages are there before."""
    code, message, line = refusal(generate_cpp, f"node a\n: {package} {PORT}")
    assert (code, line) == ("DRS405", 2)
    assert message.startswith(f"package {package!r} hides")


def test_a_custom_namespace_is_no_other_name() -> None:
    """It would not compile."""
    text = 'node a : drive parameters name x : int = 1\ncustom "time::is_even"'
    code, message, line = refusal(generate_cpp, text)
    assert (code, line) == ("DRS405", 2)
    assert message.startswith("namespace 'time' hides")


@in_each_language
@pytest.mark.parametrize("name", ["drive", "signals", "odometry", "robot_safety", "navigation"])
def test_other_names_are_fine(name: str, generate: object) -> None:
    """A node may be called as its package is."""
    target = generate_cpp if generate is generate_cpp else generate_python
    assert files_of(target, f"node {name} : {name} {PORT}")
