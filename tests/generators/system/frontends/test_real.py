"""The real ``launch`` and ``launch_ros`` start the same of the three launch files.

This runs where they can be had: ``DEROS_REAL_PYTHON`` names a Python that imports ``launch_ros``,
``launch_xml`` and ``launch_yaml``.
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from deros.generators.builtin import rossystem_launch
from deros.generators.output.writer import write
from tests.generators.system.frontends.test_frontends import CONSTRUCTS
from tests.generators.system.test_arguments import EYE, WHOLE
from tests.support.frontend_files import both
from tests.support.systems import CONTEXT, EVERYTHING, load, load_text

REPOSITORY = Path(__file__).resolve().parents[4]
PYTHON = os.environ.get("DEROS_REAL_PYTHON", "")
pytestmark = pytest.mark.skipif(
    not PYTHON, reason="DEROS_REAL_PYTHON names no Python that has launch_ros"
)
PROGRAMS = (
    *("vision/camera_driver", "plumbing/relay", "parts/part", "eyes/eye"),
    "rclcpp_components/component_container_mt",
)
OF_CONSTRUCTS: Mapping[str, Mapping[str, str]] = {
    "defaults": {},
    "a launch file": {"count": "1", "speed": "1.5e0", "slam": "false"},
    "no container": {"mode": "1", "count": "3", "robot": "r2"},
    "texts": {"mode": "by hand", "tuning": "files/common.yaml"},
}
REFUSED: Mapping[str, Mapping[str, str]] = {
    "argument speed is '2': it has to be a number in": {"speed": "2"},
    'argument speed is "5\'": it has to be a number in': {"speed": "5'"},
    "argument count is '4': it has to be an integer, one of": {"count": "4"},
    "Valid options are: ['auto', 'by hand', '1']": {"mode": "other"},
    "none.yaml": {"tuning": "none.yaml"},
}


@pytest.fixture
def prefix(tmp_path: Path) -> Path:
    """Return an install space with all programs and files."""
    made = tmp_path / "prefix"
    index = made / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    for each in PROGRAMS:
        program = made / "lib" / each
        program.parent.mkdir(parents=True, exist_ok=True)
        program.write_text("#!/bin/sh\n")
        program.chmod(0o755)
        (index / program.parent.name).touch()
    (index / "robot_bringup").touch()
    for robot in ("r1", "r2"):
        share = made / "share" / "robot_bringup"
        for folder in ("conf", "launch"):
            (share / folder).mkdir(parents=True, exist_ok=True)
        (share / "conf" / f"{robot}.yaml").write_text("/**: {ros__parameters: {gains: [3.0]}}\n")
        (share / "launch" / f"{robot}.launch.py").write_text(
            "from launch import LaunchDescription\nfrom launch.actions import ExecuteProcess\n"
            "from launch.substitutions import LaunchConfiguration\n"
            "def generate_launch_description():\n"
            "    told = LaunchConfiguration('slam', default='nothing')\n"
            f"    return LaunchDescription([ExecuteProcess(cmd=['echo', '{robot}', told])])\n"
        )
    xacro = made / "bin" / "xacro"
    xacro.parent.mkdir()
    xacro.write_text('#!/bin/sh\nprintf "<%s>" "$@"\n')
    xacro.chmod(0o755)
    return made


def _run(
    path: Path, words: Mapping[str, str], prefix: Path, namespace: str = ""
) -> subprocess.CompletedProcess[str]:
    prefixes = [str(prefix), os.environ.get("AMENT_PREFIX_PATH", "")]
    given = [f"{name}:={value}" for name, value in words.items()]
    return subprocess.run(
        [PYTHON, "-m", "tests.support.started_by_launch", namespace, str(path), *given],
        cwd=REPOSITORY,
        env={
            **os.environ,
            "AMENT_PREFIX_PATH": os.pathsep.join(filter(None, prefixes)),
            "PATH": f"{prefix / 'bin'}{os.pathsep}{os.environ['PATH']}",
        },
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def _started(path: Path, words: Mapping[str, str], prefix: Path, namespace: str = "") -> Any:
    run = _run(path, words, prefix, namespace)
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout.splitlines()[-1])


def _files(system: Path, folder: Path) -> list[Path]:
    model = load(system)
    write({**rossystem_launch(model, CONTEXT), **both(model)}, folder)
    return [folder / f"{system.stem}.launch.{end}" for end in ("py", "xml", "yaml")]


@pytest.mark.parametrize("namespace", ["", "fleet/a"])
@pytest.mark.parametrize("words", OF_CONSTRUCTS.values(), ids=OF_CONSTRUCTS)
def test_all_constructs_start_the_same(
    tmp_path: Path, prefix: Path, words: Mapping[str, str], namespace: str
) -> None:
    """Command lines, parameters, variables, folders and what is loaded are equal."""
    words = {"tuning": str(CONSTRUCTS.parent / "files" / "common.yaml"), **words}
    python, *others = _files(CONSTRUCTS, tmp_path)
    expected = _started(python, words, prefix, namespace)
    assert len(expected) >= 3
    for each in others:
        assert _started(each, words, prefix, namespace) == expected, each.suffix


def test_nodes_without_arguments_start_the_same(tmp_path: Path, prefix: Path) -> None:
    """Every setting of a node arrives."""
    python, *others = _files(EVERYTHING, tmp_path)
    expected = _started(python, {}, prefix)
    assert len(expected) == 5
    for each in others:
        assert _started(each, {}, prefix) == expected, each.suffix


@pytest.mark.parametrize(
    "words",
    [{}, {"slam": "false", "count": "3", "mode": "1", "free": "a $(var robot) \\ \"b\" 'c'"}],
)
def test_expressions_start_the_same(tmp_path: Path, prefix: Path, words: Mapping[str, str]) -> None:
    """Conditions, calculations and choices have the same values."""
    system = load_text(tmp_path, WHOLE, eye=EYE)
    write({**rossystem_launch(system, CONTEXT), **both(system)}, tmp_path)
    expected = _started(tmp_path / "whole.launch.py", words, prefix)
    for end in ("xml", "yaml"):
        assert _started(tmp_path / f"whole.launch.{end}", words, prefix) == expected, end


@pytest.mark.parametrize("reason", REFUSED)
def test_wrong_values_are_refused(tmp_path: Path, prefix: Path, reason: str) -> None:
    """All three say why, and start nothing."""
    given = {"tuning": str(CONSTRUCTS.parent / "files" / "common.yaml"), **REFUSED[reason]}
    for each in _files(CONSTRUCTS, tmp_path):
        run = _run(each, given, prefix)
        assert run.returncode == 1, each
        assert reason in run.stderr, each


def test_settings_of_a_group_around_are_refused(tmp_path: Path, prefix: Path) -> None:
    """Included launch files would not see them; below a namespace alone they are right."""
    around = tmp_path / "around.launch.xml"
    for path in _files(CONSTRUCTS, tmp_path)[1:]:
        around.write_text(
            f'<launch><set_remap from="a" to="b"/><include file="{path}">'
            f'<arg name="tuning" value="files/common.yaml"/></include></launch>'
        )
        run = _run(around, {}, prefix)
        assert run.returncode == 1
        assert "expected str instance, list found" in run.stderr
