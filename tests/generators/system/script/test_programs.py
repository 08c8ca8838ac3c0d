"""Programs of packages: where the script finds them, and their environment."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from deros.generators.system.script.standalone.programs import IMPORTED, QUIET_START, Programs
from tests.support.stand_ins import make_prefix

VERSION = f"python{sys.version_info.major}.{sys.version_info.minor}"


def test_program_is_in_the_lib_folder_of_its_package(tmp_path: Path) -> None:
    """AMENT_PREFIX_PATH is searched in order for lib/PACKAGE/PROGRAM, as by ros2 run."""
    first = make_prefix(tmp_path / "first", names=["short"])
    second = make_prefix(tmp_path / "second", names=["short", "steady"])
    programs = Programs([], {"AMENT_PREFIX_PATH": f"{first}:{second}"})
    assert programs.find("demo", "short") == [str(first / "lib/demo/short")]
    assert programs.find("demo", "steady") == [str(second / "lib/demo/steady")]


def test_program_may_be_in_a_subfolder(tmp_path: Path) -> None:
    """Folders inside the package's are searched for the name, as by ros2 run."""
    prefix = make_prefix(tmp_path, names=["short"])
    deeper = prefix / "lib/demo/tools"
    deeper.mkdir()
    (prefix / "lib/demo/short").rename(deeper / "short")
    programs = Programs([], {"AMENT_PREFIX_PATH": str(prefix)})
    assert programs.find("demo", "short") == [str(deeper / "short")]


def test_path_or_pattern_is_not_a_program_name(tmp_path: Path) -> None:
    """Only a file in the folder of the package is started, whatever the description says."""
    prefix = make_prefix(tmp_path / "prefix", names=["short"])
    foreign = make_prefix(tmp_path / "foreign", names=["steady"]) / "lib/demo/steady"
    programs = Programs([], {"AMENT_PREFIX_PATH": str(prefix)})
    relative = os.path.relpath(foreign, prefix / "lib/demo")
    for name in (str(foreign), relative, "../demo/short", "*", "sh*t", "[s]hort", "", ".", ".."):
        assert programs.find("demo", name) is None, name


def test_file_that_is_not_executable_is_not_a_program(tmp_path: Path) -> None:
    """Missing permission, folders and programs of other packages are skipped."""
    prefix = make_prefix(tmp_path, names=["short", "steady"])
    (prefix / "lib/demo/short").chmod(0o644)
    (prefix / "lib/demo/folder").mkdir()
    programs = Programs([], {"AMENT_PREFIX_PATH": str(prefix)})
    assert programs.find("demo", "short") is None
    assert programs.find("demo", "folder") is None
    assert programs.find("other", "steady") is None


def test_install_spaces_precede_the_environment(tmp_path: Path) -> None:
    """A given folder is a prefix itself, or contains one for each package."""
    ambient = make_prefix(tmp_path / "ambient", names=["short", "steady"])
    merged = make_prefix(tmp_path / "merged", names=["short"])
    make_prefix(tmp_path / "isolated" / "demo", names=["steady"])
    programs = Programs([merged, tmp_path / "isolated"], {"AMENT_PREFIX_PATH": str(ambient)})
    assert programs.find("demo", "short") == [str(merged / "lib/demo/short")]
    assert programs.find("demo", "steady") == [str(tmp_path / "isolated/demo/lib/demo/steady")]


def test_package_that_installs_only_a_share_folder_is_found(tmp_path: Path) -> None:
    """As one of descriptions or maps does, in an install space with a folder for each package."""
    share = tmp_path / "isolated" / "maps" / "share" / "maps"
    share.mkdir(parents=True)
    assert Programs([tmp_path / "isolated"], {}).share("maps") == share
    assert Programs([], {"AMENT_PREFIX_PATH": str(share.parents[1])}).share("maps") == share
    assert Programs([tmp_path / "isolated"], {}).share("other") is None


def test_python_packages_run_from_their_sources(tmp_path: Path) -> None:
    """Entry points of setup.py are programs, run by the interpreter of the script."""
    package = tmp_path / "src" / "my_robot"
    package.mkdir(parents=True)
    (package / "setup.py").write_text(
        "entry_points={'console_scripts': ['odometry = my_robot.wheel_node:main']}"
    )
    programs = Programs([tmp_path / "src"], {})
    assert programs.find("my_robot", "odometry") == [
        sys.executable,
        "-c",
        f"{QUIET_START}from my_robot.wheel_node import main; {IMPORTED}; sys.exit(main())",
    ]
    assert programs.find("my_robot", "metry") is None
    assert programs.find("other", "odometry") is None
    assert programs.environment()["PYTHONPATH"] == str(package)


def test_install_space_needs_no_sourced_setup(tmp_path: Path) -> None:
    """Its folders come first in the paths that a setup file would set, if they exist."""
    prefix = make_prefix(tmp_path / "install" / "demo", names=["short"])
    site = prefix / "lib" / VERSION / "site-packages"
    site.mkdir(parents=True)
    environment = Programs([tmp_path / "install"], {"PYTHONPATH": "/old"}).environment()
    assert environment["AMENT_PREFIX_PATH"] == str(prefix)
    assert environment["LD_LIBRARY_PATH"] == str(prefix / "lib")
    assert environment["PYTHONPATH"] == os.pathsep.join([str(site), "/old"])
    assert "PATH" not in environment


def test_environment_is_passed_on_without_install_spaces() -> None:
    """Only output buffering of Python is disabled, unless the user sets it."""
    assert Programs([], {"A": "b"}).environment() == {"A": "b", "PYTHONUNBUFFERED": "1"}
    assert Programs([], {"PYTHONUNBUFFERED": ""}).environment() == {"PYTHONUNBUFFERED": ""}
