"""ament_cmake packages with only models and hand-written files, on a real rclcpp."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from tests.support.builds import EACH_GENERATOR, GENERATORS, PROGRAM, Project, configured, replace
from tests.support.cli import deros
from tests.support.cpp import colcon_build, program
from tests.support.needs import needs

NODE = """\
node odometer : odometry "Turns ticks into metres"
subscribes
  topic ticks : std_msgs.Int32
publishes
  topic distance : std_msgs.Float64
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """Create a package as its author starts it."""
    package = tmp_path / "src/my_odometry"
    (package / "models").mkdir(parents=True)
    (package / "models/odometer.rnd").write_text(NODE)
    outcome = deros(
        *("generate", package / "models/odometer.rnd", "--target", "cpp", "--scaffold", package)
    )
    assert outcome.code == 0, outcome.err
    return package


def test_new_package_has_four_kinds_of_files(package: Path) -> None:
    """Only models, manifest, build script and user code are in the source tree."""
    files = {p.relative_to(package).as_posix() for p in package.rglob("*") if p.is_file()}
    assert files == {
        *("CMakeLists.txt", "package.xml", "models/odometer.rnd"),
        *("include/odometry/odometer.hpp", "src/odometer.cpp"),
    }
    assert (package / "CMakeLists.txt").read_text().splitlines()[-1] == (
        'deros_package(MODEL "models/odometer.rnd" GENERATOR cpp)'
    )


