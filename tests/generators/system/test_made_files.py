"""Files that xacro makes are the same however a system is started, and then gone."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import (
    rossystem_launch,
    rossystem_params,
    rossystem_script,
    rossystem_systemd,
)
from deros.generators.output.writer import write
from deros.models.system import System
from tests.generators.system.test_arguments import launch_file
from tests.support import launch
from tests.support.cli import deros
from tests.support.lint import assert_lint_clean
from tests.support.needs import needs
from tests.support.stand_ins import Run
from tests.support.systems import CONTEXT, load_text

HEAD = '<sdf xmlns:xacro="http://www.ros.org/wiki/xacro">'
WORLD = f'{HEAD}<xacro:arg name="who" default="-"/><w a="$(arg headless)" b="$(arg who)"/></sdf>'
INNER = """system Inner
argument robot : string
argument shown : string
file model from xacro "parts/model.xacro" (who = "${robot} \\"x\\"")
process show : "tell" arguments [$shown, $model]
"""
SYSTEM = """system Whole
argument headless : bool = true
argument world : string = "depot"
imports import "inner.system"
file world_file from xacro "worlds/${world}.sdf.xacro" (headless = $headless) when world != ""
process sim : "tell" arguments ["--world=${world_file}", $world_file] env WORLD = $world_file
subsystem left : Inner(robot = "left", shown = $world_file)
subsystem right : Inner(robot = $world, shown = "none") when headless
"""
FILES = {
    "inner.system": INNER,
    "worlds/depot.sdf.xacro": WORLD,
    "parts/model.xacro": f'{HEAD}<xacro:arg name="who" default="-"/><m a="$(arg who)"/></sdf>',
}
TELLS = f"""#!{sys.executable} -IS
import json, os, signal, sys
signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
words = sys.argv[1:]
paths = [word.split("=")[-1] for word in (*words, os.environ.get("WORLD", ""))]
read = [[path, open(path).read()] for path in paths if path.startswith("/")]
with open(os.environ["TOLD"], "a") as told:
    told.write(json.dumps(read) + "\\n")
os.write(1, b"tell ready\\n")
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
    """Return an environment with xacro, a program that tells what it reads, and a folder."""
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "tell").write_text(TELLS)
    (tmp_path / "bin" / "tell").chmod(0o755)
    (tmp_path / "bin" / "xacro").symlink_to(XACRO)
    (tmp_path / "tmp").mkdir()
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tmp"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "tmp"))
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("TOLD", str(tmp_path / "told"))
    return dict(os.environ)


def _told(folder: Path) -> list[list[tuple[str, str]]]:
    import json

    lines = (folder / "told").read_text().splitlines()
    return [[(path, text) for path, text in json.loads(line)] for line in lines]


def _script(folder: Path, system: System) -> Path:
    write(rossystem_script(system, CONTEXT), folder / "out")
    for name, text in FILES.items():
        if name.endswith(".xacro"):
            (folder / "out" / name).write_text(text)
    return folder / "out" / "whole.py"


def _run(command: list[Any], environment: Mapping[str, str], programs: int) -> int:
    run = Run(command, dict(environment))
    try:
        run.until("tell ready", times=programs)
        run.signal(signal.SIGINT)
        return run.end()
    finally:
        run.close()


def _values(told: list[list[tuple[str, str]]]) -> list[list[str]]:
    """Return what is in quotes in the texts that programs have read, by program."""
    return sorted(
        [text.split("<")[-2].split('"', 1)[1].strip() for _, text in read] for read in told
    )


EXPECTED = {
    ("true", "depot"): [
        ['depot &quot;x&quot;"/>'],
        ['true" b="-"/>', 'left &quot;x&quot;"/>'],
        ['true" b="-"/>'] * 3,
    ],
    ("false", "depot"): [['false" b="-"/>', 'left &quot;x&quot;"/>'], ['false" b="-"/>'] * 3],
    ("true", ""): [[], ['&quot;x&quot;"/>'], ['left &quot;x&quot;"/>']],
}


