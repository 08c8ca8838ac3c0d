"""Generated packages that depend on the package ``deros_runtime``, built by the real colcon."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from deros import __version__
from tests.support.builds import colcon, models, replace, touch
from tests.support.built_interfaces import TRANSFORMS, known
from tests.support.cli import deros
from tests.support.needs import needs
from tests.support.ros import Peer, running

pytestmark = needs("sh")  # that colcon runs

OTHER = "0.0.10"
"""Another version; of another length, or Python might run the module that it compiled before."""

REFUSAL = f"robot_safety was generated for deros_runtime {__version__}, but {OTHER} is installed"


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the runtime and a safety package that depends on it, once."""
    workspace = tmp_path_factory.mktemp("runtime")
    rules = models(workspace / "models")
    _generate(rules, workspace / "src")
    assert not list(workspace.glob("src/robot_safety/**/process.py"))
    done = colcon(workspace, "--packages-up-to", "robot_safety")
    assert done.returncode == 0, done.stdout
    return workspace


def _generate(rules: Path, source: Path) -> None:
    """Write the safety package and its runtime into the source folder of a workspace."""
    outcome = deros("generate", rules, "--target", "python", "-o", source)
    assert outcome.code == 0, outcome.err


def _program(workspace: Path, name: str) -> list[str]:
    """Return the command that runs an installed program, as a user would."""
    program = workspace / "install/robot_safety/lib/robot_safety" / name
    return ["sh", "-c", f". '{workspace}/install/setup.sh'; exec '{program}'"]


@contextmanager
def _another_version(folder: Path) -> Iterator[None]:
    """Give the runtime in a folder another version for a while.

    Modification times are restored too: setuptools installs only files newer than the installed
    ones.
    """
    (module,) = folder.glob("**/deros_runtime/__init__.py")
    ours, other = f"__version__ = '{__version__}'", f"__version__ = '{OTHER}'"
    before = module.stat()
    replace(module, ours, other)
    try:
        yield
    finally:
        replace(module, other, ours)
        os.utime(module, ns=(before.st_atime_ns, before.st_mtime_ns))


@needs("gcc")
@pytest.mark.parametrize(
    ("name", "refusal"),
    [
        ("load_monitor", "parameter 'node' has to name the node whose load is measured\n"),
        ("transform_monitor", "parameter 'parent' has to name a frame\n"),
    ],
    ids=["load", "transform"],
)
def test_monitors_are_programs_of_the_runtime_package(
    workspace: Path,
    ros_env: dict[str, str],
    tmp_path: Path,
    name: str,
    refusal: str,
) -> None:
    """They are where ``ros2 run`` and launch files look for them, and run."""
    program = workspace / f"install/deros_runtime/lib/deros_runtime/{name}"
    command = ["sh", "-c", f". '{workspace}/install/setup.sh'; exec '{program}'"]
    with known(TRANSFORMS, tmp_path) as variables:
        done = subprocess.run(
            command,
            env=ros_env | variables,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
    assert (done.returncode, done.stderr) == (1, refusal)


@pytest.mark.slow
@pytest.mark.ros
def test_safety_node_runs_with_the_runtime_package(
    workspace: Path, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """Its heartbeat arrives, from a package without a copy of the runtime."""
    from std_msgs.msg import UInt64

    beats: list[int] = []
    ros_peer.node.create_subscription(
        UInt64, "/robot_safety_node/heartbeat", lambda msg: beats.append(msg.data), 1
    )
    with running(_program(workspace, "robot_safety_node"), ros_env):
        ros_peer.until(lambda: beats)


@pytest.mark.ros
def test_node_does_not_start_with_another_version(workspace: Path, ros_env: dict[str, str]) -> None:
    """It names both versions and exits with 1 before it creates a ROS node."""
    for program in ("robot_safety_node", "cmd_vel_gate"):
        with _another_version(workspace / "install/deros_runtime"):
            ended = subprocess.run(
                _program(workspace, program),
                env=ros_env,
                capture_output=True,
                text=True,
                timeout=60,
                check=False,
            )
        assert ended.returncode == 1
        assert REFUSAL in ended.stderr.splitlines()[-1]
        assert "watching" not in ended.stdout + ended.stderr


@pytest.mark.slow
def test_build_without_the_runtime_fails(tmp_path: Path) -> None:
    """The error names the missing package."""
    source = tmp_path / "src"
    _generate(models(tmp_path / "models"), source)
    (source / "deros_runtime/COLCON_IGNORE").touch()
    done = colcon(tmp_path, "--packages-up-to", "robot_safety")
    assert done.returncode != 0
    assert "cannot build robot_safety: No module named 'deros_runtime'" in done.stdout


@pytest.mark.slow
def test_package_generated_during_the_build_checks_the_version(tmp_path: Path) -> None:
    """The scaffolded setup.py contains the option."""
    source = tmp_path / "src"
    rules = models(source / "safety/models")
    assert deros("runtime", source).code == 0
    options = ("--target", "python", "--runtime", "package")
    outcome = deros("generate", rules, *options, "--scaffold", source / "safety")
    assert outcome.code == 0, outcome.err
    assert "options={'runtime': 'package'}" in (source / "safety/setup.py").read_text()
    with _another_version(source):
        done = colcon(tmp_path, "--packages-up-to", "robot_safety")
    assert done.returncode != 0
    assert f"cannot build robot_safety: {REFUSAL}" in done.stdout
    touch(source / "deros_runtime/deros_runtime/__init__.py")
    done = colcon(tmp_path, "--packages-up-to", "robot_safety")
    assert done.returncode == 0, done.stdout
    assert not list((tmp_path / "install/robot_safety").rglob("process.py"))


def test_build_with_another_version_fails(workspace: Path) -> None:
    """The output of colcon has both versions, and the remedy.

    It runs last, because it leaves another version installed.
    """
    with _another_version(workspace / "src"):
        done = colcon(workspace, "--packages-up-to", "robot_safety")
    assert done.returncode != 0
    assert f"cannot build robot_safety: {REFUSAL}" in done.stdout
    assert "Traceback" not in done.stdout
