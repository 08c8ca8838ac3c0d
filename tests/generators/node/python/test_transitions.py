"""Transitions of managed nodes that fail, in either language."""

from __future__ import annotations

import signal
import subprocess
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

import pytest

from tests.support.cpp import needs_rclcpp
from tests.support.leavers import TRANSITIONS, CppLeaver, Leaver, PythonLeaver
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
"""The transitions that lead to where one starts."""


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(PythonLeaver, id="python"),
        pytest.param(CppLeaver, id="cpp", marks=needs_rclcpp),
    ],
)
def leaver(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Leaver:
    """Give the built package, in one language after the other."""
    built: Leaver = request.param(tmp_path_factory.mktemp("workspace"))
    return built


@pytest.fixture
def start(leaver: Leaver, ros_env: dict[str, str]) -> Start:
    """Give a function that runs the node, with a place that fails in some way."""

    def run(place: str, way: str) -> AbstractContextManager[subprocess.Popen[str]]:
        command, env = leaver.command(ros_env)
        settings = ("--ros-args", "-p", f"place:={place}", "-p", f"way:={way}")
        return running([*command, *settings], env)

    return run


class Client:
    """The test's end of the node."""

    def __init__(self, peer: Peer) -> None:
        """Open the ports; the node may come later."""
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
        node.create_subscription(Empty, "/echo", self._hear, 10)

    def _hear(self, _: Any) -> None:
        self.echoes += 1

    def change(self, name: str) -> bool:
        """Ask for a transition, and return whether it succeeded."""
        return bool(self.peer.call(self._change, self.request(name)).success)

    def request(self, name: str) -> Any:
        """Return the request for a transition; shutdown is that of an active node."""
        from lifecycle_msgs.msg import Transition

        label = {"shutdown": "ACTIVE_SHUTDOWN"}.get(name, name.upper())
        number = getattr(Transition, f"TRANSITION_{label}")
        return self._change_state.Request(transition=Transition(id=number))

    def send_change(self, name: str) -> None:
        """Ask for a transition, and do not wait for the answer."""
        self.peer.until(self._change.service_is_ready)
        self._change.call_async(self.request(name))

    def lead_to(self, place: str) -> None:
        """Bring the node to where a transition starts."""
        self.peer.until(lambda: self.peer.node.count_publishers("/echo"))
        for name in BEFORE[place]:
            assert self.change(name)

    def state(self) -> str:
        """Return the name of the node's state."""
        return str(self.peer.call(self._get, self._get_state.Request()).current_state.label)

    def poke(self) -> None:
        """Send a message once the node is there."""
        self.peer.until(self._poke.get_subscription_count)
        self._poke.publish(self._empty())

    def hear(self) -> None:
        """Wait for what the timer of the node publishes."""
        self.echoes = 0
        self.peer.until(lambda: self.echoes)

    def hear_nothing(self) -> None:
        """Check that neither the timer nor a service publishes, for ten periods of the timer."""
        self.peer.call(self._ask, self._trigger.Request())  # what was on its way has come
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
    """Give the test's end of the node."""
    return Client(ros_peer)


@pytest.mark.parametrize("place", TRANSITIONS)
@pytest.mark.parametrize("way", ["error", "ERROR"])
def test_a_transition_with_an_error_leaves_the_node_unconfigured(
    place: str, way: str, leaver: Leaver, start: Start, client: Client
) -> None:
    """What it throws is logged, the client learns of it, and the node rests and can go on."""
    with start(place, way) as process:
        client.lead_to(place)
        assert not client.change(place)
        assert client.state() == "unconfigured"
        client.hear_nothing()
        (mended,) = set_parameter(client.peer, "leaver", place="")
        assert mended.successful
        assert client.change("configure")
        assert client.change("activate")
        client.hear()
        code, output = stop(process, signal.SIGINT)
    assert code == 0, output
    assert way == "ERROR" or leaver.reasons["error"] in output


@pytest.mark.parametrize("place", TRANSITIONS)
@pytest.mark.parametrize("way", ["odd", "exit"])
def test_a_transition_can_end_the_program(
    place: str, way: str, leaver: Leaver, start: Start, client: Client
) -> None:
    """By what is no error of a transition: an interrupt, an exit, in C++ any other value."""
    with start(place, way) as process:
        client.lead_to(place)
        client.send_change(place)
        client.peer.until(lambda: process.poll() is not None)
        output, _ = process.communicate()
    assert process.returncode == leaver.codes[way], output
    assert leaver.reasons[way] in output


@pytest.mark.parametrize("place", ["topic", "timer"])
def test_a_handler_that_throws_ends_the_program(
    place: str, leaver: Leaver, start: Start, client: Client
) -> None:
    """A managed node that is active ends like any other: with 1 and the reason."""
    with start(place, "error") as process:
        client.lead_to("deactivate")
        if place == "topic":
            client.poke()
        output, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == 1, output
    assert leaver.reasons["error"] in output


@pytest.mark.parametrize(("place", "state"), [("activate", "inactive"), ("shutdown", "finalized")])
def test_a_node_that_is_not_active_rests(
    place: str, state: str, start: Start, client: Client
) -> None:
    """An activation that fails, and a shutdown amid all, leave nothing running."""
    with start(place, "failure") as process:
        client.lead_to(place)
        assert not client.change(place)
        assert client.state() == state
        client.hear_nothing()
        code, output = stop(process, signal.SIGINT)
    assert code == 0, output


def test_a_node_that_stays_active_goes_on(start: Start, client: Client) -> None:
    """A deactivation that fails changes nothing."""
    with start("deactivate", "failure") as process:
        client.lead_to("deactivate")
        assert not client.change("deactivate")
        assert client.state() == "active"
        client.hear()
        code, output = stop(process, signal.SIGINT)
    assert code == 0, output


def test_a_shutdown_leaves_nothing_running(start: Start, client: Client) -> None:
    """A node that is shut down while it is active rests."""
    with start("nowhere", "error") as process:
        client.lead_to("shutdown")
        client.hear()
        assert client.change("shutdown")
        assert client.state() == "finalized"
        client.hear_nothing()
        code, output = stop(process, signal.SIGINT)
    assert code == 0, output
