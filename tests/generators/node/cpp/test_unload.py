"""Unloading a component with running goals: none uses the node after it is freed."""

from __future__ import annotations

import signal
from pathlib import Path
from typing import Any

import pytest

from tests.support.breakers import cpp_breaker
from tests.support.containers import Loader, running_container
from tests.support.cpp import colcon_build, instrument, overlay, sanitized
from tests.support.needs import needs
from tests.support.preload import Threads
from tests.support.ros import Peer, stop

pytestmark = [pytest.mark.ros, needs("rclcpp"), needs("ros2", "c++")]

SOURCES = ("src/breaker.cpp", "src/breaker_base.cpp", "src/runtime/goal_threads.cpp")
TIMES = 10


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return an install folder with a node that detects use of freed memory."""
    source = cpp_breaker(tmp_path_factory.mktemp("workspace"))
    instrument(source / "breaking", "breaker", SOURCES)
    return colcon_build(source)


@pytest.mark.parametrize(
    "kind", ["component_container", "component_container_isolated", "component_container_mt"]
)
def test_goals_of_an_unloaded_node_are_aborted(
    kind: str, installed: Path, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """The node is destroyed only after its goals have returned."""
    from rclpy.action.client import ActionClient
    from test_msgs.action import Fibonacci

    client = ActionClient(ros_peer.node, Fibonacci, "count")
    feedback: list[Any] = []
    env = sanitized(overlay(installed, ros_env))
    with running_container(env, ros_peer, kind) as container:
        loader = Loader(ros_peer)

        def send_goal() -> None:
            sent = client.send_goal_async(Fibonacci.Goal(order=5), feedback.append)
            ros_peer.until(sent.done)
            assert sent.result().accepted

        for _ in range(TIMES):
            number = loader.load("breaking", "breaking::Breaker")
            ros_peer.until(client.server_is_ready)
            for _ in range(3):
                send_goal()
            feedback.clear()
            ros_peer.until(lambda: feedback)
            loader.unload(number)
            ros_peer.until(
                lambda: (
                    not ros_peer.node.count_publishers("/echo")
                    or container.process.poll() is not None
                )
            )
        loader.load("breaking", "breaking::Breaker")
        ros_peer.until(client.server_is_ready)
        feedback.clear()
        send_goal()
        ros_peer.until(lambda: feedback)  # rclcpp throws if it is shut down while it accepts one
        code, output = stop(container.process, signal.SIGINT)
    client.destroy()
    assert (code, "AddressSanitizer" in output) == (0, False), output


@needs("gcc")
def test_goals_are_aborted_after_one_that_got_no_thread(
    installed: Path, ros_env: dict[str, str], ros_peer: Peer, tmp_path: Path
) -> None:
    """The one is aborted at once; the node knows of the others that they alone own it."""
    from action_msgs.msg import GoalStatus
    from rclpy.action.client import ActionClient
    from test_msgs.action import Fibonacci

    client = ActionClient(ros_peer.node, Fibonacci, "count")
    feedback: list[Any] = []

    def goal() -> Any:
        sent = client.send_goal_async(Fibonacci.Goal(order=5), feedback.append)
        ros_peer.until(sent.done)
        assert sent.result().accepted
        return sent.result().get_result_async()

    threads = Threads(tmp_path)
    env = sanitized(overlay(installed, ros_env))
    env |= {**threads.env, "LD_PRELOAD": f"{env['LD_PRELOAD']}:{threads.env['LD_PRELOAD']}"}
    with running_container(env, ros_peer) as container:
        loader = Loader(ros_peer)
        number = loader.load("breaking", "breaking::Breaker")
        ros_peer.until(client.server_is_ready)
        with threads.refused():
            refused = goal()
            ros_peer.until(refused.done)
        assert refused.result().status == GoalStatus.STATUS_ABORTED
        assert not feedback
        running = goal()
        ros_peer.until(lambda: feedback)
        assert not running.done()
        loader.unload(number)
        ros_peer.until(lambda: not ros_peer.node.count_publishers("/echo"))
        code, output = stop(container.process, signal.SIGINT)
    client.destroy()
    assert (code, "AddressSanitizer" in output) == (0, False), output
    assert output.count("no thread for a goal") == 1, output
