"""What a system looks up where it is started, and defaults that are computed."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from deros.generators.builtin import rossystem_launch, rossystem_script
from deros.generators.output.writer import write
from deros.models.system import System
from tests.generators.system.test_arguments import EYE as ARGUMENTS_EYE
from tests.generators.system.test_arguments import from_launch, launch_file, plain, script_of
from tests.support import launch
from tests.support.cli import deros
from tests.support.lint import assert_lint_clean
from tests.support.systems import CONTEXT, load_text

EYE = ARGUMENTS_EYE.replace(
    "parameters\n",
    'parameters name place : string = "" name path : string = ""\n',
)

LOOKS = """system Looks
argument robot : string = env("ROBOT", "courier")
argument maps : string = share("robot_maps")
argument file : string = "${maps}/${robot}.yaml"
argument charted : bool = installed("ship_maps")
argument sunk : bool = installed("sunken_maps")
argument count : int = 2
argument twice : int = $count * 2
argument kind : string = "robot" one_of ["robot", "ship"]
argument conf : string = share("${kind}_maps")
imports import "*.rnd" import "arm/arm.system"
topics external topic "/${robot}/scan"
node eye : eye namespace $robot
  parameters
    param frame = "${this_dir}/${env(FRAME, it's a \\"frame\\")}.urdf"
    param names = [$file, "${share(robot_maps)}/b", "ships" when charted, "wrecks" when sunk,
      "${env(ROBOT, other)}"]
    param n = $twice
    param place = share("${kind}_maps")
    param path = "${conf}/x"
  wirings connect scan to "/${robot}/scan"
subsystem arm : Arm(side = "${env(SIDE, left)}_arm") when robot != "none"
"""
ARM = """system Arm
argument side : string
argument label : string = "${side}@${env(HOST, here)}"
imports import "../eye.rnd"
topics external topic "/arm/scan"
node hand : eye namespace arm
  parameters param frame = this_dir param names = [$label]
  wirings connect scan to "/arm/scan"
"""


@pytest.fixture(name="looks")
def fixture_looks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> System:
    """Return a system that looks up variables, a package and folders."""
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "arm.system").write_text(ARM, encoding="utf-8")
    for package in ("robot_maps", "ship_maps"):
        (tmp_path / "ws" / "share" / package).mkdir(parents=True)
        index = tmp_path / "ws" / "share" / "ament_index" / "resource_index" / "packages"
        index.mkdir(parents=True, exist_ok=True)
        (index / package).touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "ws"))
    for name in ("ROBOT", "FRAME", "SIDE", "HOST"):
        monkeypatch.delenv(name, raising=False)
    return load_text(tmp_path, LOOKS, eye=EYE)


@pytest.mark.parametrize(
    ("variables", "given"),
    [
        ({}, {}),
        ({"ROBOT": "r2", "SIDE": "right", "HOST": "pc"}, {}),
        ({"ROBOT": "r2", "FRAME": "map"}, {"robot": "none", "count": "3"}),
        ({}, {"twice": "7", "file": "/other.yaml", "maps": "/m", "kind": "ship"}),
        ({}, {"charted": "false", "sunk": "true"}),
    ],
)
def test_script_and_launch_file_look_up_the_same(
    looks: System,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    variables: Mapping[str, str],
    given: Mapping[str, str],
) -> None:
    """Both find variables, packages and folders where they are started, and nowhere earlier."""
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    robot = given.get("robot", variables.get("ROBOT", "courier"))
    maps = given.get("maps", f"{tmp_path}/ws/share/robot_maps")
    frame = variables.get("FRAME", 'it\'s a "frame"')
    eye = {
        "frame": f"{tmp_path}/{frame}.urdf",
        "names": [
            given.get("file", f"{maps}/{robot}.yaml"),
            f"{tmp_path}/ws/share/robot_maps/b",
            "wrecks" if "sunk" in given else "ships",
            variables.get("ROBOT", "other"),  # a second default for the same variable
        ],
        "n": int(given.get("twice", int(given.get("count", "2")) * 2)),
        "place": f"{tmp_path}/ws/share/{given.get('kind', 'robot')}_maps",
        "path": f"{tmp_path}/ws/share/{given.get('kind', 'robot')}_maps/x",
    }
    label = f"{variables.get('SIDE', 'left')}_arm@{variables.get('HOST', 'here')}"
    expected = {f"/{robot}/eye": plain(eye)}
    if robot != "none":
        expected["/arm/hand"] = plain({"frame": f"{tmp_path}/arm", "names": [label]})
    script = script_of(looks)
    start = script.Start(str(tmp_path / "looks.py"), [])
    values = script.given(script.ARGUMENTS, [f"{n}:={v}" for n, v in given.items()], (start,))
    by_script = {node.full_name: plain(node.parameters) for node in script.nodes(values, start)}
    assert _without_dots(by_script) == expected
    found = from_launch(launch_file(looks), given, str(tmp_path))
    assert _without_dots({name: parameters for name, _, parameters, _ in found}) == expected


def _without_dots(found: Mapping[str, Any]) -> dict[str, Any]:
    """Return parameters with folders as they are without ``/.`` and ``/..``."""
    return {
        node: {
            name: (os.path.normpath(value), repr(os.path.normpath(value)))
            if name == "frame"
            else (value, text)
            for name, (value, text) in parameters.items()
        }
        for node, parameters in found.items()
    }


@pytest.mark.parametrize("variables", [{}, {"ROBOT": "r2"}])
def test_deros_up_prints_what_the_script_prints(
    looks: System,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    variables: Mapping[str, str],
) -> None:
    """In the folder of the system, both run the same commands, with the default of each place."""
    write(rossystem_script(looks, CONTEXT), tmp_path)
    words = ["--dry-run", "--install", str(tmp_path / "ws")]
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    monkeypatch.delenv("AMENT_PREFIX_PATH")
    up = deros("up", tmp_path / "test.system", *words, "--", "count:=5")
    script = subprocess.run(
        [sys.executable, str(tmp_path / "looks.py"), *words, "count:=5"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert "n:=10" in up.out
    assert up.out == script.stdout
    assert "Programs not found" in up.err


def test_what_is_not_there_is_said_before_anything_starts(
    looks: System, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A package that is not installed, a variable that is not set, a name that is none."""
    path = tmp_path / "test.system"
    monkeypatch.setenv("ROBOT", "a b")
    done = deros("up", path)
    assert done.code == 2
    assert "default of argument 'robot': a b is not a relative namespace" in done.err
    monkeypatch.delenv("ROBOT")
    monkeypatch.delenv("AMENT_PREFIX_PATH")
    done = deros("up", path)
    assert done.code == 2
    assert "default of argument 'maps': package 'robot_maps' is not installed" in done.err
    script = script_of(looks)
    with pytest.raises(ValueError, match="'SIZE' is not set"):
        script.Start(path, []).env("SIZE")


