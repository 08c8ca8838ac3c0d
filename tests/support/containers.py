"""Generated nodes as components of one process, and those who load and unload them there."""

from __future__ import annotations

import re
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.support.ros import LIMIT, Peer, running

_NAME = "/box"


class LoadError(Exception):
    """A component does not load; the text says why."""


class Container:
    """A process that nodes are loaded into.

    Attributes:
        process: the container's process.
    """

    def __init__(self, process: subprocess.Popen[str], env: dict[str, str], peer: Peer) -> None:
        """Take a running container, the environment of its components, and who waits for them."""
        self.process = process
        self._env = env
        self._peer = peer

    def load(self, package: str, plugin: str, *options: str) -> str:
        """Load a component and return its number.

        Args:
            package: the package that provides it.
            plugin: its class.
            options: those of ``ros2 component load``, such as ``--node-name``.

        Raises:
            LoadError: if its constructor throws.
        """
        _, output = self._component("load", *options, _NAME, package, plugin)
        if "Failed to load" in output:
            raise LoadError(output)
        found = re.search(r"Loaded component (\d+)", output)
        assert found, output
        return found[1]

    def unload(self, number: str) -> None:
        """Unload a component; its node is destroyed when this returns."""
        code, output = self._component("unload", _NAME, number)
        assert code == 0, output

    def _component(self, verb: str, *arguments: str) -> tuple[int, str]:
        """Run a command as soon as it has discovered the container, and return code and output.

        The peer receives messages meanwhile.
        """
        command = ["ros2", "component", verb, "--no-daemon", "--spin-time", "1", *arguments]
        end = time.monotonic() + 2 * LIMIT
        while True:
            with running(command, self._env) as process:
                self._peer.until(lambda: process.poll() is not None)
                output, _ = process.communicate()
            if "Unable to find" not in output or time.monotonic() > end:
                return process.returncode, output


@contextmanager
def running_container(
    env: dict[str, str], peer: Peer, kind: str = "component_container"
) -> Iterator[Container]:
    """Run an empty container, one of rclcpp_components' programs, that ends with the block.

    Args:
        env: the environment, in which the components are found.
        peer: waits for the container.
        kind: the name of the program.
    """
    name = f"lib/rclcpp_components/{kind}"
    (prefix,) = (p for p in env["AMENT_PREFIX_PATH"].split(":") if (Path(p) / name).exists())
    command = [f"{prefix}/{name}", "--ros-args", "-r", f"__node:={_NAME[1:]}"]
    with running(command, env) as process:
        peer.until(lambda: _serves(peer, f"{_NAME}/_container/load_node"))
        yield Container(process, env, peer)


class Loader:
    """Loads and unloads the components of a running container by its services, without a delay."""

    def __init__(self, peer: Peer) -> None:
        """Find the services of the container."""
        from composition_interfaces.srv import LoadNode, UnloadNode

        self._peer, self._load, self._unload = peer, LoadNode, UnloadNode
        node = peer.node
        self._loading = node.create_client(LoadNode, f"{_NAME}/_container/load_node")
        self._unloading = node.create_client(UnloadNode, f"{_NAME}/_container/unload_node")

    def load(self, package: str, plugin: str) -> int:
        """Load a component and return its number.

        Raises:
            LoadError: if its constructor throws.
        """
        request = self._load.Request(package_name=package, plugin_name=plugin)
        response = self._peer.call(self._loading, request)
        if not response.success:
            raise LoadError(response.error_message)
        return int(response.unique_id)

    def unload(self, number: int) -> None:
        """Unload a component."""
        response = self._peer.call(self._unloading, self._unload.Request(unique_id=number))
        assert response.success, response.error_message


def _serves(peer: Peer, name: str) -> bool:
    return any(service == name for service, _ in peer.node.get_service_names_and_types())
