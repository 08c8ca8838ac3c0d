"""The arm in ``examples/real`` starts what the launch file that it describes starts.

The comparison runs where ``launch`` and MoveIt's packages can be had (`compared_launch`).
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from tests.support.cli import deros
from tests.support.compared_launch import differences, needs_launch, resolved, share
from tests.support.examples import EXAMPLES
from tests.support.real_systems import FOLDER
from tests.support.resolved_launch import remapped

PANDA = EXAMPLES / "real" / "panda" / "panda.system"
INTERFACES = ("--interfaces", FOLDER / "interfaces")

SETS: Mapping[str, Mapping[str, str]] = {
    "defaults": {},
    "a database": {"db": "True"},
    "RViz without MoveIt": {"rviz_config": "moveit_empty.rviz"},
    "in the simulator Isaac": {"ros2_control_hardware_type": "isaac"},
    "all of these": {
        "db": "true",
        "rviz_config": "moveit_empty.rviz",
        "ros2_control_hardware_type": "isaac",
    },
}

_FOR_ONE_NODE = {"robot_description", "robot_description_semantic"}
"""What the original gives to all nodes of a process, and ours to the one that the system has."""


def test_panda_checks_clean() -> None:
    """Where MoveIt is not installed, remarks say that its files have not been read."""
    outcome = deros("check", *INTERFACES, PANDA)
    assert outcome.code == 0
    found = {line.split("[")[1][:6] for line in outcome.out.splitlines() if "[DRS" in line}
    assert found <= {"DRS262", "DRS280"}


@needs_launch
@pytest.mark.parametrize("arguments", SETS.values(), ids=SETS)
def test_panda_starts_what_its_launch_file_starts(
    arguments: Mapping[str, str], tmp_path: Path
) -> None:
    """Programs, names, words, parameters and remappings are the same."""
    wanted = resolved(_original(), arguments)
    found = _ours(PANDA, arguments, tmp_path)
    different = differences(wanted, found)
    values = sum(len(each["parameters"]) for each in wanted.values())
    print(f"{len(wanted)} nodes, {values} parameters, {len(different)} differences")
    for each in different:
        print(" ", each)
    assert len(wanted) == (9 if "db" in arguments else 8)
    assert different == []
    assert {n: each["shared"] for n, each in found.items()} == {
        n: [p for p in each["shared"] if p not in _FOR_ONE_NODE] for n, each in wanted.items()
    }


@needs_launch
@pytest.mark.parametrize(
    ("file", "text", "other", "difference"),
    [
        (
            "panda.system",
            "joint_limits.yaml",
            "hard_joint_limits.yaml",
            "/{}: parameter robot_description_planning.joint_limits.panda_joint1."
            "max_acceleration 3.75 is 15.0",
        ),
        (
            "parameters/pipelines.yaml",
            "pipeline: ompl",
            "pipeline: 1",
            "/{}: parameter default_planning_pipeline 'ompl' is 1",
        ),
        (
            "panda.system",
            '["panda_arm_controller", "-c", "/controller_manager"]',
            '["panda_arm_controller"]',
            "/spawner_panda_arm_controller: words ['panda_arm_controller', '-c',"
            " '/controller_manager'] is ['panda_arm_controller']",
        ),
        (
            "panda.system",
            "remap /controller_manager/robot_description to",
            "remap /robot_descriptions to",
            "/controller_manager: remapping /controller_manager/robot_description"
            " '/robot_description' is None",
        ),
        ("panda.system", "when db", "when not db", "/mongodb: started, too"),
    ],
)
def test_each_kind_of_difference_is_seen(
    file: str, text: str, other: str, difference: str, tmp_path: Path
) -> None:
    """A value, its type, a word, a remapping, and a node that is started in other cases."""
    changed = tmp_path / "panda"
    shutil.copytree(PANDA.parent, changed)
    before = (changed / file).read_text(encoding="utf-8")
    assert text in before
    (changed / file).write_text(before.replace(text, other), encoding="utf-8")
    different = differences(resolved(_original(), {}), _ours(changed / PANDA.name, {}, tmp_path))
    assert {difference.format(name) for name in ("move_group", "rviz2")} <= set(different)


def test_remapping_for_one_node_of_a_process() -> None:
    """It is not mistaken for one of the others, nor the scheme of a name for a node."""
    rules = (
        "arm:state:=/state",
        "arm:~/goal:=/goal",
        "hand:state:=/hand",
        "rostopic://map:=/world",
    )
    assert remapped(rules, "/left/arm") == {
        "/left/state": "/state",
        "/left/arm/goal": "/goal",
        "hand: /left/state": "/hand",
        "/left/rostopic://map": "/world",
    }


def _original() -> Path:
    return share("moveit_resources_panda_moveit_config") / "launch" / "demo.launch.py"


def _ours(system: Path, arguments: Mapping[str, str], folder: Path) -> dict[str, dict[str, Any]]:
    """Return what the generated launch file starts: its bools are written in lower case."""
    outcome = deros("generate", *INTERFACES, "--target", "launch", system, "-o", folder)
    assert outcome.code == 0, outcome.err
    spelled = {n: value.lower() if n == "db" else value for n, value in arguments.items()}
    return resolved(folder / "panda.launch.py", spelled)
