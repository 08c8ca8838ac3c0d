"""Runners of gates in each language; they look the same to the other nodes."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from subprocess import Popen
from typing import Protocol

import pytest

from tests.support import gate_cpp_nodes, gate_nodes
from tests.support.needs import needs


class RunGate(Protocol):
    """Runs a gate, by the name that it runs by."""

    def __call__(
        self, gate: str, env: Mapping[str, str], *parameters: str
    ) -> AbstractContextManager[Popen[str]]:
        """Return the process, which ends with the block."""


def in_python(folder: Path) -> RunGate:
    """Generate the gates of the model in Python."""
    package = gate_nodes.write_gates(folder)

    def run(
        gate: str, env: Mapping[str, str], *parameters: str
    ) -> AbstractContextManager[Popen[str]]:
        return gate_nodes.running_gate(package, gate, dict(env), *parameters)

    return run


def in_cpp(_folder: Path) -> RunGate:
    """Generate the same gates in C++, and build them."""
    gate_cpp_nodes.installed_gates()
    return gate_cpp_nodes.running_gate


LANGUAGES = [
    pytest.param(in_python, id="python"),
    pytest.param(in_cpp, id="cpp", marks=needs("rclcpp")),
]
"""Parameters of a fixture that gives a :class:`RunGate`, made in a folder of the test's own."""
