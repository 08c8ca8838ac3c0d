"""Texts that xacro makes are the same however a system is started, and made before anything is."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

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
from deros.generators.system.script.standalone.command_line import LONGEST
from deros.models.system import System
from tests.generators.system.test_arguments import launch_file, script_of
from tests.support import launch
from tests.support.cli import deros
from tests.support.lint import assert_lint_clean
from tests.support.needs import needs
from tests.support.stand_ins import Run
from tests.support.systems import CONTEXT, load_text

EYE = """node eye : eyes
parameters
  name robot_description : string
  name rate : double = 1.0
publishes topic image : std_msgs.Bool topic robot_description : std_msgs.String
"""
SYSTEM = """system Whole
argument simulated : bool = false
argument side : string = "left"
argument mass : double = 2.0
argument count : int = 1
imports import "eye.rnd"
topics external topic /image topic /robot_description
node first : eye when count > 0
parameters
  param robot_description from xacro "urdf/robot.xacro" (
    use_sim = $simulated, side = "${side} \\"arm\\"", mass = $mass, count = $count * 2,
    name = "it's \\"one\\"", maybe = if simulated then "a b" else "c\\\\d")
wirings connect image to /image connect robot_description to /robot_description
subsystem arm namespace arm {
  parameters
    param robot_description from xacro "urdf/${side}.xacro"
  node second : eye
  parameters param rate = 2.0
  wirings connect image to /image connect robot_description to /robot_description
}
"""
HEAD = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">'
ROBOT = f"""{HEAD}
  <xacro:include filename="parts/wheel.xacro"/>
  <link name="$(arg use_sim)|$(arg side)|$(arg mass)|$(arg count)|$(arg name)|$(arg maybe)"/>
</robot>
"""
FILES = {
    "eye.rnd": EYE,
    "urdf/robot.xacro": ROBOT,
    "urdf/parts/wheel.xacro": f'{HEAD}<link name="wheel"/></robot>',
    "urdf/left.xacro": f'{HEAD}<link name="left"/></robot>',
    "urdf/right.xacro": f'{HEAD}<link name="${{1/0}}"/></robot>',
}
TELLS = f"""#!{sys.executable} -IS
import json, os, signal, sys
words = sys.argv[1:]
files = [words[at + 1] for at, word in enumerate(words) if word == "--params-file"]
texts = [open(file).read() for file in files]
with open(os.environ["TOLD"], "a") as told:
    told.write(json.dumps([files, texts]) + "\\n")
signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
os.write(1, b"eye ready\\n")
signal.sigwait([signal.SIGINT])
"""
XACRO = Path(sys.executable).with_name("xacro")
"""The real one."""


@pytest.fixture
def system(tmp_path: Path) -> System:
    """Return the system, whose files are there."""
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return load_text(tmp_path, SYSTEM)


@pytest.fixture
def environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Mapping[str, str]:
    """Return an environment with xacro, and a node that tells what it is given."""
    program = tmp_path / "prefix" / "lib" / "eyes" / "eye"
    program.parent.mkdir(parents=True)
    program.write_text(TELLS)
    program.chmod(0o755)
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "xacro").symlink_to(XACRO)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "prefix"))
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("TOLD", str(tmp_path / "told"))
    return dict(os.environ)


def _script(folder: Path, system: System) -> Path:
    write(rossystem_script(system, CONTEXT), folder / "out")
    return folder / "out" / "whole.py"


def _links(text: str) -> list[str]:
    """Return the names of the links of a robot."""
    return [piece.split('"')[1] for piece in text.split("<link name=")[1:] if '"' in piece]


def _as_made(folder: Path) -> list[str]:
    """Return the texts that the nodes have been told, of one line of parameters each."""
    found = []
    for line in (folder / "told").read_text().splitlines():
        _, texts = json.loads(line)
        for text in texts:
            (parameters,) = yaml.safe_load(text).values()
            found.append(parameters["ros__parameters"]["robot_description"])
    return found


@pytest.mark.usefixtures("environment")
def test_script_and_launch_file_have_the_same_texts_made(system: System, tmp_path: Path) -> None:
    """Values with blanks, quotes and backslashes reach xacro as they are."""
    script, text = script_of(system), launch_file(system)
    for words in ({}, {"simulated": "true", "mass": "5", "count": "3", "side": "left"}):
        given = [f"{name}:={value}" for name, value in words.items()]
        rows = script.nodes(script.given(script.ARGUMENTS, given))
        of_script = [
            row.located(lambda file: str(tmp_path / file)).complete(dict(os.environ))
            for row in rows
        ]
        of_launch = launch.started(text, words, str(tmp_path))
        made = [row.parameters["robot_description"] for row in of_script]
        assert made == [dict(node[2])["robot_description"] for node in of_launch]
        simulated = bool(words)
        assert "&quot;" in made[0]
        assert ("true|left" in made[0], "|5.0|6|" in made[0]) == (simulated, simulated)
        assert ("|a b" in made[0]) is simulated
        assert ("|c\\d" in made[0]) is not simulated


def test_launch_file_refuses_what_would_not_be_one_word(system: System) -> None:
    """Quotes in an argument that stands between quotes."""
    with pytest.raises(ValueError, match="without quotes and backslashes"):
        launch.started(launch_file(system), {"side": 'a" b'})


def test_generated_files_pass_the_linters(system: System, tmp_path: Path) -> None:
    """As all that is generated does."""
    for name, target in (("script", rossystem_script), ("launch", rossystem_launch)):
        files = target(system, CONTEXT)
        write({path: f for path, f in files.items() if path.startswith("whole")}, tmp_path / name)
        assert_lint_clean(tmp_path / name)


def test_copies_bring_what_xacro_includes(system: System) -> None:
    """Each at its place; of computed names, those that are known."""
    for target in (rossystem_script, rossystem_launch):
        names = {path for path in target(system, CONTEXT) if not path.startswith("whole")}
        assert names == {"urdf/robot.xacro", "urdf/parts/wheel.xacro", "urdf/left.xacro"}


def test_script_hands_texts_on_in_a_file_that_is_gone_afterwards(
    system: System, tmp_path: Path, environment: Mapping[str, str]
) -> None:
    """A long one fits no command line; the node reads the file when it starts."""
    long = f'{HEAD}<link name="{"x" * 200_000}"/></robot>'
    (tmp_path / "urdf" / "left.xacro").write_text(long)
    script = _script(tmp_path, system)
    shutil.copy(tmp_path / "urdf" / "left.xacro", script.parent / "urdf")
    run = Run([sys.executable, script, "--only", "arm"], dict(environment))
    try:
        run.until("eye ready")
        run.signal(signal.SIGINT)
        assert run.end() == 130
    finally:
        run.close()
    (text,) = _as_made(tmp_path)
    assert _links(text) == ["x" * 200_000]
    files, _ = json.loads((tmp_path / "told").read_text())
    assert files
    assert not any(Path(file).exists() for file in files)


@pytest.mark.parametrize("missing", ["'xacro'", "left.xacro", "division by zero"])
def test_nothing_is_started_without_a_text(
    system: System, tmp_path: Path, environment: Mapping[str, str], missing: str
) -> None:
    """The program, the file, and what xacro itself says."""
    script = _script(tmp_path, system)
    side = "left"
    shutil.copytree(tmp_path / "urdf", script.parent / "urdf", dirs_exist_ok=True)
    if missing == "'xacro'":
        (tmp_path / "bin" / "xacro").unlink()
        environment = {**environment, "PATH": str(tmp_path / "bin")}
    elif missing == "left.xacro":
        (script.parent / "urdf" / missing).unlink()
    else:
        side = "right"
    found = subprocess.run(
        [sys.executable, script, f"side:={side}"],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert found.returncode == 2
    assert missing in found.stderr
    assert "nothing was started" in found.stderr
    assert not (tmp_path / "told").exists()


@needs("bash")
def test_dry_run_prints_commands_that_make_the_same(
    system: System, tmp_path: Path, environment: Mapping[str, str]
) -> None:
    """And runs no xacro itself: the file of the system need not be right."""
    script = _script(tmp_path, system)
    shutil.copytree(tmp_path / "urdf", script.parent / "urdf", dirs_exist_ok=True)
    command = [sys.executable, str(script), "--only", "first", "--dry-run"]
    printed = subprocess.run(
        command, env=environment, capture_output=True, text=True, check=True
    ).stdout
    assert not (tmp_path / "told").exists()
    run = Run(["bash", "-c", f"exec {printed.splitlines()[1]}"], dict(environment))
    try:
        run.until("eye ready")
        run.signal(signal.SIGINT)
        run.end()
    finally:
        run.close()
    (text,) = _as_made(tmp_path)
    assert "wheel" in _links(text)
    assert "c\\d" in text


@pytest.mark.usefixtures("system", "environment")
def test_up_makes_texts_of_the_files_themselves(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the system is, with the values of its arguments."""
    (tmp_path / "whole.system").write_text(SYSTEM)
    monkeypatch.chdir(tmp_path)
    found = deros("up", "whole.system", "--dry-run", "--", "simulated:=true", "side:=right")
    assert f"xacro {tmp_path}/urdf/robot.xacro use_sim:=true" in found.out
    assert f"xacro {tmp_path}/urdf/right.xacro" in found.out
    failed = deros("up", "whole.system", "--", "side:=right")
    assert failed.code == 2
    assert not (tmp_path / "told").exists()


