"""Parameter files whose keys are moved are the same however a system is started, and then gone."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import yaml

from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import (
    rossystem_launch,
    rossystem_params,
    rossystem_script,
    rossystem_systemd,
)
from deros.generators.output.writer import write
from deros.generators.system.script.standalone.containers.values import values_of
from deros.generators.system.script.standalone.made.below import moved
from deros.models.system import System
from deros.systems.arguments.resolve import resolve
from tests.generators.system.test_arguments import launch_file, script_of
from tests.support import launch
from tests.support.lint import assert_lint_clean
from tests.support.needs import needs
from tests.support.stand_ins import Run
from tests.support.systems import CONTEXT, load_text

EYE = """node eye : eyes
parameters open
  name rate : double = 1.0
  name mode : string = "a"
"""
SYSTEM = """system Whole
argument keys : string = ""
argument params : string = "robot.yaml"
argument is_tuned : bool = true
imports import "eye.rnd"
parameters from $params below $keys
node eye : eye
subsystem arm namespace arm {
  parameters from "arm.yaml" below "arm/left" when is_tuned
  node eye : eye namespace left
  parameters from $params below "/arm/left"
}
"""
ROBOT = "# by hand\neye:\n  ros__parameters:\n    rate: 2e0  # not 2\n    mode: 'on'\n"
ARM = "%YAML 1.1\n---\neye:\n  ros__parameters:\n    mode: |-\n      x\n\n       y\n"
JOINED = "ns/eye:\n  ros__parameters: {rate: 1.0}\neye:\n  ros__parameters: {rate: 2.0}\n"
TELLS = f"""#!{sys.executable} -IS
import json, os, signal, sys
words = sys.argv[1:]
files = [words[at + 1] for at, word in enumerate(words) if word == "--params-file"]
texts = [open(file).read() for file in files]
signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
with open(os.environ["TOLD"], "a") as told:
    told.write(json.dumps([files, texts]) + "\\n")
