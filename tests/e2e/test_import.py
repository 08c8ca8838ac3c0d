"""The feeding robot runs, is imported, and the imported models are those that it was made from."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import pytest

from tests.support.cli import deros
from tests.support.examples import EXAMPLES, example_module
from tests.support.imported import Described, described
from tests.support.ros import running
from tests.support.shell import DEROS, deros_until

SYSTEM = EXAMPLES / "feeding_robot/feeding_robot.system"


def visible(node: Described) -> Described:
    """Return what a graph shows of a node: no depths, and no setting that is usual."""
    ends = {
        key: policies and dataclasses.replace(policies, depth=10)
        for key, policies in node.ends.items()
    }
    usual = ("use_sim_time", ("built in", False))
    return Described(ends, dict(each for each in node.parameters.items() if each != usual))


@pytest.mark.ros
def test_imported_robot_is_the_one_that_runs(ros_env: dict[str, str], tmp_path: Path) -> None:
    """All ends of its nine nodes, their types, QoS and the parameters that the system sets."""
    models = tmp_path / "models"
    packages = tmp_path / "packages"
    example_module("feeding_robot", "demonstration.build").build(SYSTEM.parent, packages)
    truth = {name: visible(node) for name, node in described(SYSTEM).items()}
    command = [DEROS, "up", str(SYSTEM), "--package-path", str(packages)]
    with running(command, ros_env):
        deros_until(
            ros_env,
            lambda _: _names(models) == truth.keys(),
            *("import", "--live", "-o", str(models)),
        )
    found = described(models / "robot.system")
    assert found.keys() == truth.keys()
    for name, node in truth.items():
        seen = visible(found[name])
        assert seen.ends == node.ends
        assert seen.parameters.items() >= node.parameters.items()
    outcome = deros("check", models / "robot.system", "--format", "json")
    assert outcome.code == 0
    # Imported, the safety node is a node without rules.
    assert [each["code"] for each in json.loads(outcome.out)] == ["DRS239"]


def _names(models: Path) -> set[str]:
    return set(described(models / "robot.system")) if models.exists() else set()
