"""CMake projects that generate during the build, with Ninja and Make, in folders with spaces."""

from __future__ import annotations

import platform
import shutil
import subprocess
from pathlib import Path

import pytest

import deros
from deros.generators.monitor.c.code.names import prefix_of
from tests.support.builds import (
    EACH_GENERATOR,
    GENERATORS,
    PROGRAM,
    Project,
    configured,
    frozen_program,
    models,
    replace,
    times,
    touch,
)
from tests.support.cli import deros as run
from tests.support.needs import needs

pytestmark = needs("cmake", "make")

HEAD = (
    "cmake_minimum_required(VERSION 3.22)\nproject(p LANGUAGES {})\nfind_package(deros REQUIRED)\n"
)
PLAIN = HEAD.format("NONE")
SCRIPT = PLAIN + 'deros_generate(started MODEL "my models/robot.system" GENERATOR script)\n'
CMAKE = Path(deros.__file__).parent / "cmake"


@pytest.fixture(params=EACH_GENERATOR)
def tool(request: pytest.FixtureRequest) -> str:
    """Return each of CMake's generators in turn."""
    return str(request.param)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Create a folder with models; its name and theirs contain spaces."""
    folder = tmp_path / "my project"
    models(folder / "my models")
    return folder


def test_generates_only_when_an_input_changes(folder: Path, tool: str) -> None:
    """Inputs are the model, its imports and the rules that it names, and no other file."""
    project = configured(folder, tool, SCRIPT)
    source = folder / "my models"
    assert project.generated() == 1
    assert (project.build_folder / "started/robot_system.py").is_file()
    assert project.generated() == 0
    for name in ("robot.system", "robot_robot.rnd", "robot.deros"):
        touch(source / name)
        assert project.generated() == 1
        assert project.generated() == 0
    (source / "unrelated.deros").write_text("")
    assert project.generated() == 0
    (source / "robot_robot.rnd").rename(source / "other.rnd")
    replace(source / "robot.system", "robot_robot.rnd", "other.rnd")
    assert project.generated() == 1, "a missing description must not fail"
    assert project.generated() == 0


@pytest.mark.slow
def test_folders_of_import_globs_are_inputs(folder: Path, tool: str) -> None:
    """A description added to or removed from such a folder is detected."""
    source = folder / "my models"
    (source / "nodes").mkdir()
    (source / "robot_robot.rnd").rename(source / "nodes/robot_robot.rnd")
    replace(source / "robot.system", '"robot_robot.rnd"', '"nodes/*.rnd"')
    project = configured(folder, tool, SCRIPT)
    assert project.generated() == 1
    assert project.generated() == 0
    (source / "nodes/new.rnd").write_text("node newcomer : somewhere\n")
    assert project.generated() == 1
    assert project.generated() == 0
    touch(source / "nodes/new.rnd")
    assert project.generated() == 1
    (source / "nodes/new.rnd").unlink()
    assert project.generated() == 1
    assert project.generated() == 0


@pytest.mark.slow
def test_deros_itself_is_an_input(folder: Path, tool: str) -> None:
    """Another version of deros may generate other files."""
    project = configured(folder, tool, SCRIPT)
    assert project.generated() == 1
    touch(frozen_program().parents[1] / "deros/generators/system/script/generate.py")
    assert project.generated() == 1
    assert project.generated() == 0


@pytest.mark.slow
def test_model_error_fails_the_build(folder: Path, tool: str) -> None:
    """The build ends with the diagnostic; the output stays until the model is fixed."""
    project = configured(folder, tool, SCRIPT)
    project.built()
    output = project.build_folder / "started/robot_system.py"
    before = output.read_bytes()
    system = folder / "my models/robot.system"
    replace(system, "connect odom to", "connect odmo to")
    failed = project.build()
    assert failed.returncode != 0
    line = system.read_text().splitlines().index("    connect odmo to /odom") + 1
    assert f"{system}:{line}:13: error[DRS204 unknown-port]" in failed.stdout
    assert "did you mean 'odom'?" in failed.stdout
    assert output.read_bytes() == before
    assert project.build().returncode != 0, "it fails until it is fixed"
    replace(system, "connect odmo to", "connect odom to")
    assert project.generated() == 1


def test_project_with_a_faulty_model_can_be_configured(folder: Path, tool: str) -> None:
    """The model is read during the build, where its errors are reported."""
    replace(folder / "my models/robot.system", "connect odom to", "connect odmo to")
    project = configured(folder, tool, SCRIPT)
    assert "error[DRS204 unknown-port]" in project.build().stdout


@pytest.mark.slow
def test_options_and_message_definitions_are_inputs(folder: Path, tool: str) -> None:
    """Changing either runs the generator again."""
    definitions = folder / "messages/nav_msgs/msg"
    definitions.mkdir(parents=True)
    (definitions / "Odometry.msg").write_text("geometry_msgs/TwistWithCovariance twist\n")
    outcome = run(
        *("generate", folder / "my models/robot.deros", "--target", "python"),
        *("--package", "first", "--scaffold", folder / "by hand"),
    )
    assert outcome.code == 0, outcome.err
    script = PLAIN + (
        'deros_generate(node MODEL "my models/robot.deros" GENERATOR python\n'
        '  SOURCE_DIRECTORY "by hand" INTERFACES messages OPTIONS --package=first)\n'
    )
    project = configured(folder, tool, script)
    assert project.generated() == 1
    replace(definitions / "Odometry.msg", "twist\n", "twist\nint32 quality\n")
    assert project.generated() == 1
    assert project.generated() == 0
    replace(folder / "CMakeLists.txt", "--package=first", "--package=second")
    failed = project.build()
    assert failed.returncode != 0
    assert (
        "is the manifest of package 'first', but the generated package is 'second'" in failed.stdout
    )
    options = '--package=first "--maintainer=Jo <jo@example.com>"'
    replace(folder / "CMakeLists.txt", "--package=second", options)
    assert project.generated() == 1
    assert "jo@example.com" in (project.build_folder / "node/first/setup.py").read_text()
    assert project.generated() == 0


def test_user_files_are_not_generated_in_the_build_tree(folder: Path, tool: str) -> None:
    """They belong in the source tree, and the build says so."""
    script = PLAIN + 'deros_generate(node MODEL "my models/robot.deros" GENERATOR python)\n'
    project = configured(folder, tool, script)
    failed = project.build()
    assert failed.returncode != 0
    assert "lacks package.xml, robot_safety/robot_safety_node_actions.py" in failed.stdout
    assert "--target python --scaffold" in failed.stdout
    assert not (project.build_folder / "node").exists()


def test_invalid_call_is_a_cmake_error(folder: Path) -> None:
    """Missing models, unknown words and missing keywords are reported by CMake itself."""
    for call, complaint in (
        ("deros_generate(x MODEL no.deros GENERATOR c)", "there is no model"),
        ("deros_generate(x GENERATOR c)", "deros_generate: MODEL is not given"),
        ('deros_generate(x MODEL "my models/robot.deros" GENERATOR)', "GENERATOR lacks its value"),
        ('deros_add_monitor(x "my models/robot.deros")', "deros_add_monitor: what is"),
    ):
        done = Project(folder, GENERATORS[1], PLAIN + call + "\n").configure()
        assert done.returncode != 0
        assert complaint in " ".join(done.stdout.split())


def test_package_is_found_in_a_prefix(folder: Path, tmp_path: Path) -> None:
    """An environment in CMake's search path needs no deros_DIR; its own program is used."""
    prefix = tmp_path / "an environment"
    (prefix / "share/deros").mkdir(parents=True)
    (prefix / "bin").mkdir()
    shutil.copytree(CMAKE, prefix / "share/deros/cmake")
    (prefix / "share/deros/cmake/derosFunctions.cmake").unlink()
    (prefix / "bin/deros").symlink_to(PROGRAM)
    script = PLAIN.replace("deros REQ", f"deros {deros.__version__} EXACT REQ")
    (folder / "CMakeLists.txt").write_text(script)
    where = ["-S", str(folder), "-B", str(tmp_path / "b")]
    command = ["cmake", *where, f"-DCMAKE_PREFIX_PATH={prefix}"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    cache = (tmp_path / "b/CMakeCache.txt").read_text()
    assert f"deros_EXECUTABLE:FILEPATH={prefix}/bin/deros" in cache


@pytest.mark.parametrize(
    ("wanted", "fits"),
    [
        ("", True),
        ("0.1", True),
        (deros.__version__, True),
        ("0.0...<2", True),
        ("99", False),
        ("0.0.1", False),
        ("0.0...0.0.9", False),
    ],
)
def test_cmake_version_is_that_of_deros(tmp_path: Path, wanted: str, fits: bool) -> None:
    """Version requests are answered as CMake expects."""
    script = PLAIN.replace("deros REQ", f"deros {wanted} REQ")
    done = Project(tmp_path, GENERATORS[1], script).configure()
    assert (done.returncode == 0) == fits, done.stdout
    assert (
        f'PACKAGE_VERSION "{deros.__version__}"' in (CMAKE / "derosConfigVersion.cmake").read_text()
    )


NAMES = [
    "robot",
    "Robot",
    "my-robot",
    "fooBar2Baz",
    "two  words",
    "2wheels",
    "_x_",
    "a.b",
    "HTTPDog",
]


def test_cmake_and_generator_agree_on_file_names(tmp_path: Path) -> None:
    """CMake derives the prefix of the C files as the generator does."""
    calls = [f'_deros_c_prefix("{name}" got)\nmessage("got ${{got}}")' for name in NAMES]
    done = Project(tmp_path, GENERATORS[1], PLAIN + "\n".join(calls) + "\n").configure()
    got = [line.removeprefix("got ") for line in done.stdout.splitlines() if line[:4] == "got "]
    assert got == [prefix_of(name) for name in NAMES]


# The monitor as a library -------------------------------------------------------------------------

FIRMWARE = (
    HEAD.format("C")
    + """
add_subdirectory(safety)
add_executable(firmware main.c)
target_link_libraries(firmware PRIVATE robot_monitor)
"""
)
MAIN = """
#include "robot_monitor.h"
#include <stdio.h>

void robot_emit(void *owner, int64_t t, robot_kind kind, uint32_t site)
{
  (void)owner;
  (void)kind;
  printf("%lld line %lu\\n", (long long)t, (unsigned long)robot_sites[site].line);
}

int main(void)
{
  static robot_monitor monitor;
  robot_start(&monitor, 0, 0, 0);
  (void)robot_advance(&monitor, 1000000000);
  return 0;
}
"""


@pytest.mark.slow
@needs("cc")
def test_firmware_links_to_the_monitor(folder: Path, tool: str) -> None:
    """Nothing is recompiled unless the code of the monitor changes."""
    (folder / "safety").mkdir(parents=True)
    call = 'deros_add_monitor(robot_monitor MODEL "../my models/robot.deros")\n'
    (folder / "safety/CMakeLists.txt").write_text(call)
    (folder / "main.c").write_text(MAIN)
    project = configured(folder, tool, FIRMWARE)
    project.built()
    rules = folder / "my models/robot.deros"
    line = 1 + rules.read_text().splitlines().index(
        'if drive.too_fast or drive.blind then { stop; log_state("stopped"); };'
    )
    program = str(project.build_folder / "firmware")
    program_output = subprocess.run([program], capture_output=True, text=True, check=True).stdout
    assert program_output.startswith(f"500000000 line {line}\n")
    before = times(project.build_folder)
    touch(rules)
    assert project.generated() == 1
    after = times(project.build_folder)
    compiled = {name for name in after if name.endswith((".o", ".a", ".c", ".h", "firmware"))}
    assert {name for name in compiled if before[name] != after[name]} == set()
    replace(rules, "for 2 sec", "for 3 sec")
    assert "robot_monitor.c" in project.built()
    project.built("--target", "clean")
    assert not (project.build_folder / "safety/robot_monitor/robot_monitor.h").exists()
    assert project.generated() == 1


FUSED = {"x86_64": ["-mfma"], "aarch64": []}
"""By processor, the options with which a compiler may fuse a product and a sum."""


@pytest.mark.slow
@pytest.mark.skipif(platform.machine() not in FUSED, reason="no known fused instructions")
@needs("cc", "ninja", "objdump")
def test_products_and_sums_are_not_fused(folder: Path) -> None:
    """Each operation of a rule is rounded, whatever the compiler may do by default."""
    options = ["-O2", *FUSED[platform.machine()]]
    rules = folder / "my models/robot.deros"
    replace(rules, "speed.abs() > max_speed", "speed * speed + speed * 2 sec * 1 m/s^2 > 3 m^2/s^2")
    project = Project(
        folder,
        GENERATORS[0],
        HEAD.format("C") + 'deros_add_monitor(safe MODEL "my models/robot.deros")\n',
    )
    done = project.configure(f"-DCMAKE_C_FLAGS={' '.join(options)}")
    assert done.returncode == 0, done.stdout
    project.built()
    (compiled,) = project.build_folder.rglob("robot_monitor.c.o")
    assert "fmadd" not in _disassembled(compiled)
    (source,) = project.build_folder.rglob("robot_monitor.c")
    fused = folder / "fused.o"
    subprocess.run(["cc", *options, "-c", str(source), "-o", str(fused)], check=True)
    assert "fmadd" in _disassembled(fused), "this compiler fuses nothing"


def _disassembled(path: Path) -> str:
    command = ["objdump", "--disassemble", str(path)]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout
