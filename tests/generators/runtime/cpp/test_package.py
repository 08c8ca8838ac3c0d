"""The package ``deros_runtime_cpp``: built, tested and linted as it is shipped."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from deros import __version__
from deros.generators.output.writer import write
from deros.generators.runtime.interface import CPP_RUNTIME, runtime_package
from tests.support.cpp import colcon_build, has_package
from tests.support.cpp_lint import assert_cpp_lint_clean
from tests.support.needs import may_run, needs
from tests.support.safety_cpp import RUNTIME


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """Write the package into a workspace, as ``deros runtime`` does."""
    write(runtime_package(CPP_RUNTIME), tmp_path)
    return tmp_path


def test_package_has_the_version_of_deros() -> None:
    """Generated packages require this version of the runtime."""
    manifest = ET.parse(RUNTIME / "package.xml").getroot()
    assert manifest.findtext("name") == CPP_RUNTIME
    assert manifest.findtext("version") == __version__


def test_build_script_lists_every_source() -> None:
    """No source is missing, and every listed source exists."""
    script = (RUNTIME / "CMakeLists.txt").read_text(encoding="utf-8")
    named = re.findall(r"^  src/(\w+\.cpp)$", script, re.MULTILINE)
    assert named == sorted(path.name for path in (RUNTIME / "src").iterdir())


def test_build_script_and_manifest_have_the_same_dependencies() -> None:
    """The manifest is read by rosdep and colcon, the script by CMake."""
    script = (RUNTIME / "CMakeLists.txt").read_text(encoding="utf-8")
    manifest = ET.parse(RUNTIME / "package.xml").getroot()
    depends = [each.text for each in manifest.findall("depend")]
    required = re.findall(r"^find_package\((\w+) REQUIRED\)$", script, re.MULTILINE)
    exported = re.search(r"ament_export_dependencies\(([^)]*)\)", script)
    assert exported is not None
    assert required == ["ament_cmake", *depends]
    assert exported[1].split() == depends


@may_run("cppcheck")
def test_sources_pass_the_ament_linters(workspace: Path) -> None:
    """Copies in generated packages must pass the same linters."""
    assert_cpp_lint_clean(workspace / CPP_RUNTIME)


@needs("rclcpp")
def test_colcon_builds_and_tests_the_package(workspace: Path) -> None:
    """The library, its headers and its version file are installed, and its own tests pass."""
    install = colcon_build(workspace, testing=has_package("ament_lint_auto"))
    assert (install / f"lib/lib{CPP_RUNTIME}.so").is_file()
    share = install / "share" / CPP_RUNTIME / "cmake"
    assert (share / f"{CPP_RUNTIME}Config-version.cmake").is_file()
    headers = install / "include" / CPP_RUNTIME / CPP_RUNTIME
    assert {path.name for path in headers.iterdir()} == {
        "version.h",
        *(path.name for path in (RUNTIME / "include" / CPP_RUNTIME).iterdir()),
    }
