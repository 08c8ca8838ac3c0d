"""Rounds of the campaign that once showed a violation: each is replayed and must pass."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.chaos.bench import Bench, running
from tests.support.chaos.campaign import EXAMPLE, generate_packages
from tests.support.chaos.round import play
from tests.support.chaos.schedule import Schedule
from tests.support.needs import needs
from tests.support.ros import environment

pytestmark = pytest.mark.ros

SCHEDULES = sorted((Path(__file__).parent / "schedules").glob("*.json"))


@pytest.fixture(scope="module", params=["python", pytest.param("cpp", marks=needs("rclcpp"))])
def bench(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Bench]:
    """Return the running robot, with safety node and gate in each language."""
    patch = pytest.MonkeyPatch()
    for name, value in environment(0).items():
        patch.setenv(name, value)
    patch.syspath_prepend(str(EXAMPLE))
    folder = tmp_path_factory.mktemp("chaos")
    software = generate_packages(folder, request.param == "cpp")
    with running(software, folder, 0) as robot:
        yield robot
    patch.undo()


@needs("gcc")
@pytest.mark.slow
@pytest.mark.parametrize("path", SCHEDULES, ids=lambda path: path.stem)
def test_former_counterexample_has_no_violation(bench: Bench, path: Path) -> None:
    """The referee no longer finds a violation."""
    verdict = play(bench, Schedule.load(path))
    assert verdict.moved
    assert verdict.violations == []