@pytest.mark.parametrize("headless", ["true", "false"])
def test_every_way_of_starting_makes_the_same_files(
    system: System, tmp_path: Path, environment: Mapping[str, str], headless: str
) -> None:
    """With the values of each place where a system is used; all is gone when all has ended."""
    script, given = _script(tmp_path, system), f"headless:={headless}"
    expected = sorted(EXPECTED[headless, "depot"])
    assert _run([sys.executable, script, given], environment, len(expected)) == 130
    (tmp_path / "whole.system").write_text(SYSTEM)
    of_script = _told(tmp_path)
    (tmp_path / "told").unlink()
    up = [sys.executable, "-m", "deros", "up", tmp_path / "whole.system", "--", given]
    assert _run(up, environment, len(expected)) == 130
    of_up = _told(tmp_path)
    assert list((tmp_path / "tmp").iterdir()) == []
    for told in (of_script, of_up):
        assert _values(told) == expected
        names = {Path(path).name for read in told for path, _ in read}
        assert names == {"depot.sdf", "model"}

    read: list[list[tuple[str, str]]] = []
    for words, variables in launch.with_files(
        launch_file(system), {"headless": headless}, str(script.parent)
    ):
        paths = [word.split("=")[-1] for word in (*words, *variables.values())]
        read.append([(p, Path(p).read_text()) for p in paths if p.startswith("/")])
    assert _values(read) == expected
    assert list((tmp_path / "tmp").iterdir()) == []


def test_path_is_empty_where_the_file_is_not_made(
    system: System, tmp_path: Path, environment: Mapping[str, str]
) -> None:
    """And xacro does not run for it."""
    script = _script(tmp_path, system)
    assert _run([sys.executable, script, "world:="], environment, 3) == 130
    assert _values(_told(tmp_path)) == sorted(EXPECTED["true", ""])


@pytest.mark.parametrize("missing", ["'xacro'", "depot.sdf.xacro", "division by zero"])
def test_nothing_is_started_without_a_file(
    system: System, tmp_path: Path, environment: Mapping[str, str], missing: str
) -> None:
    """The program, the file, and what xacro itself says; nothing is left behind."""
    script = _script(tmp_path, system)
    world = script.parent / "worlds" / "depot.sdf.xacro"
    if missing == "'xacro'":
        (tmp_path / "bin" / "xacro").unlink()
        environment = {**environment, "PATH": str(tmp_path / "bin")}
        os.environ["PATH"] = environment["PATH"]
    elif missing == "division by zero":
        world.write_text(WORLD.replace("$(arg who)", "${1/0}"))
    else:
        world.unlink()
    command: list[str | Path] = [sys.executable, script]
    found = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert found.returncode == 2
    assert missing in found.stderr
    assert "nothing was started" in found.stderr
    with pytest.raises((FileNotFoundError, RuntimeError), match=missing):
        list(launch.with_files(launch_file(system), {}, str(script.parent)))
    assert not (tmp_path / "told").exists()
    assert list((tmp_path / "tmp").iterdir()) == []


@needs("bash")
def test_dry_run_prints_commands_that_make_the_same(
    system: System, tmp_path: Path, environment: Mapping[str, str]
) -> None:
    """Before those of the programs."""
    command = [sys.executable, str(_script(tmp_path, system)), "--only", "sim", "--dry-run"]
    printed = subprocess.run(
        command, env=environment, capture_output=True, text=True, check=True
    ).stdout
    assert list((tmp_path / "tmp").iterdir()) == []
    *before, last = printed.splitlines()
    variable, _, words = last.partition(" ")
    text = "\n".join([*before, f"export {variable}; exec {words}"])
    assert _run(["bash", "-c", text], environment, 1) == 0
    assert _values(_told(tmp_path)) == [['true" b="-"/>'] * 3]


def test_copies_bring_what_xacro_reads(system: System) -> None:
    """Each at its place, beside the script and the launch file."""
    for target in (rossystem_script, rossystem_launch):
        names = {path for path in target(system, CONTEXT) if not path.startswith("whole")}
        assert names == {"worlds/depot.sdf.xacro", "parts/model.xacro"}


def test_generated_files_pass_the_linters(system: System, tmp_path: Path) -> None:
    """As all that is generated does."""
    for name, target in (("script", rossystem_script), ("launch", rossystem_launch)):
        files = target(system, CONTEXT)
        write({path: f for path, f in files.items() if path.startswith("whole")}, tmp_path / name)
        assert_lint_clean(tmp_path / name)


def test_targets_that_hold_values_refuse_files_that_are_made(system: System) -> None:
    """A unit names the file; a parameter file holds nothing that is computed."""
    with pytest.raises(GenerationError, match="file 'world_file' is made when the system"):
        rossystem_systemd(system, CONTEXT)
    with pytest.raises(GenerationError, match="a parameter file has values"):
        rossystem_params(system, CONTEXT)


@pytest.mark.usefixtures("system")
def test_checked_system_is_drawn(tmp_path: Path) -> None:
    """The page and the graph take the path as a text that is known at the start."""
    (tmp_path / "whole.system").write_text(SYSTEM)
    assert deros("check", "--strict", tmp_path / "whole.system").code == 0
    page = deros("graph", "--format", "html", tmp_path / "whole.system")
    assert page.code == 0, page.err