@needs("rclcpp")
def test_colcon_builds_and_tests_the_package(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It compiles without warnings, passes ament's linters, and installs no links."""
    monkeypatch.setenv("PATH", f"{os.environ['PATH']}{os.pathsep}{PROGRAM.parent}")
    monkeypatch.setenv("deros_DIR", deros("cmake-dir").out.strip())
    install = colcon_build(package.parent, testing=True)
    assert Path(program(install, "odometry", "odometer")).is_file()
    header = install / "include/odometry/odometry/odometer.hpp"
    assert header.read_text() == (package / "include/odometry/odometer.hpp").read_text()
    assert [p for p in install.rglob("*") if p.is_symlink() and not p.resolve().exists()] == []
    links = [p for p in install.rglob("*") if p.is_symlink()]
    assert [p for p in links if package in p.resolve().parents] == []
    manifest = install / "share/odometry/package.xml"
    assert manifest.read_bytes() == (package / "package.xml").read_bytes()


# The same with a generator whose packages need only CMake -----------------------------------------

PLUGIN = '''\
from deros.generators.api.protocol import File, Owner
from deros.generators.api.registry import generator

MANIFEST = "<package><name>{0}</name><depend>c</depend></package>"
SCRIPT = """\\
cmake_minimum_required(VERSION 3.16)
project({0} C)
add_executable(tell src/tell.c src/ports.c)
target_include_directories(tell PRIVATE include)
add_test(NAME tells COMMAND tell)
"""


@generator("rosnode", "counted")
def counted(model, context, options):
    """A program that knows how many ports a node has."""
    return {
        f"{model.package}/package.xml": File(MANIFEST.format(model.package)),
        f"{model.package}/CMakeLists.txt": File(SCRIPT.format(model.package)),
        f"{model.package}/src/ports.c": File(f"int ports = {len(model.ports)};\\n"),
        f"{model.package}/src/tell.c": File("/* fill in */\\n", Owner.USER),
    }
'''
TELL = """\
#include <stdio.h>
#include "word.h"
extern int ports;
int main(void) { printf("%d " WORD "\\n", ports); return 0; }
"""


@pytest.fixture
def counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Create a package of the plug-in's target, and register the plug-in with deros."""
    plugin = tmp_path / "plug in"
    (plugin / "counted-1.0.dist-info").mkdir(parents=True)
    (plugin / "counted.py").write_text(PLUGIN)
    (plugin / "counted-1.0.dist-info/METADATA").write_text("Name: counted\nVersion: 1.0\n")
    entry = "[textx_generators]\nrosnode_counted = counted:counted\n"
    (plugin / "counted-1.0.dist-info/entry_points.txt").write_text(entry)
    monkeypatch.setenv("PYTHONPATH", str(plugin))
    package = tmp_path / "my package"
    for name, text in (
        ("models/odometer.rnd", NODE),
        ("package.xml", "<package><name>odometry</name><depend>c</depend></package>"),
        ("src/tell.c", TELL),
        ("include/word.h", '#define WORD "ports"\n'),
    ):
        (package / name).parent.mkdir(parents=True, exist_ok=True)
        (package / name).write_text(text)
    return package


def _script(project: str, target: str = "counted") -> str:
    return (
        f"cmake_minimum_required(VERSION 3.22)\nproject({project} C)\n"
        f"find_package(deros REQUIRED)\n"
        f"deros_package(MODEL models/odometer.rnd GENERATOR {target})\n"
    )


def _output_of_program(project: Project) -> str:
    project.built()
    (program,) = project.build_folder.rglob("tell")
    return subprocess.run([program], capture_output=True, text=True, check=True).stdout


@needs("cmake", "ctest", "c++")
@pytest.mark.parametrize("tool", EACH_GENERATOR)
def test_generated_and_hand_written_files_are_built(counted: Path, tool: str) -> None:
    """A changed model or user file is in the next build; nothing else is rebuilt."""
    project = configured(counted, tool, _script("odometry"))
    assert _output_of_program(project) == "2 ports\n"
    assert "Configuring" not in project.built()
    replace(counted / "models/odometer.rnd", "publishes", "publishes\n  topic x : std_msgs.Bool")
    assert _output_of_program(project) == "3 ports\n"
    assert "Configuring" not in project.built()
    replace(counted / "src/tell.c", '"%d "', '"%d of "')
    assert "Configuring" not in project.built(), "sources are links: the compiler sees the edit"
    assert _output_of_program(project) == "3 of ports\n"
    replace(counted / "include/word.h", "ports", "entries")
    assert _output_of_program(project) == "3 of entries\n"
    listed = subprocess.run(
        ["ctest", "-N"], cwd=project.build_folder, capture_output=True, text=True, check=True
    )
    assert "Total Tests: 1" in listed.stdout


@pytest.mark.slow
@needs("cmake", "c++")
@pytest.mark.parametrize("tool", EACH_GENERATOR)
def test_model_error_fails_the_build(counted: Path, tool: str) -> None:
    """The build ends with the diagnostic and its place until the model is fixed."""
    project = configured(counted, tool, _script("odometry"))
    assert _output_of_program(project) == "2 ports\n"
    model = counted / "models/odometer.rnd"
    replace(model, "std_msgs.Int32", "std_msgs.Int23")
    for _ in range(2):
        failed = project.build()
        assert failed.returncode != 0
        assert f"{model}:3:17: error[DRS102 unknown-type]" in failed.stdout
    replace(model, "std_msgs.Int23", "std_msgs.Int32")
    assert _output_of_program(project) == "2 ports\n"
    (counted / "src/tell.c").rename(counted / "src/other.c")
    failed = project.build()
    assert failed.returncode != 0
    assert "lacks src/tell.c" in failed.stdout
    assert "--target counted --scaffold" in " ".join(failed.stdout.split())


@needs("cmake", "make")
@pytest.mark.parametrize(
    ("script", "complaint"),
    [
        (_script("odometer"), "the generated package is odometry"),
        (_script("odometry", "python"), "generator python makes no CMake package"),
        (_script("odometry", "nothing"), "error[DRS404 unknown-target]"),
    ],
)
def test_invalid_package_is_rejected(counted: Path, script: str, complaint: str) -> None:
    """The project name must match, and the target must generate a CMake package."""
    (counted / "package.xml").unlink()
    if "nothing" not in script:
        target = "python" if "python" in script else "counted"
        command = [str(PROGRAM), "generate", "models/odometer.rnd", "--target", target]
        subprocess.run([*command, "--scaffold", "."], cwd=counted, check=True)
    done = Project(counted, GENERATORS[1], script.replace(" C)", " NONE)")).configure()
    assert done.returncode != 0
    assert complaint in " ".join(done.stdout.split())