def test_variable_is_asked_for_only_where_it_is_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One without a default has to be set, if the part that uses it is there."""
    monkeypatch.delenv("FRAME", raising=False)
    text = (
        'system S argument front : bool = true imports import "eye.rnd" node eye : eye when front'
        ' parameters param frame = env("FRAME") node other : eye when not front'
    )
    system = load_text(tmp_path, text, eye=EYE)
    script = script_of(system)
    start = script.Start("x", [])
    values = script.given(script.ARGUMENTS, ["front:=false"], (start,))
    assert [node.name for node in script.nodes(values, start)] == ["other"]
    path = tmp_path / "test.system"
    assert "'FRAME' is not set" in deros("up", path, "--dry-run").err
    assert "/other" in deros("up", path, "--dry-run", "--", "front:=false").out


def test_parameter_files_are_found_by_what_is_looked_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Folders and variables in a path, an argument whose default is one, and a variable alone."""
    share = tmp_path / "ws" / "share" / "conf"
    share.mkdir(parents=True)
    for name in ("a.yaml", "b.yaml", "c.yaml"):
        (share / name).write_text("eye: {ros__parameters: {n: 3}}", encoding="utf-8")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "ws"))
    monkeypatch.delenv("WHICH", raising=False)
    monkeypatch.setenv("OTHER", f"{share}/b.yaml")
    text = (
        'system S argument file : string = "${share(conf)}/b.yaml" argument c : string = "c"'
        ' imports import "eye.rnd" parameters from "${share(conf)}/${env(WHICH, a)}.yaml"'
        ' node eye : eye parameters from $file parameters from "${env(OTHER, x.yaml)}"'
        ' parameters from "share:conf/${c}.yaml"'
    )
    (tmp_path / "x.yaml").write_text("eye: {ros__parameters: {n: 4}}", encoding="utf-8")
    system = load_text(tmp_path, text, eye=EYE)
    script = script_of(system)
    start = script.Start(str(tmp_path / "s.py"), [])
    (node,) = script.nodes(script.given(script.ARGUMENTS, [], (start,)), start)
    expected = [f"{share}/{name}.yaml" for name in "abbc"]
    assert [each.replace("share:conf", str(share)) for each in node.files] == expected
    checked: list[str] = []
    assert launch.parameter_files(launch_file(system), {}, checked) == [("/eye", expected)]
    assert checked == expected
    done = deros("up", tmp_path / "test.system", "--dry-run")
    assert [word for word in done.out.split() if word.endswith(".yaml")] == expected


def test_output_is_lint_clean(looks: System, tmp_path: Path) -> None:
    """The linters of ament find nothing in either file."""
    write({**rossystem_launch(looks, CONTEXT), **rossystem_script(looks, CONTEXT)}, tmp_path / "o")
    assert_lint_clean(tmp_path / "o")
