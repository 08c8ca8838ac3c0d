"""Generated nodes as components of one process, and those who load and unload them there."""

from __future__ import annotations

import re
import shutil
import subprocess
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.support.ros import LIMIT, Peer, running

needs_ros2 = pytest.mark.skipif(shutil.which("ros2") is None, reason="no command ros2")

_NAME = "/box"


class LoadError(Exception):
    """A component does not load; the text says why."""


class Container:
    """A process that nodes are loaded into.

    Attributes:
        process: the container's process.
    """

    def __init__(self, process: subprocess.Popen[str], env: Mapping[str, str]) -> None:
        """Take a running container, and the environment in which its components are found."""
        self.process = process
        self._env = env

    def load(self, package: str, plugin: str, *options: str) -> str:
        """Load a component and return its number.

        Args:
            package: the package that provides it.
            plugin: its class.
            options: those of ``ros2 component load``, such as ``--node-name``.

        Raises:
            LoadError: if its constructor throws.
        """
        done = self._component("load", *options, _NAME, package, plugin)
        if "Failed to load" in done.stdout + done.stderr:
            raise LoadError(done.stdout + done.stderr)
        found = re.search(r"Loaded component (\d+)", done.stdout)
        assert found, done.stdout + done.stderr
        return found[1]

    def unload(self, number: str) -> None:
        """Unload a component; its node is destroyed when this returns."""
        done = self._component("unload", _NAME, number)
        assert done.returncode == 0, done.stdout + done.stderr

    def _component(self, verb: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run a command as soon as it has discovered the container."""
        command = ["ros2", "component", verb, "--no-daemon", "--spin-time", "1", *arguments]
        end = time.monotonic() + 2 * LIMIT
        while True:
            done = subprocess.run(
                command, env=self._env, capture_output=True, text=True, timeout=LIMIT, check=False
            )
            if "Unable to find" not in done.stderr or time.monotonic() > end:
                return done


@contextmanager
def running_container(
    env: Mapping[str, str], peer: Peer, kind: str = "component_container"
) -> Iterator[Container]:
    """Run an empty container, one of rclcpp_components' programs, that ends with the block.

    Args:
        env: the environment, in which the components are found.
        peer: hears when the container is there.
        kind: the name of the program.
    """
    name = f"lib/rclcpp_components/{kind}"
    (prefix,) = (p for p in env["AMENT_PREFIX_PATH"].split(":") if (Path(p) / name).exists())
    command = [f"{prefix}/{name}", "--ros-args", "-r", f"__node:={_NAME[1:]}"]
    with running(command, dict(env)) as process:
        peer.until(lambda: _serves(peer, f"{_NAME}/_container/load_node"))
        yield Container(process, env)


def _serves(peer: Peer, name: str) -> bool:
    return any(service == name for service, _ in peer.node.get_service_names_and_types())
