"""Parameter files are the same ones however a system is started, and in the same order."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import rossystem_launch, rossystem_params, rossystem_script
from deros.generators.system.script.generate import table
from deros.generators.system.script.standalone.node import Node
from deros.generators.system.view import system_view
from deros.models.system import System
from deros.systems.arguments.resolve import resolve
from tests.support import launch
from tests.support.cli import deros
from tests.support.lint import assert_lint_clean
from tests.support.stand_ins import Run, make_prefix
from tests.support.systems import CONTEXT, load_text

TYPE = """node eye : demo
  executable "arguments"
parameters
  name rate : double = 1.0
  name mode : string = "a"
"""
INNER = """system Inner
imports import "../eye.rnd"
argument folder : string
parameters from "own.yaml"
parameters from "${folder}/inner.yaml"
node eye : eye
"""
WHOLE = """system Robot
argument robot : string = "r1" one_of ["r1", "r2"]
argument more : string = "more.yaml"
argument is_tuned : bool = true
imports
  import "eye.rnd"
  import "inner/inner.system"
parameters from "common.yaml"
parameters from "conf/of_${robot}.yaml" when is_tuned
subsystem front namespace front {
  parameters from "../outside.yaml"
  node eye : eye
  parameters from "/etc/robot.yaml" when not is_tuned
  parameters from $more
  parameters from "${robot}.yaml"
  parameters
    param rate = 5
  parameters from "share:robot_bringup/conf/${robot}.yaml"
  parameters from "share:${robot}_bringup/conf/all.yaml"
}
subsystem inner : Inner(folder = $more) namespace inner
"""
FILES = (
    *("common.yaml", "conf/of_r1.yaml", "conf/of_r2.yaml", "../outside.yaml", "more.yaml"),
    *("r1.yaml", "r2.yaml", "inner/own.yaml"),
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with the system and its files."""
    made = tmp_path / "models"
    (made / "inner").mkdir(parents=True)
    (made / "conf").mkdir()
    (made / "inner/inner.system").write_text(INNER)
    for each in FILES:
        (made / each).write_text(f'/**: {{ros__parameters: {{mode: "{each}"}}}}\n')
    return made


@pytest.fixture
def system(folder: Path) -> System:
    """Return the system."""
    return load_text(folder, WHOLE, eye=TYPE)


@pytest.mark.parametrize("more", ["x.yaml", "/abs/x.yaml"])
@pytest.mark.parametrize("is_tuned", [False, True])
@pytest.mark.parametrize("robot", ["r1", "r2"])
def test_every_way_of_starting_reads_the_same_files(
    system: System, folder: Path, robot: str, is_tuned: bool, more: str
) -> None:
    """The launch file, the script and ``deros up``, each from its own folder; all look before.

    The launch file looks for each file once.
    """
    text = rossystem_launch(system, CONTEXT, {})["robot.launch.py"].text
    given = {"robot": robot, "more": more, "is_tuned": str(is_tuned).lower()}
    looked_for: list[str] = []
    launched = launch.parameter_files(text, given, looked_for)
    assert sorted(looked_for) == sorted({path for _, paths in launched for path in paths})
    values = SimpleNamespace(robot=robot, more=more, is_tuned=is_tuned)
    names: dict[str, Any] = {"__name__": "robot", "__file__": f"{launch.HERE}/robot.py"}
    script = rossystem_script(system, CONTEXT, {})["robot.py"].text
    # What dataclasses look up their types in.
    sys.modules["robot"] = SimpleNamespace(**names)  # type: ignore[assignment]
    try:
        exec(compile(script, "robot.py", "exec"), names)
    finally:
        del sys.modules["robot"]
    rows = [(row.full_name, [_found(each) for each in row.files]) for row in names["nodes"](values)]
    assert rows == launched
    up = table(system_view(resolve(system, vars(values))))
    assert [each.full_name for each in up] == [name for name, _ in launched]
    below = str(folder)
    expected = {
        "/front/eye": [
            f"{below}/common.yaml",
            *([f"{below}/conf/of_{robot}.yaml"] if is_tuned else []),
            f"{folder.parent}/outside.yaml",
            *([] if is_tuned else ["/etc/robot.yaml"]),
            os.path.join(below, more),  # noqa: PTH118
            f"{below}/{robot}.yaml",
            f"share:robot_bringup/conf/{robot}.yaml",
            f"share:{robot}_bringup/conf/all.yaml",
        ],
        "/inner/eye": [
            f"{below}/common.yaml",
            *([f"{below}/conf/of_{robot}.yaml"] if is_tuned else []),
            f"{below}/inner/own.yaml",
            os.path.join(below, "inner", more, "inner.yaml"),  # noqa: PTH118
        ],
    }
    assert {each.full_name: list(each.files) for each in up if isinstance(each, Node)} == expected
    moved = {f"{folder.parent}/outside.yaml": f"{launch.HERE}/outside.yaml"}
    for name, paths in launched:
        own = [moved.get(path, path.replace(below, launch.HERE)) for path in expected[name]]
        assert paths == [path.replace("share:", "/share/") for path in own]


def _found(path: str) -> str:
    """Return where the script finds a file, as it says itself."""
    if path.startswith("share:"):
        return path.replace("share:", "/share/")
    return os.path.join(launch.HERE, path)  # noqa: PTH118


def test_output_passes_ament_linters(system: System, tmp_path: Path) -> None:
    """The launch file and the script."""
    (tmp_path / "out").mkdir()
    for target in (rossystem_launch, rossystem_script):
        for name, file in target(system, CONTEXT, {}).items():
            if name.endswith(".py"):
                (tmp_path / "out" / name).write_text(file.text)
    assert_lint_clean(tmp_path / "out")


