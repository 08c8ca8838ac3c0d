"""Packages with ``--runtime package`` link ``deros_runtime_cpp`` and check its version."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path
from typing import Any

import pytest

from deros import __version__
from deros.generators.api.protocol import Files
from deros.generators.output.writer import write
from deros.generators.runtime.interface import CPP_RUNTIME, runtime_package
from deros.generators.safety_package.cpp.generate import generate
from tests.support.cpp import colcon_build, overlay, program, rclcpp_environment
from tests.support.cpp_lint import assert_cpp_lint_clean
from tests.support.generating import output_of
from tests.support.needs import may_run, needs
from tests.support.ros import Peer, running
from tests.support.safety_cpp import RUNTIME

RULES = Path(__file__).resolve().parents[2] / "safety_node/cpp/models/base/robot.deros"
PACKAGE = "base_safety_cpp"
PROGRAMS = ("base_safety_node_cpp", "base_command_gate_cpp")
OTHER_VERSION = "99.0.0"


def generated(runtime: str, package: str = "base_safety") -> Files:
    """Return the package of a safety node and a gate."""
    names = {"package": package, "node": "base_safety_node"}
    return output_of(generate, RULES, **{**names, "runtime": runtime})


def runtime_in(folder: Path, version: str = __version__) -> None:
    """Write the runtime package into a folder, in a given version."""
    write(runtime_package(CPP_RUNTIME), folder)
    manifest = folder / CPP_RUNTIME / "package.xml"
    text = manifest.read_text(encoding="utf-8")
    changed = text.replace(f"<version>{__version__}<", f"<version>{version}<")
    manifest.write_text(changed, encoding="utf-8")


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return an install folder with the runtime and a package linked with it."""
    workspace = tmp_path_factory.mktemp("linked")
    runtime_in(workspace)
    write(generated("package"), workspace)
    return colcon_build(workspace)


@pytest.fixture(scope="module")
def other_runtime(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return an install folder with another version of the runtime."""
    workspace = tmp_path_factory.mktemp("other")
    runtime_in(workspace, OTHER_VERSION)
    return colcon_build(workspace)


def test_package_depends_on_the_runtime_and_has_no_copy() -> None:
    """Manifest and build script require the version of this deros."""
    files = generated("package")
    assert not [path for path in files if "/runtime/" in path]
    script = files[f"{PACKAGE}/CMakeLists.txt"].text
    assert f"find_package({CPP_RUNTIME} {__version__} EXACT REQUIRED)\n" in script
    assert script.count(f"  {CPP_RUNTIME}::{CPP_RUNTIME}\n") == len(PROGRAMS)
    depend = f'  <depend version_eq="{__version__}">{CPP_RUNTIME}</depend>\n'
    assert depend in files[f"{PACKAGE}/package.xml"].text
    included = {
        header
        for file in files.values()
        for header in re.findall(rf'#include "{CPP_RUNTIME}/(\w+\.hpp)"', file.text)
    }
    assert included <= {path.name for path in (RUNTIME / "include" / CPP_RUNTIME).iterdir()}


def test_package_with_a_copy_is_complete_in_itself() -> None:
    """It does not name the runtime package."""
    copied = generated("copy")
    assert CPP_RUNTIME not in "".join(file.text for file in copied.values())
    assert f"{PACKAGE}/src/runtime/safety_node_core.cpp" in copied


def test_other_values_of_the_option_are_rejected() -> None:
    """The message lists the valid values."""
    with pytest.raises(ValueError, match="'shared' is neither 'copy' nor 'package'"):
        generated("shared")


def test_package_with_the_name_of_the_runtime_is_rejected() -> None:
    """It would depend on itself."""
    with pytest.raises(ValueError, match="has the name of the runtime that it depends on"):
        generated("package", package=CPP_RUNTIME)


@may_run("cppcheck")
def test_linked_package_passes_the_ament_linters(tmp_path: Path) -> None:
    """Packages with a copy are linted in another test."""
    write(generated("package"), tmp_path)
    assert_cpp_lint_clean(tmp_path / PACKAGE)


@pytest.mark.ros
@needs("rclcpp")
def test_linked_nodes_run(installed: Path, ros_env: dict[str, str], ros_peer: Peer) -> None:
    """The safety node publishes heartbeats, and its gate passes a command."""
    from geometry_msgs.msg import Twist
    from std_msgs.msg import Float64, UInt64

    heartbeats: list[Any] = []
    commands: list[Any] = []
    node = ros_peer.node
    node.create_subscription(UInt64, "/base_safety_node/heartbeat", heartbeats.append, 10)
    node.create_subscription(Twist, "/base/command", commands.append, 10)
    wish = node.create_publisher(Twist, "/base/wish", 10)
    speed = node.create_publisher(Float64, "/speed", 10)
    wished = Twist()
    wished.linear.x = 0.25

    def publish() -> bool:
        speed.publish(Float64())
        wish.publish(wished)
        return bool(heartbeats) and any(command.linear.x == 0.25 for command in commands)

    env = overlay(installed, ros_env)
    safety_node, gate = ([program(installed, PACKAGE, name)] for name in PROGRAMS)
    with running(safety_node, env), running(gate, env):
        ros_peer.until(publish)


@needs("rclcpp")
@needs("cmake")
def test_other_runtime_version_fails_the_build(other_runtime: Path, tmp_path: Path) -> None:
    """CMake accepts only the version that the package was generated for."""
    write(generated("package"), tmp_path)
    env = rclcpp_environment()
    assert env is not None
    prefixes = f"-DCMAKE_PREFIX_PATH={other_runtime};{env['AMENT_PREFIX_PATH'].replace(':', ';')}"
    command = ["cmake", "-S", str(tmp_path / PACKAGE), "-B", str(tmp_path / "build"), prefixes]
    done = subprocess.run(
        command, env=env, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode != 0
    message = " ".join(done.stderr.split())
    assert f'"{CPP_RUNTIME}" that exactly matches requested version "{__version__}"' in message
    assert f"version: {OTHER_VERSION}" in message


@pytest.mark.ros
@needs("rclcpp")
@pytest.mark.parametrize("name", PROGRAMS)
def test_other_runtime_version_prevents_the_start(
    name: str, installed: Path, other_runtime: Path, ros_env: dict[str, str]
) -> None:
    """The program reports both versions, and exits before it creates a node."""
    env = overlay(installed, ros_env)
    env["LD_LIBRARY_PATH"] = f"{other_runtime / 'lib'}:{env['LD_LIBRARY_PATH']}"
    done = subprocess.run(
        [program(installed, PACKAGE, name)],
        env=env,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (
        1,
        "",
        f"{PACKAGE} was built with {CPP_RUNTIME} {__version__}, but the loaded library has version "
        f"{OTHER_VERSION}: build the package again\n",
    )
