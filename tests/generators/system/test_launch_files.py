"""Existing launch files get the same however a system is started, and none of anything else."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import (
    rossystem_launch,
    rossystem_params,
    rossystem_script,
    rossystem_sros2,
    rossystem_systemd,
)
from deros.generators.output.writer import write
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
  name rate : double = 1.0
  name label : string = ""
  name sizes : double[] = [1.0]
  name words : string[] = ["a"]
publishes topic image : std_msgs.Bool
"""
SETTINGS = '<launch><arg name="empty"/><node pkg="a" exec="b" name="inner"/></launch>'
ARM = """system Arm
argument side : string
launch "arm.launch.yaml" (side = $side) as driver provides { }
"""
WHOLE = """system Whole
argument robot : string = "r2"
argument speed : double = 0.5
argument slow : bool = false
imports import "eye.rnd" import "arm.system"
topics external topic /image external topic "/left/${robot}/image"
launch "plain.launch.py" (name = "${robot}_1", slow = $slow, twice = $speed * 2, text = "it's")
  provides { }
node first : eye wirings connect image to /image
subsystem left namespace left {
  parameters from "common.yaml"
  env SIDE = $robot
  parameters
    param use_sim_time = $slow
    param rate = $speed
    param label = $robot
    param sizes = [1.0, $speed]
    param words = ["1", "a b"]
  remappings remap /tf to tf remap library to "/${robot}/library"
  launch "settings.launch.xml" (empty = "") namespace $robot when not slow
    provides { node inner : eye wirings connect image to image }
}
subsystem arm : Arm(side = "left") namespace /arm
node last : eye wirings connect image to /image
"""
FILES = ("plain.launch.py", "settings.launch.xml", "arm.launch.yaml", "common.yaml")

ROS2 = f"""#!{sys.executable} -IS
import json, os, signal, sys
words = sys.argv[1:]
included = open(words[1]).read() if len(words) == 2 else None
with open(os.environ["TOLD"], "a") as told:
    told.write(json.dumps([words, included, os.environ.get("SIDE")]) + "\\n")
signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT, signal.SIGTERM])
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, lambda *_: None)
child = os.fork()  # which may be told of before its parent goes on
who = "launch" if child else "child"
os.write(1, (who + " ready\\n").encode())
got = signal.Signals(signal.sigwait([signal.SIGINT, signal.SIGTERM])).name
if child:
    os.kill(child, signal.SIGINT)
    os.waitpid(child, 0)
else:  # one more would be there already
    more = signal.sigtimedwait([signal.SIGINT], 0)
    got += "" if more is None else " twice"
os.write(1, (who + " got " + got + "\\n").encode())
"""
"""Stands for ``ros2 launch``: it starts a child, and passes on the SIGINT that it gets."""


@pytest.fixture
def system(tmp_path: Path) -> System:
    """Return the system, whose files are there."""
    (tmp_path / "eye.rnd").write_text(EYE)
    (tmp_path / "arm.system").write_text(ARM)
    for name in FILES:
        (tmp_path / name).write_text(SETTINGS if name.endswith(".xml") else "# mine\n")
    (tmp_path / "arm.launch.yaml").write_text("launch:\n- arg: {name: side}\n")
    (tmp_path / "common.yaml").write_text("/**:\n  ros__parameters:\n    rate: 1.5\n")
    return load_text(tmp_path, WHOLE)


def _environment(folder: Path, packages: tuple[str, ...] = ("ros2launch",)) -> dict[str, str]:
    programs = folder / "prefix" / "lib" / "eyes"
    programs.mkdir(parents=True)
    (folder / "bin").mkdir()
    for path, text in (
        (programs / "eye", f"#!{sys.executable} -IS\n"),
        (folder / "bin" / "ros2", ROS2),
    ):
        path.write_text(text)
        path.chmod(0o755)
    for package in packages:
        (folder / "prefix" / "share" / package).mkdir(parents=True)
    return {
        **os.environ,
        "AMENT_PREFIX_PATH": str(folder / "prefix"),
        "PATH": f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}",
        "TOLD": str(folder / "told"),
    }


def _script(folder: Path, system: System) -> Path:
    write(rossystem_script(system, CONTEXT), folder / "out")
    return folder / "out" / "whole.py"


def _programs(system: System, words: list[str]) -> list[Any]:
    script = script_of(system)
    rows = script.nodes(script.given(script.ARGUMENTS, words))
    return [each.located("/at/{}".format) for each in rows if isinstance(each, script.Launch)]


def test_plain_files_are_started_by_their_command_line(system: System) -> None:
    """Arguments are texts as launch files expect them."""
    plain, settings, arm = _programs(system, ["speed:=2"])
    assert plain.arguments == (
        *("launch", "/at/plain.launch.py", "name:=r2_1", "slow:=false", "twice:=4.0"),
        "text:=it's",
    )
    assert (plain.file_text, plain.environment) == ("", {})
    assert arm.arguments == ("launch",)  # a namespace has no place there
    assert (plain.subsystem, settings.subsystem, arm.subsystem) == ("", "left", "arm")