def test_copies_are_those_of_all_variants(system: System) -> None:
    """At the paths that the system has them at, or below its folder."""
    files = rossystem_script(system, CONTEXT, {})
    copied = {path: file.text for path, file in files.items() if file.original is not None}
    assert set(copied) == {each.removeprefix("../") for each in FILES}
    assert copied["outside.yaml"] == '/**: {ros__parameters: {mode: "../outside.yaml"}}\n'


def test_two_files_for_one_place_are_refused(folder: Path) -> None:
    """One of them would be lost."""
    (folder / "outside.yaml").write_text("")
    system = load_text(
        folder,
        'system Robot imports import "eye.rnd" parameters from "outside.yaml"\n'
        'parameters from "../outside.yaml" node eye : eye',
        eye=TYPE,
    )
    with pytest.raises(GenerationError, match=r"would both be 'outside\.yaml'"):
        rossystem_launch(system, CONTEXT, {})


def test_one_parameter_file_has_everything(folder: Path) -> None:
    """Values of files, where the system does not set them itself."""
    (folder / "a.yaml").write_text('/**: {ros__parameters: {rate: 2.0, mode: "b"}}\n')
    text = 'system Robot imports import "eye.rnd" parameters from "a.yaml" node eye : eye'
    system = load_text(folder, f"{text} parameters param rate = 3", eye=TYPE)
    ((_, file),) = rossystem_params(system, CONTEXT, {}).items()
    assert file.text.endswith('/eye:\n  ros__parameters:\n    mode: "b"\n    rate: 3.0\n')


SIMPLE = 'system Robot imports import "eye.rnd" parameters from "conf/a.yaml" node eye : eye'


def _simple(folder: Path) -> Path:
    (folder / "conf/a.yaml").write_text("eye: {ros__parameters: {rate: 2.0}}\n")
    load_text(folder, SIMPLE, eye=TYPE)
    return folder / "conf/a.yaml"


def test_original_is_neither_written_nor_claimed(folder: Path) -> None:
    """Generating into the folder of the system leaves the file as it is, and so again later."""
    original = _simple(folder)
    before = original.read_bytes(), original.stat().st_mtime_ns
    for _ in range(2):
        for target in ("launch", "script"):
            outcome = deros("generate", folder / "test.system", "--target", target, "-o", folder)
            assert outcome.code == 0, outcome
            assert "a.yaml" not in outcome.out + outcome.err
    assert (original.read_bytes(), original.stat().st_mtime_ns) == before
    assert "a.yaml" not in (folder / ".deros-origins.json").read_text()


def test_copy_follows_the_original_and_keeps_edits(folder: Path, tmp_path: Path) -> None:
    """Both targets need it; a change of the original reaches it, but replaces no edit by hand."""
    original, copy = _simple(folder), tmp_path / "out/conf/a.yaml"

    def generated(target: str) -> str:
        model = folder / "test.system"
        outcome = deros("generate", model, "--target", target, "-o", tmp_path / "out")
        assert outcome.code == 0, outcome
        return outcome.out + outcome.err

    generated("launch")
    generated("script")
    assert copy.read_text().endswith(original.read_text())
    original.write_text("eye: {ros__parameters: {rate: 3.0}}\n")
    generated("launch")
    assert copy.read_text().endswith(original.read_text())
    copy.write_text(copy.read_text().replace("3.0", "4.0"))
    assert "DRS403" in generated("script")
    assert "4.0" in copy.read_text()


def test_build_system_learns_of_parameter_files(folder: Path, tmp_path: Path) -> None:
    """A file that changed makes the output out of date."""
    from deros.pipeline.depfile import is_current

    original, output = _simple(folder), tmp_path / "out"
    stamp, depfile = output / "stamp", output / "depends.d"
    arguments = ("-o", output, "--stamp", stamp, "--depfile", depfile)
    outcome = deros("generate", folder / "test.system", "--target", "script", *arguments)
    assert outcome.code == 0, outcome
    assert str(original) in depfile.read_text()
    assert is_current(stamp, depfile)
    later = time.time_ns() + 10**9
    os.utime(original, ns=(later, later))
    assert not is_current(stamp, depfile)


def test_script_hands_files_over_before_own_values(folder: Path, tmp_path: Path) -> None:
    """Beside the script, and of a package in the folder of programs; what is missing stops it."""
    _simple(folder)
    text = SIMPLE.replace("node eye : eye", 'parameters from "share:demo/b.yaml" node eye : eye')
    load_text(folder, f"{text} parameters param rate = 3", eye=TYPE)
    deros("generate", folder / "test.system", "--target", "script", "-o", tmp_path / "out")
    prefix = make_prefix(tmp_path / "prefix")
    command: list[str | Path] = [
        sys.executable,
        "-IS",
        tmp_path / "out/robot.py",
        "--install",
        prefix,
    ]
    run = Run(command, {"PATH": os.environ["PATH"]})
    assert run.end() == 2
    assert any("nothing was started" in line for line in run.lines), run.lines
    assert "  share:demo/b.yaml" in run.lines
    (prefix / "share/demo").mkdir(parents=True)
    (prefix / "share/demo/b.yaml").write_text("eye: {ros__parameters: {rate: 4.0}}\n")
    run = Run(command, {"PATH": os.environ["PATH"]})
    assert run.end() == 0
    line = next(line for line in run.lines if line.startswith("[eye] ["))
    first, second, third = line.split('"--params-file", "')[1:]
    assert first.startswith(f"{tmp_path}/out/conf/a.yaml")
    assert second.startswith(f"{prefix}/share/demo/b.yaml")
    assert third.startswith("/tmp/") or "deros-" in third
    assert '"-p"' not in line
