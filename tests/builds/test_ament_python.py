"""ament_python packages with only models and hand-written files, built by the real colcon."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.builds import colcon, frozen_program, models, replace
from tests.support.cli import deros
from tests.support.needs import needs

ACTIONS = "robot_safety/robot_safety_node_actions.py"
MORE = """
from deros.build import setup

setup(
    'models/robot.deros',
    options={'maintainer': 'Jo <jo@example.com>'},
    data_files=[('share/robot_safety/maps', ['maps/field.txt'])],
    entry_points={'console_scripts': ['field = robot_safety.field:main']},
    keywords=['field'],
)
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """Create a package as its author starts it; colcon does not support spaces in its path."""
    package = tmp_path / "workspace/src/safety"
    rules = models(package / "models")
    outcome = deros("generate", rules, "--target", "python", "--scaffold", package)
    assert outcome.code == 0, outcome.err
    return package


def _workspace(package: Path) -> Path:
    return package.parent.parent


def _limit(workspace: Path) -> float:
    """Return the speed limit in the monitor that programs of the workspace import."""
    script = f". '{workspace}/install/setup.sh'; cd /; exec {sys.executable} -c \"$1\""
    ask = "import robot_safety.monitor as m; print(m.__file__)"
    ran = subprocess.run(
        ["sh", "-c", script, "sh", ask], capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stderr
    text = Path(ran.stdout.strip()).read_text()
    assert "deros." not in text
    compared = (n for n in ast.walk(ast.parse(text)) if isinstance(n, ast.Compare))
    numbers = (c.value for n in compared for c in n.comparators if isinstance(c, ast.Constant))
    (limit,) = {number for number in numbers if isinstance(number, float)}
    return limit


def test_new_package_has_four_kinds_of_files(package: Path) -> None:
    """Only models, manifest, build script and user code are in the source tree."""
    files = {str(p.relative_to(package)) for p in package.rglob("*") if p.is_file()}
    kept = {name for name in files if not name.startswith("models/")}
    assert kept == {"package.xml", "setup.py", ACTIONS}
    assert (package / "setup.py").read_text() == (
        "from deros.build import setup\n\nsetup('models/robot.deros')\n"
    )


@needs("sh")
@pytest.mark.slow
@pytest.mark.parametrize("how", [(), ("--symlink-install",)], ids=["install", "symlink-install"])
def test_colcon_builds_the_current_models(package: Path, how: tuple[str, ...]) -> None:
    """Each build uses the models as they are, and leaves no other files in the source tree."""
    workspace = _workspace(package)
    for limit in (0.5, 0.75):
        replace(package / "models/robot.deros", "0.5 m/s", f"{limit} m/s")
        done = colcon(workspace, *how)
        assert done.returncode == 0, done.stdout
        assert _limit(workspace) == limit
        replace(package / "models/robot.deros", f"{limit} m/s", "0.5 m/s")
    installed = workspace / "install/robot_safety"
    assert (installed / "lib/robot_safety/robot_safety_node").is_file()
    assert (installed / "share/robot_safety/launch/robot_safety_node.launch.py").is_file()
    assert (installed / "share/ament_index/resource_index/packages/robot_safety").is_file()
    names = {p.name for p in package.iterdir()}
    assert names - {".deros"} == {"models", "package.xml", "setup.py", "robot_safety"}
    assert (package / ".deros/.gitignore").read_text() == "*\n"


@needs("sh")
@pytest.mark.slow
def test_model_error_fails_the_build_with_its_place(package: Path) -> None:
    """The output shows the diagnostic, not a traceback of setup.py; nothing is installed."""
    rules = package / "models/robot.deros"
    replace(rules, "0.5 m/s", "0.5 kg")
    done = colcon(_workspace(package))
    assert done.returncode != 0
    assert "models/robot.deros:13:27: error[DRS306 incompatible-units]" in done.stdout
    assert "Traceback" not in done.stdout
    assert not list(_workspace(package).glob("install/**/monitor.py"))


@needs("sh")
@pytest.mark.slow
def test_additional_user_files_are_installed(package: Path) -> None:
    """Hand-written modules, programs and data files are installed with the generated ones."""
    (package / "setup.py").write_text(MORE)
    (package / "maps").mkdir()
    (package / "maps/field.txt").write_text("green\n")
    (package / "robot_safety/field.py").write_text("def main():\n    print('field')\n")
    done = colcon(_workspace(package))
    assert done.returncode == 0, done.stdout
    installed = _workspace(package) / "install/robot_safety"
    assert (installed / "share/robot_safety/maps/field.txt").read_text() == "green\n"
    assert (installed / "lib/robot_safety/field").is_file()
    assert (installed / "lib/robot_safety/robot_safety_node").is_file()
    assert list(installed.rglob("robot_safety/field.py"))
    (metadata,) = installed.rglob("PKG-INFO")
    assert "jo@example.com" in metadata.read_text()
    assert "Keywords: field" in metadata.read_text()


@pytest.mark.slow
def test_missing_user_code_is_reported_by_every_build(package: Path) -> None:
    """A new action in the rules does not fail the build, but is reported until it is written."""

    def build() -> str:
        command = [sys.executable, "setup.py", "egg_info", "--egg-base", str(package.parent)]
        env = {**os.environ, "PYTHONPATH": str(package.parent / "deros_runtime")}
        done = subprocess.run(
            command, cwd=package, env=env, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        return done.stderr

    assert "DRS407" not in build()
    rules = package / "models/robot.deros"
    replace(rules, "action resume;", "action resume;\naction horn;")
    replace(rules, "then { stop;", "then { horn; stop;")
    for _ in range(2):
        build_output = build()
        assert "has no method 'horn', which the model now asks for" in build_output
        assert f"{ACTIONS}:" in build_output
    actions = package / ACTIONS
    actions.write_text(f"{actions.read_text()}\n    def horn(self) -> None:\n        pass\n")
    for _ in range(2):
        assert "DRS4" not in build()


@needs("sh")
@pytest.mark.slow
def test_missing_user_file_fails_the_build(package: Path) -> None:
    """An action with user code needs its file; the build names the command that writes it."""
    (package / ACTIONS).unlink()
    done = colcon(_workspace(package))
    assert done.returncode != 0
    assert f"lacks {ACTIONS}" in done.stdout
    (command,) = (line for line in done.stdout.splitlines() if "to fix it:" in line)
    assert command.endswith(f"--target python --scaffold {package}")
    assert not (package / ".deros" / ACTIONS).exists()


def test_setup_generates_only_changes(package: Path) -> None:
    """A second run of setup.py generates nothing; a deleted file is generated again."""
    generated = package / ".deros/robot_safety/robot_safety/monitor.py"
    command = [sys.executable, "setup.py", "--name"]

    env = {**os.environ, "PYTHONPATH": str(frozen_program().parents[1])}

    def name() -> str:
        done = subprocess.run(
            command, cwd=package, env=env, capture_output=True, text=True, check=True
        )
        return done.stdout

    assert name() == "robot_safety\n", "colcon reads the output of setup.py"
    stamp = package / ".deros/stamp"
    first = stamp.stat().st_mtime_ns
    assert name() == "robot_safety\n"
    assert stamp.stat().st_mtime_ns == first
    generated.unlink()
    name()
    assert generated.exists()
    assert stamp.stat().st_mtime_ns > first


def test_target_must_generate_a_setuptools_package(package: Path) -> None:
    """Other targets are rejected with an explanation."""
    script = "from deros.build import setup\nsetup('models/robot.deros', target='c')\n"
    (package / "setup.py").write_text(script)
    command = [sys.executable, "setup.py", "build"]
    done = subprocess.run(command, cwd=package, capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert done.stderr == "deros: the target c does not generate an ament_python package\n"
