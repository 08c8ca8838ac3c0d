"""Unloading components while messages arrive: none is used after it is freed."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from deros.generators.output.writer import write
from deros.generators.safety_package.cpp.generate import generate as safety_package
from tests.support.containers import Loader, running_container
from tests.support.cpp import colcon_build, instrument, overlay, sanitized
from tests.support.generating import output_of
from tests.support.needs import needs
from tests.support.ros import Peer, stop

pytestmark = [pytest.mark.ros, needs("rclcpp"), needs("ros2", "c++")]

RULES = Path(__file__).resolve().parent / "models/base/robot.deros"
GATE = ("base_command_gate.cpp", "base_command_gate_message.cpp", "runtime/gate_runner.cpp")
NODE = ("base_safety_node.cpp", "runtime/safety_node_core.cpp", "runtime/ports.cpp")
TIMES = 20
"""Number of times that a component is loaded and unloaded; former errors showed within three."""


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return an install folder with a safety node and its gate that detect use of freed memory."""
    source = tmp_path_factory.mktemp("workspace")
    options = {"package": "base_safety", "node": "base_safety_node", "runtime": "copy"}
    write(output_of(safety_package, RULES, **options), source)
    package = source / "base_safety_cpp"
    instrument(package, "base_command_gate_cpp", [f"src/{each}" for each in GATE])
    instrument(package, "base_safety_node_cpp", [f"src/{each}" for each in NODE])
    return colcon_build(source)


@contextmanager
def flowing(*publish: Callable[[], Any]) -> Iterator[None]:
    """Publish continuously from another thread until the block ends."""
    over = threading.Event()

    def flow() -> None:
        while not over.wait(0.0005):
            for each in publish:
                each()

    thread = threading.Thread(target=flow)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


@pytest.mark.parametrize("plugin", ["BaseCommandGate", "BaseSafetyNode"])
@pytest.mark.parametrize("kind", ["component_container", "component_container_isolated"])
def test_unloading_under_load_is_safe(
    kind: str, plugin: str, installed: Path, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """A gate or safety node is loaded and unloaded many times while its topics are published."""
    from geometry_msgs.msg import Twist
    from std_msgs.msg import Float64

    commands: list[Any] = []
    beats: list[Any] = []
    node = ros_peer.node
    node.create_subscription(Twist, "/base/command", commands.append, 10)
    node.create_subscription(_beat(), "/base_safety_node/heartbeat", beats.append, 10)
    wish = node.create_publisher(Twist, "/base/wish", 10)
    speed = node.create_publisher(Float64, "/speed", 10)
    signs_of_life = commands if "Gate" in plugin else beats

    env = sanitized(overlay(installed, ros_env))
    with running_container(env, ros_peer, kind) as container:
        loader = Loader(ros_peer)
        with flowing(lambda: wish.publish(Twist()), lambda: speed.publish(Float64())):
            for _ in range(TIMES):
                if container.process.poll() is not None:
                    break
                number = loader.load("base_safety_cpp", f"base_safety_cpp::{plugin}")
                signs_of_life.clear()
                ros_peer.until(lambda: signs_of_life or container.process.poll() is not None)
                loader.unload(number)
        code, output = stop(container.process, signal.SIGINT)
    assert (code, "AddressSanitizer" in output) == (0, False), output


def _beat() -> Any:
    from std_msgs.msg import UInt64

    return UInt64