os.write(1, b"eye ready\\n")
signal.sigwait([signal.SIGINT])
"""


@pytest.fixture
def system(tmp_path: Path) -> System:
    """Return the system, whose files are there."""
    (tmp_path / "eye.rnd").write_text(EYE)
    (tmp_path / "robot.yaml").write_text(ROBOT)
    (tmp_path / "arm.yaml").write_text(ARM)
    return load_text(tmp_path, SYSTEM)


@pytest.fixture
def environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Mapping[str, str]:
    """Return an environment with a node that tells what it is given, and a folder of its own."""
    program = tmp_path / "prefix" / "lib" / "eyes" / "eye"
    program.parent.mkdir(parents=True)
    program.write_text(TELLS)
    program.chmod(0o755)
    (tmp_path / "tmp").mkdir()
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tmp"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "tmp"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "prefix"))
    monkeypatch.setenv("TOLD", str(tmp_path / "told"))
    return dict(os.environ)


def _script(folder: Path, system: System) -> Path:
    write(rossystem_script(system, CONTEXT), folder / "out")
    for name, text in (("robot.yaml", ROBOT), ("arm.yaml", ARM)):
        (folder / "out" / name).write_text(text)  # without our banner
    return folder / "out" / "whole.py"


def told_in(folder: Path) -> list[tuple[list[str], list[str]]]:
    """Return what each node has told: its parameter files, and what stands in them."""
    return [tuple(json.loads(line)) for line in (folder / "told").read_text().splitlines()]


def run_until_ready(command: list[Any], environment: Mapping[str, str], nodes: int) -> int:
    """Run until so many nodes are ready, interrupt it, and return the exit code."""
    run = Run(command, dict(environment))
    try:
        run.until("eye ready", times=nodes)
        run.signal(signal.SIGINT)
        return run.end()
    finally:
        run.close()


@pytest.mark.parametrize("keys", ["", "r1"])
def test_every_way_of_starting_hands_on_the_same_texts(
    system: System, tmp_path: Path, environment: Mapping[str, str], keys: str
) -> None:
    """Made before the first node, in order; below nothing, it is the file; all is gone then."""
    script = _script(tmp_path, system)
    given = [f"keys:={keys}"] if keys else []
    first = moved(ROBOT, keys) if keys else ROBOT
    second = [first, moved(ARM, "arm/left"), moved(ROBOT, "/arm/left")]

    assert run_until_ready([sys.executable, script, *given], environment, 2) == 130
    told = told_in(tmp_path)
    assert sorted(texts for _, texts in told) == sorted([[first], second])
    paths = [path for files, _ in told for path in files]
    assert [Path(path).name for path in paths].count("arm.yaml") == 1
    originals = {str(script.parent / "robot.yaml")} if not keys else set()
    assert {path for path in paths if Path(path).exists()} == originals
    assert list((tmp_path / "tmp").iterdir()) == []

    folders: list[int] = []

    def count() -> None:
        folders.append(sum(len(files) for _, _, files in os.walk(tmp_path / "tmp")))

    def launched() -> list[tuple[str, list[tuple[str, str]]]]:
        words = {"keys": keys} if keys else {}
        return launch.texts_of_files(launch_file(system), words, str(script.parent), count)

    found = launched()
    assert [(name, [text for _, text in read]) for name, read in found] == [
        ("/eye", [first]),
        ("/arm/left/eye", second),
    ]
    assert folders == [3 if keys else 2]
    assert list((tmp_path / "tmp").iterdir()) == []


@pytest.mark.usefixtures("system")
def test_up_moves_keys_of_the_files_themselves(
    tmp_path: Path, environment: Mapping[str, str]
) -> None:
    """Not of copies; a subsystem alone needs its own files alone."""
    (tmp_path / "whole.system").write_text(SYSTEM)
    command = [sys.executable, "-m", "deros", "up", tmp_path / "whole.system", "--only", "arm"]
    assert run_until_ready(command, environment, 1) == 130
    ((_, texts),) = told_in(tmp_path)
    assert texts == [ROBOT, moved(ARM, "arm/left"), moved(ROBOT, "/arm/left")]
    assert list((tmp_path / "tmp").iterdir()) == []


@needs("bash")
def test_dry_run_prints_commands_that_make_the_same(
    system: System, tmp_path: Path, environment: Mapping[str, str]
) -> None:
    """Short ones where lines and blanks are enough; nothing is made by it itself."""
    script = _script(tmp_path, system)
    command = [sys.executable, str(script), "--only", "arm", "--dry-run", "keys:=r1"]
    printed = subprocess.run(
        command, env=environment, capture_output=True, text=True, check=True
    ).stdout
    assert list((tmp_path / "tmp").iterdir()) == []
    assert printed.count("sed 's/^/  /'") == 2
    *before, last = printed.splitlines()
    assert (
        run_until_ready(["bash", "-c", "\n".join([*before, f"exec {last}"])], environment, 1) == 0
    )
    ((_, texts),) = told_in(tmp_path)
    expected = [moved(ROBOT, "r1"), moved(ARM, "arm/left"), moved(ROBOT, "/arm/left")]
    assert list(map(yaml.safe_load, texts)) == list(map(yaml.safe_load, expected))


def test_dry_run_says_what_cannot_be_moved(
    system: System, tmp_path: Path, environment: Mapping[str, str]
) -> None:
    """In place of a command that would write a file of another meaning."""
    script = _script(tmp_path, system)
    (script.parent / "robot.yaml").write_text(JOINED)
    command = [sys.executable, str(script), "--only", "arm", "--dry-run"]
    printed = subprocess.run(
        command, env=environment, capture_output=True, text=True, check=True
    ).stdout
    assert "robot.yaml: ROS 2 would take keys behind 'ns/eye' for parts of it" in printed
    assert "robot.yaml >" not in printed


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("keys:=a--b", "is not a namespace"),
        ("params:=missing.yaml", "missing.yaml"),
        ("params:=latin.yaml", "can't decode byte"),
        (
            "params:=joined.yaml",
            "joined.yaml: ROS 2 would take keys behind 'ns/eye' for parts of it",
        ),
    ],
)
def test_nothing_is_started_without_a_file(
    system: System, tmp_path: Path, environment: Mapping[str, str], given: str, said: str
) -> None:
    """What is no namespace, is not there, is not UTF-8, as ROS 2 wants it, or would be misread."""
    script = _script(tmp_path, system)
    (script.parent / "joined.yaml").write_text(JOINED)
    (script.parent / "latin.yaml").write_bytes("eye: {ros__parameters: {mode: é}}".encode("latin1"))
    command: list[str | Path] = [sys.executable, script, given]
    found = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert found.returncode == 2
    assert said in found.stderr
    name, _, value = given.partition(":=")
    with pytest.raises((ValueError, FileNotFoundError)):
        launch.texts_of_files(launch_file(system), {name: value}, str(script.parent))
    assert not (tmp_path / "told").exists()
    assert list((tmp_path / "tmp").iterdir()) == []


def test_launch_file_reads_a_moved_file_for_all_of_its_nodes(
    tmp_path: Path, environment: Mapping[str, str]
) -> None:
    """As a parameter file of a group, in the script and the launch file."""
    (tmp_path / "robot.yaml").write_text(ROBOT)
    (tmp_path / "inner.launch.py").write_text("")
    system = load_text(
        tmp_path,
        'system Whole argument robot : string = "r1" subsystem a {'
        ' parameters from "robot.yaml" below $robot launch "inner.launch.py" provides { } }',
    )
    (around,) = launch.included(launch_file(system), {}, folder=str(tmp_path))
    ((_, path),) = (each for each in around if each[0] == "SetParametersFromFile")
    assert Path(path).name == "robot.yaml"
    assert Path(path).parent.parent.parent == tmp_path / "tmp"
    ros2 = tmp_path / "prefix" / "bin" / "ros2"
    ros2.parent.mkdir()
    ros2.write_text(
        TELLS.replace("files = [", "import re\nfiles = [").replace(
            'words[at + 1] for at, word in enumerate(words) if word == "--params-file"',
            r"""each for each in re.findall(r"FromFile\('(.*)'\)", open(words[1]).read())""",
        )
    )
    ros2.chmod(0o755)
    (tmp_path / "prefix" / "share" / "ros2launch").mkdir(parents=True)
    path_of_programs = f"{ros2.parent}{os.pathsep}{environment['PATH']}"
    command = [sys.executable, _script(tmp_path, system)]
    assert run_until_ready(command, {**environment, "PATH": path_of_programs}, 1) == 130
    (((file,), (text,)),) = told_in(tmp_path)
    assert text == moved(ROBOT, "r1")
    assert not Path(file).exists()


def test_values_in_files_stand_where_the_keys_are_moved_to(system: System) -> None:
    """In one parameter file for all; a unit refuses files as it does without moving."""
    ((_, file),) = rossystem_params(resolve(system), CONTEXT).items()
    assert '/arm/left/eye:\n  ros__parameters:\n    rate: 2.0\n    mode: "on"\n' in file.text
    with pytest.raises(GenerationError, match="reads parameter files"):
        rossystem_systemd(system, CONTEXT)


def test_values_for_a_container_are_those_of_the_moved_file(tmp_path: Path) -> None:
    """Where they are known; else the file is made and read at the start."""
    (tmp_path / "eye.rnd").write_text(EYE.replace("parameters", 'plugin "eyes::Eye" parameters', 1))
    (tmp_path / "robot.yaml").write_text(ROBOT)
    text = (
        'system Whole argument robot : string = "r1" imports import "eye.rnd" container box {'
        ' node eye : eye namespace r1 parameters from "robot.yaml" below BELOW }'
    )
    system = load_text(
        tmp_path, text.replace("BELOW", "r1").replace('argument robot : string = "r1"', "")
    )
    (row,) = (each for each in script_of(system).NODES if each.container)
    assert row.parameters == {"rate": 2.0, "mode": "on"}
    system = load_text(tmp_path, text.replace("BELOW", "$robot"))
    module = script_of(system)
    (row,) = (each for each in module.nodes(SimpleNamespace(robot="r7")) if each.container)
    assert not row.parameters
    module.MADE.sources(row.files, lambda file: str(tmp_path / file))
    module.MADE.make({})
    with module.MADE.in_place():
        assert values_of(row.files, "/r1/eye") == {}
        assert values_of(row.files, "/r7/eye") == {"rate": 2.0, "mode": "on"}
    assert "Below(" in launch_file(system)


def test_generated_files_pass_the_linters(system: System, tmp_path: Path) -> None:
    """As all that is generated does; both say how without deros."""
    for name, target in (("script", rossystem_script), ("launch", rossystem_launch)):
        files = target(system, CONTEXT)
        write({path: f for path, f in files.items() if path.startswith("whole")}, tmp_path / name)
        assert_lint_clean(tmp_path / name)


def test_system_without_moved_files_has_nothing_of_it(tmp_path: Path) -> None:
    """Neither the script nor the launch file; ``below`` nothing moves nothing."""
    (tmp_path / "eye.rnd").write_text(EYE)
    (tmp_path / "robot.yaml").write_text(ROBOT)
    system = load_text(
        tmp_path,
        'system Whole imports import "eye.rnd" node eye : eye'
        ' parameters from "robot.yaml" below ""',
    )
    for text in (launch_file(system), rossystem_script(system, CONTEXT)["whole.py"].text):
        assert "MadeFiles" not in text
        assert "def moved" not in text