def test_settings_of_groups_are_the_same_in_script_and_launch_file(system: System) -> None:
    """Namespace, variables, parameters with their types, files, remappings and arguments."""
    _, settings, _ = _programs(system, ["speed:=2"])
    described = launch.described(settings.file_text, dict(launch.modules()))
    of_script = [each.words for each in described.entities]
    plain, of_launch, of_arm = launch.included(launch_file(system), {"speed": "2"})
    unset = [("UnsetLaunchConfiguration", name) for name in ("robot", "speed", "slow")]
    assert plain[:3] == unset
    assert plain[3:] == [
        (
            "IncludeLaunchDescription",
            f"{launch.HERE}/plain.launch.py",
            [("name", "r2_1"), ("slow", "false"), ("twice", "4.0"), ("text", "it's")],
        )
    ]
    assert settings.environment == {"SIDE": "r2"}
    assert of_launch == [
        *unset,
        ("PushRosNamespace", "left/r2"),
        ("SetEnvironmentVariable", "SIDE", "r2"),
        ("SetParametersFromFile", f"{launch.HERE}/common.yaml"),
        ("SetParameter", "use_sim_time", "false"),
        ("SetParameter", "rate", "2.0"),
        ("SetParameter", "label", '"r2"'),
        ("SetParameter", "sizes", "[1.0, 2.0]"),
        ("SetParameter", "words", '["1", "a b"]'),
        ("SetRemap", "/tf", "tf"),
        ("SetRemap", "library", "/r2/library"),
        ("IncludeLaunchDescription", f"{launch.HERE}/settings.launch.xml", [("empty", "")]),
    ]
    shared = [each for each in of_launch if each[0] not in ("SetEnvironmentVariable", unset[0][0])]
    at = [tuple(_moved(word) for word in each) for each in shared]
    at[0] = ("PushRosNamespace", "/left/r2")  # a script is in no other namespace
    assert of_script == at
    assert of_arm[3:] == [
        ("PushRosNamespace", "/arm"),
        ("IncludeLaunchDescription", f"{launch.HERE}/arm.launch.yaml", [("side", "left")]),
    ]


CHOSEN = """system Whole
argument robot : string = "r2"
argument speed : double = 0.5
argument slow : bool = false
parameters
  param label = if slow then "1" else $robot
  param quoted = if slow then "it's \\"so\\"" else $robot
  param on = if slow then $slow else true
  param rate = if slow then $speed else 1.5
launch "settings.launch.xml" (
  empty = if slow then false else true, rate = if slow then $speed else 3, n = if slow then 1 else 2
) provides { }
"""


@pytest.mark.parametrize("slow", ["true", "false"])
def test_choices_are_spelled_as_other_values(tmp_path: Path, slow: str) -> None:
    """A bool is true or false, 2 is 2.0 where it is a double, and a text stays one in YAML."""
    (tmp_path / "settings.launch.xml").write_text(SETTINGS)
    system = load_text(tmp_path, CHOSEN)
    (started,) = _programs(system, ["speed:=2", f"slow:={slow}"])
    described = launch.described(started.file_text, dict(launch.modules()))
    (included,) = launch.included(launch_file(system), {"speed": "2", "slow": slow})
    shared = [each for each in included if each[0] != "UnsetLaunchConfiguration"]
    moved = [tuple(_moved(word) for word in each) for each in shared]
    assert [each.words for each in described.entities] == moved
    arguments = dict(moved[-1][2])
    is_slow = slow == "true"
    assert arguments == {
        "empty": "false" if is_slow else "true",
        "rate": "2.0" if is_slow else "3.0",
        "n": "1" if is_slow else "2",
    }
    parameters = {name: value for word, name, value in moved[:-1] if word == "SetParameter"}
    assert parameters["label"] == ('"1"' if is_slow else '"r2"')
    assert parameters["rate"] == ("2.0" if is_slow else "1.5")


def _moved(word: Any) -> Any:
    return word.replace(launch.HERE, "/at") if isinstance(word, str) else word


def test_condition_leaves_a_launch_file_out(system: System) -> None:
    """It is neither started nor looked for."""
    assert [each.name for each in _programs(system, ["slow:=true"])] == ["plain", "driver"]
    assert len(launch.included(launch_file(system), {"slow": "true"})) == 2


def test_nodes_that_a_launch_file_starts_are_not_started(system: System) -> None:
    """They are in no table, no launch file and no parameter file."""
    script = script_of(system)
    rows = script.nodes(script.given(script.ARGUMENTS, []))
    assert [each.name for each in rows] == ["plain", "first", "settings", "driver", "last"]
    assert "inner" not in launch_file(system)


