"""The C++ runtime as a program with a command interface."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.safety_cpp import Harness, compiled

HERE = Path(__file__).resolve().parent


@pytest.fixture(scope="session")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the compiled program."""
    return compiled(HERE / "harness.cpp", tmp_path_factory.mktemp("harness"))


@pytest.fixture
def harness(program: Path) -> Iterator[Harness]:
    """Return a running harness."""
    harness = Harness(program)
    yield harness
    harness.close()
