"""The generated packages, compared with golden files and checked with ament's linters."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from xml.etree import ElementTree

import pytest

from deros.generators.api.protocol import Files, Owner
from deros.generators.node.cpp.generate import generate
from deros.generators.output.writer import write
from tests.support.cpp import colcon_build, has_package
from tests.support.cpp_lint import assert_cpp_lint_clean
from tests.support.generating import output_of
from tests.support.golden import Golden
from tests.support.golden_packages import SIMPLEST_FIRST, packages_kept
from tests.support.lint import assert_lint_clean
from tests.support.needs import may_run, needs

SHARED = Path(__file__).resolve().parents[1] / "python/models"
MODELS = {
    **{
        n: SHARED / f"{n}.rnd"
        for n in ("odometry_node", "valve", "dock", "talker", "counter", "mapper")
    },
    "picky": Path(__file__).resolve().parent / "models/picky.rnd",
}
COPYRIGHT = {"copyright": "2026 Jane Doe", "maintainer": "Jane Doe <jane@example.org>"}


def files_of(name: str, options: dict[str, str] | None = None) -> Files:
    """Return the generated files of one of the models."""
    return output_of(generate, MODELS[name], **(options or {}))


@pytest.mark.parametrize("name", SIMPLEST_FIRST["rosnode_cpp"])
@pytest.mark.essential
def test_package_matches_golden(name: str, golden: Golden) -> None:
    """Every generated file matches the reviewed text, or its difference from another one."""
    golden.check(f"rosnode_cpp/{name}", packages_kept(f"rosnode_cpp/{name}"))


def test_package_is_independent_of_the_node_order() -> None:
    """Either node of a package leads to the same package with both nodes."""
    assert files_of("talker") == output_of(generate, SHARED / "listener.rnd")
    cmake = files_of("talker")["chat/CMakeLists.txt"].text
    assert "rclcpp_components_register_nodes(listener_component chat::Listener)" in cmake
    assert "rclcpp_components_register_nodes(talker_component chat::Talker)" in cmake


def test_generation_is_deterministic() -> None:
    """Another interpreter, with other hashes, generates the same bytes."""
    script = (
        "import sys; sys.path.insert(0, '.');"
        "from deros.generators.builtin import rosnode_cpp as g;"
        "from deros.generators.api.protocol import Context;"
        "from deros.metamodels.load import Repository; r = Repository();"
        f"f = g(r.load({str(MODELS['odometry_node'])!r}).model, Context(None, r));"
        "print('\\0'.join(p + '\\0' + f[p].text for p in f), end='')"
    )
    outputs = {
        subprocess.run(
            [sys.executable, "-c", script],
            env={"PYTHONHASHSEED": seed, "PATH": "/usr/bin:/bin", "HOME": "/nonexistent"},
            cwd=SHARED,
            capture_output=True,
            check=True,
        ).stdout
        for seed in ("1", "2")
    }
    assert len(outputs) == 1
    assert str(SHARED).encode() not in outputs.pop()


def test_user_files_are_manifest_header_and_source() -> None:
    """All other files belong to the generator."""
    files = files_of("odometry_node")
    users = [path for path, file in files.items() if file.owner is Owner.USER]
    assert users == [
        "differential_odometry/package.xml",
        "differential_odometry/include/differential_odometry/odometry_node.hpp",
        "differential_odometry/src/odometry_node.cpp",
    ]


@pytest.mark.parametrize("name", MODELS)
def test_user_class_overrides_every_handler(name: str) -> None:
    """It overrides each pure virtual function with the same parameters."""
    files = files_of(name)
    for path in (p for p in files if p.endswith("_base.hpp")):
        user = files[path.replace("_base.hpp", ".hpp")].text
        pure = re.findall(r"virtual ([^;]+) = 0;", files[path].text)
        assert pure == re.findall(r" (void [^;]+) override;", user)


# Linters ------------------------------------------------------------------------------------------


@may_run("cppcheck")
@pytest.mark.parametrize(
    ("options", "models"),
    [
        pytest.param({}, MODELS, id="plain"),
        pytest.param(COPYRIGHT, ("picky", "valve"), id="copyright"),
        pytest.param(COPYRIGHT, MODELS, id="copyright, all", marks=pytest.mark.slow),
    ],
)
def test_packages_pass_the_ament_linters(
    options: dict[str, str], models: Iterable[str], tmp_path: Path
) -> None:
    """The C++ and Python linters of ament find nothing in any file."""
    for name in models:
        write(files_of(name, options), tmp_path)
    assert_cpp_lint_clean(tmp_path)
    assert_lint_clean(tmp_path)


@needs("rclcpp")
@pytest.mark.skipif(not has_package("ament_lint_auto"), reason="no ament_lint_auto")
def test_tests_of_the_package_pass(tmp_path: Path) -> None:
    """``colcon test`` passes, with the XML, CMake and copyright linters."""
    for name in ("picky", "valve"):
        write(files_of(name, COPYRIGHT), tmp_path)
    colcon_build(tmp_path, testing=True)


# Other files --------------------------------------------------------------------------------------


def test_package_xml_lists_all_dependencies() -> None:
    """The manifest has format 3, and depends on each message package and the client library."""
    root = ElementTree.fromstring(
        files_of("odometry_node")["differential_odometry/package.xml"].text
    )
    assert root.get("format") == "3"
    depends = {element.text for element in root.findall("depend")}
    assert depends == {
        *("nav_msgs", "rcl_interfaces", "rclcpp", "rclcpp_components", "sensor_msgs"),
        *("std_msgs", "std_srvs"),
    }
    assert root.findtext("buildtool_depend") == "ament_cmake"
    assert [element.text for element in root.findall("license")] == ["Apache-2.0"]


def test_lifecycle_and_action_nodes_link_their_libraries() -> None:
    """A lifecycle node is linked with rclcpp_lifecycle, an action with rclcpp_action."""
    assert "rclcpp_lifecycle::rclcpp_lifecycle" in files_of("valve")["process/CMakeLists.txt"].text
    assert "rclcpp_action::rclcpp_action" in files_of("counter")["counting/CMakeLists.txt"].text


def test_parameter_and_launch_files_match_the_python_target() -> None:
    """The node is started the same way in either language."""
    from deros.generators.node.python.generate import generate as generate_python

    python = output_of(generate_python, MODELS["odometry_node"])
    for path in ("config/odometry_node.yaml", "launch/odometry_node.launch.py"):
        shared = f"differential_odometry/{path}"
        assert files_of("odometry_node")[shared] == python[shared]