def test_copies_go_with_what_is_generated(system: System) -> None:
    """Each file beside the system is found at the same place beside the script."""
    for target in (rossystem_script, rossystem_launch):
        names = {path for path in target(system, CONTEXT) if not path.startswith("whole")}
        assert names == set(FILES)


def test_generated_files_pass_the_linters(system: System, tmp_path: Path) -> None:
    """As all that is generated does."""
    for name, target in (("script", rossystem_script), ("launch", rossystem_launch)):
        folder = tmp_path / name
        files = target(system, CONTEXT)
        write({path: file for path, file in files.items() if path.startswith("whole")}, folder)
        assert_lint_clean(folder)


def test_script_starts_launch_files_and_stops_them_by_one_signal(
    system: System, tmp_path: Path
) -> None:
    """SIGINT is for ``ros2 launch`` alone, which passes it on; the file for it is gone then."""
    environment = _environment(tmp_path)
    run = Run([sys.executable, _script(tmp_path, system), "--only", "left"], environment)
    try:
        run.until("launch ready", "child ready")
        run.signal(signal.SIGINT)
        assert run.end() == 130
    finally:
        run.close()
    assert sum("child got SIGINT" in line for line in run.lines) == 1
    assert not any("twice" in line for line in run.lines)
    assert any("launch got SIGINT" in line for line in run.lines)
    words, included, side = json.loads((tmp_path / "told").read_text())
    assert (words[0], side) == ("launch", "r2")
    assert str(tmp_path / "out" / "settings.launch.xml") in included
    assert not Path(words[1]).exists()


def test_what_is_left_of_a_launch_file_is_stopped(system: System, tmp_path: Path) -> None:
    """Where ``ros2 launch`` itself is killed, its nodes get the signals."""
    environment = _environment(tmp_path)
    run = Run([sys.executable, _script(tmp_path, system), "--only", "plain"], environment)
    try:
        run.until("launch ready", "child ready")
        (pid,) = run.started().values()
        os.kill(pid, signal.SIGKILL)
        assert run.end() == 1
    finally:
        run.close()
    assert any("child got SIGINT" in line for line in run.lines)
    assert any("plain was killed by SIGKILL" in line for line in run.lines)


@pytest.mark.parametrize("missing", ["package 'ros2launch'", "program 'ros2'", "plain.launch.py"])
def test_nothing_is_started_without_what_is_needed(
    system: System, tmp_path: Path, missing: str
) -> None:
    """The program, its package and the file are looked for before."""
    environment = _environment(tmp_path, () if "ros2launch" in missing else ("ros2launch",))
    script = _script(tmp_path, system)
    if missing.startswith("program"):
        (tmp_path / "bin" / "ros2").unlink()
    elif missing == "plain.launch.py":
        (tmp_path / "out" / missing).unlink()
    found = subprocess.run(
        [sys.executable, script, "--only", "plain"],
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
def test_dry_run_prints_commands_that_a_shell_can_run(system: System, tmp_path: Path) -> None:
    """Also the one with a file of its own."""
    environment = _environment(tmp_path)
    command = [sys.executable, str(_script(tmp_path, system)), "--only", "left", "--dry-run"]
    printed = subprocess.run(
        command, env=environment, capture_output=True, text=True, check=True
    ).stdout
    run = Run(["bash", "-c", printed], environment)
    try:
        run.until("child ready")
        words, included, side = json.loads((tmp_path / "told").read_text())
        os.kill(run.process.pid, signal.SIGTERM)
    finally:
        run.close()
    assert words[1].endswith(".py")
    assert side == "r2"
    assert "PushRosNamespace('/left/r2')" in included
    Path(words[1]).unlink()


def test_targets_that_cannot_start_launch_files_refuse_them(tmp_path: Path) -> None:
    """Each names the statement; parameters with names that no command line holds, too."""
    (tmp_path / "a.launch.py").write_text("")
    (tmp_path / "eye.rnd").write_text(EYE)
    system = load_text(
        tmp_path, 'system S imports import "eye.rnd" launch "a.launch.py" node e : eye'
    )
    for target in (rossystem_systemd, rossystem_sros2):
        with pytest.raises(GenerationError) as refused:
            target(system, CONTEXT)
        assert [each.span.text for each in refused.value.diagnostics] == ['"a.launch.py"']
    assert "a" not in rossystem_params(system, CONTEXT)["s.params.yaml"].text.split()
    odd = load_text(
        tmp_path,
        'system S parameters param max-age = 1 launch "a.launch.py" provides { }',
    )
    with pytest.raises(GenerationError, match="max-age"):
        rossystem_launch(odd, CONTEXT)


@pytest.mark.usefixtures("system")
def test_up_runs_launch_files_where_they_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And prints the same commands."""
    for name, value in _environment(tmp_path).items():
        monkeypatch.setenv(name, value)
    outcome = deros("up", tmp_path / "test.system", "--dry-run", "--only", "plain")
    assert f"ros2 launch {tmp_path}/plain.launch.py name:=r2_1 slow:=false" in outcome.out
