"""Parameter files with ``$(…)`` are the same however a system is started, and then gone."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest
import yaml

from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import (
    rossystem_launch,
    rossystem_launch_yaml,
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
from tests.support.needs import needs
from tests.support.systems import CONTEXT, load_text

__all__ = ["environment"]

SYSTEM = """system Whole
argument prefix : string = "front_"
argument rate : double = 2.0
argument loud : bool = false
argument room : string = env("ROOM", "hall")
imports import "eye.rnd"
node eye : eye namespace r
parameters from "eye.yaml" (prefix = $prefix, rate = $rate, loud = $loud) below r
parameters from "room.yaml" (room = $room, <robot_namespace> = "/${prefix}1") plain as map
"""
EYES = (
    "# $(var prefix)\neye:\n  ros__parameters:\n    rate: $(var rate)\n"
    '    mode: "$(var prefix)$(env SIDE left) $(var loud)"\n'
)
ROOM = "room: x$(var room)\nframe: '<robot_namespace>/odom'  # of <robot_namespace>\n"


def _texts(prefix: str, rate: str, loud: str, room: str, side: str = "left") -> list[str]:
    return [
        f"# {prefix}\nr:\n  eye:\n    ros__parameters:\n      rate: {rate}\n"
        f'      mode: "{prefix}{side} {loud}"\n',
        f"/**:\n  ros__parameters:\n    map:\n      room: x{room}\n"
        f"      frame: '/{prefix}1/odom'  # of /{prefix}1\n",
    ]


@pytest.fixture
def system(tmp_path: Path) -> System:
    """Return the system, whose files are there."""
    (tmp_path / "eye.rnd").write_text(EYE)
    (tmp_path / "eye.yaml").write_text(EYES)
    (tmp_path / "room.yaml").write_text(ROOM)
    (tmp_path / "whole.system").write_text(SYSTEM)
    return load_text(tmp_path, SYSTEM)


def _script(folder: Path, system: System) -> Path:
    write(rossystem_script(system, CONTEXT), folder / "out")
    for name, text in (("eye.yaml", EYES), ("room.yaml", ROOM)):
        (folder / "out" / name).write_text(text)  # without our banner
    return folder / "out" / "whole.py"


@pytest.mark.parametrize(
    ("given", "texts"),
    [
        ({}, _texts("front_", "2.0", "false", "hall")),
        (
            {"prefix": "é x", "rate": "5", "loud": "true", "room": "a:b"},
            _texts("é x", "5.0", "true", "a:b"),
        ),
        ({"prefix": ""}, _texts("", "2.0", "false", "hall")),
    ],
)
def test_every_way_of_starting_hands_on_the_same_texts(
    system: System,
    tmp_path: Path,
    environment: Mapping[str, str],
    given: Mapping[str, str],
    texts: list[str],
) -> None:
    """A double is spelled as one, a bool as YAML has it; all is gone then."""
    script = _script(tmp_path, system)
    words = [f"{name}:={value}" for name, value in given.items()]
    commands: list[list[str | Path]] = [
        [sys.executable, script, *words],
        [sys.executable, "-m", "deros", "up", tmp_path / "whole.system", "--", *words],
    ]
    for command in commands:
        assert run_until_ready(command, environment, 1) == 130
    assert [found for _, found in told_in(tmp_path)] == [texts, texts]
    assert not any(Path(path).exists() for paths, _ in told_in(tmp_path) for path in paths)
    ((_, read),) = launch.texts_of_files(
        launch_file(system), dict(given), str(script.parent), lambda: None
    )
    assert [text for _, text in read] == texts
    assert list((tmp_path / "tmp").iterdir()) == []


def test_variables_are_those_where_the_system_is_started(
    system: System, tmp_path: Path, environment: Mapping[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of the file itself, and of what it is given."""
    script = _script(tmp_path, system)
    monkeypatch.setenv("SIDE", "right")
    monkeypatch.setenv("ROOM", "attic")
    expected = _texts("front_", "2.0", "false", "attic", "right")
    started = {**environment, "SIDE": "right", "ROOM": "attic"}
    assert run_until_ready([sys.executable, script], started, 1) == 130
    ((_, texts),) = told_in(tmp_path)
    assert texts == expected
    ((_, read),) = launch.texts_of_files(launch_file(system), {}, str(script.parent), lambda: None)
    assert [text for _, text in read] == expected


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"prefix": 'a"b'}, "would not be one value of YAML"),
        ({"room": "a: b"}, "would not be one value of YAML"),
        ({"room": "a\nb"}, "would not be one value of YAML"),
    ],
)
def test_nothing_is_started_with_a_value_that_yaml_would_take_apart(
    system: System,
    tmp_path: Path,
    environment: Mapping[str, str],
    given: dict[str, str],
    said: str,
) -> None:
    """It would set other parameters than those that were checked."""
    script = _script(tmp_path, system)
    words = [f"{name}:={value}" for name, value in given.items()]
    command: list[str | Path] = [sys.executable, script, *words]
    found = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert found.returncode == 2
    assert said in found.stderr
    with pytest.raises(ValueError, match=said):
        launch.texts_of_files(launch_file(system), given, str(script.parent))
    assert not (tmp_path / "told").exists()
    assert list((tmp_path / "tmp").iterdir()) == []


@needs("bash")
def test_dry_run_prints_commands_that_make_the_same(
    system: System, tmp_path: Path, environment: Mapping[str, str]
) -> None:
    """The texts themselves; of what cannot be made, why not."""
    script = _script(tmp_path, system)
    command = [sys.executable, str(script), "--dry-run"]

    def printed(*words: str) -> str:
        run = [*command, *words]
        return subprocess.run(run, env=environment, capture_output=True, text=True).stdout

    *before, last = printed().splitlines()
    assert (
        run_until_ready(["bash", "-c", "\n".join([*before, f"exec {last}"])], environment, 1) == 0
    )
    ((_, texts),) = told_in(tmp_path)
    assert texts == _texts("front_", "2.0", "false", "hall")
    assert any(
        line.startswith("# ") and "one value of YAML" in line
        for line in printed("room:=a: b").splitlines()
    )


def test_one_parameter_file_for_all_has_the_values(system: System) -> None:
    """But not what is only known where the system is started."""
    with pytest.raises(GenerationError, match="takes some from where it is started"):
        rossystem_params(resolve(system), CONTEXT)


def test_frontends_of_launch_refuse_it_by_name(system: System) -> None:
    """They hand files on as they are."""
    with pytest.raises(GenerationError, match="hand parameter files on as they are"):
        rossystem_launch_yaml(system, CONTEXT)


def test_copies_are_there_whatever_is_known_of_the_values(system: System, tmp_path: Path) -> None:
    """What a variable says is not known; nor is the namespace of the keys, then."""
    moved = SYSTEM.replace("below r", "below $room")
    assert "eye.yaml" in rossystem_script(load_text(tmp_path, moved), CONTEXT)
    assert {"eye.yaml", "room.yaml"} <= rossystem_script(system, CONTEXT).keys()
    assert yaml.safe_load(rossystem_script(system, CONTEXT)["room.yaml"].text) == {
        "room": "x$(var room)",
        "frame": "<robot_namespace>/odom",
    }


def test_generated_files_pass_the_linters(system: System, tmp_path: Path) -> None:
    """As all that is generated does."""
    for name, target in (("script", rossystem_script), ("launch", rossystem_launch)):
        files = target(system, CONTEXT)
        write({path: f for path, f in files.items() if path.startswith("whole")}, tmp_path / name)
        assert_lint_clean(tmp_path / name)
