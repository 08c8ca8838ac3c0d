"""A gate in each language, and its surroundings simulated by the test."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from subprocess import Popen

import pytest

from tests.support.gate_nodes import GATE, World
from tests.support.gate_runners import LANGUAGES, RunGate
from tests.support.ros import Peer


@pytest.fixture(params=LANGUAGES)
def run_gate(request: pytest.FixtureRequest, tmp_path: Path) -> RunGate:
    """Return a function that runs the generated gates of a language."""
    made: RunGate = request.param(tmp_path)
    return made


@pytest.fixture
def world(ros_peer: Peer) -> World:
    """Return the simulated surroundings of the gate, including the safety node."""
    return World(ros_peer)


@pytest.fixture
def gate(run_gate: RunGate, ros_env: dict[str, str], world: World) -> Iterator[Popen[str]]:
    """Run the gate until commands pass."""
    with run_gate(GATE, ros_env) as process:
        world.meet()
        world.release()
        yield process