def test_loaded_node_gets_its_text_from_the_container(tmp_path: Path) -> None:
    """It is a value like any other, in the launch file and the script."""
    (tmp_path / "eye.rnd").write_text(EYE.replace("parameters", 'plugin "eyes::Eye" parameters', 1))
    (tmp_path / "a.xacro").write_text(f"{HEAD}</robot>")
    system = load_text(
        tmp_path,
        'system S imports import "eye.rnd" container box {'
        ' node e : eye parameters param robot_description from xacro "a.xacro" }',
    )
    assert "FindExecutable(name='xacro')" in launch_file(system)
    (row,) = (each for each in script_of(system).NODES if each.container)
    assert row.xacro["robot_description"].command == ["xacro", "a.xacro"]
    assert row.by_hand() == ' --parameter robot_description:="$(xacro a.xacro)"'


def test_long_texts_are_in_no_command_line(system: System) -> None:
    """Whoever writes one in the system itself included."""
    script = script_of(system)
    row = script.Node("a", "/", "p", "e", parameters={"short": "x" * LONGEST, "long": "x" * 1025})
    line = script.command_line(row, ["e"])
    assert any("short:=" in word for word in line)
    assert not any("long:=" in word for word in line)
    assert "long" in script.parameter_file(row)
    assert "short" not in script.parameter_file(row)


def test_targets_that_hold_values_refuse_texts_that_are_made(tmp_path: Path) -> None:
    """Each names the parameter; a launch file is handed none either."""
    (tmp_path / "eye.rnd").write_text(EYE)
    (tmp_path / "a.xacro").write_text(f"{HEAD}</robot>")
    (tmp_path / "a.launch.py").write_text("")
    head = 'system S imports import "eye.rnd" '
    setting = 'parameters param robot_description from xacro "a.xacro"'
    system = load_text(tmp_path, f"{head} node e : eye {setting}")
    for target in (rossystem_params, rossystem_systemd):
        with pytest.raises(GenerationError, match="xacro makes the value of 'robot_description'"):
            target(system, CONTEXT)
    handed = load_text(tmp_path, f'{head} {setting} launch "a.launch.py" provides {{ }}')
    with pytest.raises(GenerationError, match=r"cannot be handed to 'a\.launch\.py'"):
        rossystem_launch(handed, CONTEXT)
