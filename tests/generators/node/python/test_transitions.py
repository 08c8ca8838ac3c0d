"""Failing transitions of lifecycle nodes, in either language."""

from __future__ import annotations

import signal
import subprocess
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

import pytest

from tests.support.leavers import TRANSITIONS, CppLeaver, Leaver, PythonLeaver
from tests.support.needs import needs
from tests.support.profiles import slow
from tests.support.ros import LIMIT, Peer, running, set_parameter, stop

pytestmark = pytest.mark.ros

Start = Callable[..., AbstractContextManager["subprocess.Popen[str]"]]
BEFORE = {
    "configure": (),
    "activate": ("configure",),
    "deactivate": ("configure", "activate"),
    "cleanup": ("configure",),
    "shutdown": ("configure", "activate"),
}
"""The transitions that lead to the start state of each transition."""


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(PythonLeaver, id="python"),
        pytest.param(CppLeaver, id="cpp", marks=needs("rclcpp")),
    ],
)
def leaver(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Leaver:
    """Return the built package, in each language."""
    built: Leaver = request.param(tmp_path_factory.mktemp("workspace"))
    return built


@pytest.fixture
def start(leaver: Leaver, ros_env: dict[str, str]) -> Start:
    """Return a function that runs the node with a place that fails in some way."""

    def run(place: str, way: str) -> AbstractContextManager[subprocess.Popen[str]]:
        command, env = leaver.command(ros_env)
        settings = ("--ros-args", "-p", f"place:={place}", "-p", f"way:={way}")
        return running([*command, *settings], env)

    return run


class Client:
    """The test's client of the node."""

    def __init__(self, peer: Peer) -> None:
        """Open the ports; the node may start later."""
        from lifecycle_msgs.srv import ChangeState, GetState
        from std_msgs.msg import Empty
        from std_srvs.srv import Trigger

        self.peer, self.echoes = peer, 0
        self._change_state, self._get_state = ChangeState, GetState
        self._trigger, self._empty = Trigger, Empty
        node = peer.node
        self._change = node.create_client(ChangeState, "/leaver/change_state")
        self._get = node.create_client(GetState, "/leaver/get_state")
        self._ask = node.create_client(Trigger, "/ask")
        self._poke = node.create_publisher(Empty, "/poke", 10)
        node.create_subscription(Empty, "/echo", self._receive, 10)

    def _receive(self, _: Any) -> None:
        self.echoes += 1

    def change(self, name: str) -> bool:
        """Request a transition, and return whether it succeeded."""
        return bool(self.peer.call(self._change, self.request(name)).success)

    def request(self, name: str) -> Any:
        """Return the request for a transition; shutdown is that of an active node."""
        from lifecycle_msgs.msg import Transition

        label = {"shutdown": "ACTIVE_SHUTDOWN"}.get(name, name.upper())
        number = getattr(Transition, f"TRANSITION_{label}")
        return self._change_state.Request(transition=Transition(id=number))

    def send_change(self, name: str) -> None:
        """Request a transition, without waiting for the response."""
        self.peer.until(self._change.service_is_ready)
        self._change.call_async(self.request(name))

    def lead_to(self, place: str) -> None:
        """Bring the node to the start state of a transition."""
        self.peer.until(lambda: self.peer.node.count_publishers("/echo"))
        for name in BEFORE[place]:
            assert self.change(name)

    def state(self) -> str:
        """Return the name of the node's state."""
        return str(self.peer.call(self._get, self._get_state.Request()).current_state.label)

    def send_message(self) -> None:
        """Send a message once the node is discovered."""
        self.peer.until(self._poke.get_subscription_count)
        self._poke.publish(self._empty())

    def await_message(self) -> None:
        """Wait for a message from the timer of the node."""
        self.echoes = 0
        self.peer.until(lambda: self.echoes)

    def assert_silent(self) -> None:
        """Check that neither the timer nor a service publishes, for ten periods of the timer."""
        self.peer.call(self._ask, self._trigger.Request())  # messages in transit have arrived
        self.echoes = periods = 0

        def count() -> None:
            nonlocal periods
            periods += 1

        timer = self.peer.node.create_timer(0.02, count)
        self.peer.call(self._ask, self._trigger.Request())
        self.peer.until(lambda: periods >= 10)
        self.peer.node.destroy_timer(timer)
        assert self.echoes == 0


@pytest.fixture
def client(ros_peer: Peer) -> Client:
    """Return the test's client of the node."""
    return Client(ros_peer)


@pytest.mark.parametrize("place", TRANSITIONS)
@pytest.mark.parametrize("way", ["error", slow("ERROR")])
def test_transition_with_an_error_leaves_the_node_unconfigured(
    place: str, way: str, leaver: Leaver, start: Start, client: Client
) -> None:
    """The error is logged, the client learns of it, and the node is idle and can be configured."""
    with start(place, way) as process:
        client.lead_to(place)
        assert not client.change(place)
        assert client.state() == "unconfigured"
        client.assert_silent()
        (mended,) = set_parameter(client.peer, "leaver", place="")
        assert mended.successful
        assert client.change("configure")
        assert client.change("activate")
        client.await_message()
        code, output = stop(process, signal.SIGINT)
    assert code == 0, output
    assert way == "ERROR" or leaver.reasons["error"] in output


@pytest.mark.parametrize("place", TRANSITIONS)
@pytest.mark.parametrize("way", [slow("odd"), "exit"])
def test_transition_may_end_the_program(
    place: str, way: str, leaver: Leaver, start: Start, client: Client
) -> None:
    """Exceptions that are not transition errors do: interrupts, exits, in C++ any other value."""
    with start(place, way) as process:
        client.lead_to(place)
        client.send_change(place)
        client.peer.until(lambda: process.poll() is not None)
        output, _ = process.communicate()
    assert process.returncode == leaver.codes[way], output
    assert leaver.reasons[way] in output


@pytest.mark.parametrize("place", ["topic", "timer"])
def test_throwing_handler_ends_the_program(
    place: str, leaver: Leaver, start: Start, client: Client
) -> None:
    """An active lifecycle node ends like any other: with 1 and the reason."""
    with start(place, "error") as process:
        client.lead_to("deactivate")
        if place == "topic":
            client.send_message()
        output, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == 1, output
    assert leaver.reasons["error"] in output


@pytest.mark.parametrize(("place", "state"), [("activate", "inactive"), ("shutdown", "finalized")])
def test_inactive_node_is_idle(place: str, state: str, start: Start, client: Client) -> None:
    """After a failed activation, or a shutdown at work, nothing runs."""
    with start(place, "failure") as process:
        client.lead_to(place)
        assert not client.change(place)
        assert client.state() == state
        client.assert_silent()
        code, output = stop(process, signal.SIGINT)
    assert code == 0, output


def test_failed_deactivation_changes_nothing(start: Start, client: Client) -> None:
    """The node stays active and continues."""
    with start("deactivate", "failure") as process:
        client.lead_to("deactivate")
        assert not client.change("deactivate")
        assert client.state() == "active"
        client.await_message()
        code, output = stop(process, signal.SIGINT)
    assert code == 0, output


def test_shutdown_leaves_nothing_running(start: Start, client: Client) -> None:
    """A node that is shut down while active is idle."""
    with start("nowhere", "error") as process:
        client.lead_to("shutdown")
        client.await_message()
        assert client.change("shutdown")
        assert client.state() == "finalized"
        client.assert_silent()
        code, output = stop(process, signal.SIGINT)
    assert code == 0, output
