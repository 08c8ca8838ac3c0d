"""Plain parameter files are the same however a system is started, and then gone."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest
import yaml

from deros import codes
from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import (
    rossystem_launch,
    rossystem_launch_xml,
    rossystem_params,
    rossystem_script,
)
from deros.generators.output.writer import write
from deros.models.system import System
from deros.systems.arguments.resolve import resolve
from tests.generators.system.test_arguments import launch_file
from tests.generators.system.test_keys_below import (
    EYE,
    environment,
    run_until_ready,
    told_in,
)
from tests.support import launch
from tests.support.lint import assert_lint_clean
from tests.support.systems import CONTEXT, load_text

__all__ = ["environment"]

SYSTEM = """system Whole
argument kinematics : string = "kinematics.yaml"
imports import "eye.rnd"
parameters from "rates.yaml" plain
node eye : eye
parameters from $kinematics plain as solvers.arm
"""
RATES = "# of all\nrate: 2e0  # not 2\nmode: 'on'\n"
KINEMATICS = "left:\n  solver: kdl\n\n  joints: [a, 'b']\n"
PUT = (
    "# of all\n/**:\n  ros__parameters:\n    rate: 2e0  # not 2\n    mode: 'on'\n",
    "/**:\n  ros__parameters:\n    solvers:\n      arm:\n        left:\n          solver: kdl\n\n"
    "          joints: [a, 'b']\n",
)


@pytest.fixture
def system(tmp_path: Path) -> System:
    """Return the system, whose files are there."""
    (tmp_path / "eye.rnd").write_text(EYE)
    (tmp_path / "rates.yaml").write_text(RATES)
    (tmp_path / "kinematics.yaml").write_text(KINEMATICS)
    (tmp_path / "whole.system").write_text(SYSTEM)
    return load_text(tmp_path, SYSTEM)


def _script(folder: Path, system: System) -> Path:
    write(rossystem_script(system, CONTEXT), folder / "out")
    for name, text in (("rates.yaml", RATES), ("kinematics.yaml", KINEMATICS)):
        (folder / "out" / name).write_text(text)  # without our banner
    return folder / "out" / "whole.py"


def test_every_way_of_starting_hands_on_the_same_texts(
    system: System, tmp_path: Path, environment: Mapping[str, str]
) -> None:
    """A file for all nodes, its parameters below the one that is named; all is gone then."""
    script = _script(tmp_path, system)
    commands: list[list[str | Path]] = [
        [sys.executable, script],
        [sys.executable, "-m", "deros", "up", tmp_path / "whole.system"],
    ]
    for command in commands:
        assert run_until_ready(command, environment, 1) == 130
    for paths, texts in told_in(tmp_path):
        assert tuple(texts) == PUT
        assert [Path(path).name for path in paths] == ["rates.yaml", "kinematics.yaml"]
        assert not any(Path(path).exists() for path in paths)
    ((_, read),) = launch.texts_of_files(launch_file(system), {}, str(script.parent), lambda: None)
    assert tuple(text for _, text in read) == PUT
    assert list((tmp_path / "tmp").iterdir()) == []


def test_nothing_is_started_with_a_file_that_would_be_misread(
    system: System, tmp_path: Path, environment: Mapping[str, str]
) -> None:
    """Behind the parameters of a name with dots, others would get its first part."""
    script = _script(tmp_path, system)
    (script.parent / "other.yaml").write_text("left.arm:\n  solver: kdl\nrate: 1.0\n")
    command = [sys.executable, str(script), "kinematics:=other.yaml"]
    found = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    said = "ROS 2 would take keys behind 'left.arm' for parts of it: write left: {arm: ...}"
    assert found.returncode == 2
    assert f"other.yaml: {said}" in found.stderr
    with pytest.raises(ValueError, match=re.escape(said)):
        launch.texts_of_files(
            launch_file(system), {"kinematics": "other.yaml"}, str(script.parent), lambda: None
        )
    assert list((tmp_path / "tmp").iterdir()) == []


def test_values_have_the_names_that_a_node_sees(system: System) -> None:
    """In the one parameter file of a system, with those of its own."""
    ((_, file),) = rossystem_params(resolve(system), CONTEXT).items()
    assert yaml.safe_load(file.text)["/eye"]["ros__parameters"] == {
        "rate": 2.0,
        "mode": "on",
        "solvers": {"arm": {"left": {"solver": "kdl", "joints": ["a", "b"]}}},
    }


def test_frontends_of_launch_refuse_it_by_name(system: System) -> None:
    """They hand files on as they are."""
    with pytest.raises(GenerationError) as refused:
        rossystem_launch_xml(system, CONTEXT)
    found = [(each.code, each.span.text) for each in refused.value.diagnostics]
    code = codes.UNSUPPORTED_BY_TARGET
    assert found == [(code, '"rates.yaml"'), (code, "$kinematics")]


def test_generated_files_pass_the_linters(system: System, tmp_path: Path) -> None:
    """Without what only moved keys or xacro need."""
    for name, target in (("script", rossystem_script), ("launch", rossystem_launch)):
        files = target(system, CONTEXT)
        write({path: f for path, f in files.items() if path.startswith("whole")}, tmp_path / name)
        assert_lint_clean(tmp_path / name)
    text = launch_file(system)
    assert "def moved" not in text
    assert "class Below" not in text
    assert "class Made(" not in text
