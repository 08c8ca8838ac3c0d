"""Failing user code, many goals, and termination with running goals, in either language."""

from __future__ import annotations

import signal
import subprocess
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from typing import Any

import pytest

from tests.support.breakers import STUBBORN, USUAL, Breaker, CppBreaker, PythonBreaker
from tests.support.needs import needs
from tests.support.profiles import slow
from tests.support.ros import Peer, running, set_parameter, stop

pytestmark = pytest.mark.ros

Start = Callable[..., AbstractContextManager["subprocess.Popen[str]"]]
WAYS = ("error", "odd", "exit")
PLACES = ("constructor", "topic", "timer", "service", "parameters", "accept", "cancel", "execute")
ORDINARY = 5


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(PythonBreaker, id="python"),
        pytest.param(CppBreaker, id="cpp", marks=needs("rclcpp")),
    ],
)
def breaker(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Breaker:
    """Return the built package, in each language."""
    built: Breaker = request.param(tmp_path_factory.mktemp("workspace"))
    return built


@pytest.fixture
def start(breaker: Breaker, ros_env: dict[str, str]) -> Start:
    """Return a function that runs the node with parameters."""

    def run(**parameters: str) -> AbstractContextManager[subprocess.Popen[str]]:
        command, env = breaker.command(ros_env)
        settings = [("-p", f"{name}:={value}") for name, value in parameters.items()]
        arguments = ["--ros-args", *(word for setting in settings for word in setting)]
        return running([*command, *arguments], env)

    return run


class Client:
    """The test's client of the node."""

    def __init__(self, peer: Peer) -> None:
        """Open the ports; the node may start later."""
        from rclpy.action.client import ActionClient
        from std_msgs.msg import Empty
        from std_srvs.srv import Trigger
        from test_msgs.action import Fibonacci

        self.peer, self._fibonacci, self._empty, self._trigger = peer, Fibonacci, Empty, Trigger
        self.echoes = 0
        self.actions = ActionClient(peer.node, Fibonacci, "count")
        self._ask = peer.node.create_client(Trigger, "ask")
        self._poke = peer.node.create_publisher(Empty, "poke", 10)
        peer.node.create_subscription(Empty, "echo", self._receive, 10)

    def _receive(self, _: Any) -> None:
        self.echoes += 1

    def send_message(self) -> None:
        """Send a message once the node is discovered."""
        self.peer.until(self._poke.get_subscription_count)
        self._poke.publish(self._empty())

    def ask(self) -> Any:
        """Send a request once the node is discovered, and return the future."""
        self.peer.until(self._ask.service_is_ready)
        return self._ask.call_async(self._trigger.Request())

    def send_goal(self, order: int = ORDINARY) -> Any:
        """Send a goal once the node is discovered, and return the goal handle."""
        self.peer.until(self.actions.server_is_ready)
        future = self.actions.send_goal_async(self._fibonacci.Goal(order=order))
        self.peer.until(future.done)
        return future.result()


@pytest.fixture
def client(ros_peer: Peer) -> Iterator[Client]:
    """Return the test's client of the node."""
    opened = Client(ros_peer)
    yield opened
    opened.actions.destroy()


# Failing code -------------------------------------------------------------------------------------


@pytest.mark.parametrize("way", [WAYS[0], *map(slow, WAYS[1:])])
@pytest.mark.parametrize("place", PLACES)
def test_failing_user_code_ends_the_program_with_the_reason(
    place: str, way: str, breaker: Breaker, start: Start, client: Client
) -> None:
    """The exit code is that of a failure, and the reason is printed; a goal is only aborted."""
    from action_msgs.msg import GoalStatus

    given = "" if place == "parameters" else place
    with start(place=given or "none", way=way) as process:
        result: Any = None
        if place == "topic":
            client.send_message()
        elif place == "service":
            client.ask()
        elif place == "parameters":
            client.peer.until(client.actions.server_is_ready)
            _set_at_once(client.peer, place)
        elif place in ("accept", "cancel", "execute"):
            client.peer.until(client.actions.server_is_ready)
            sent = client.actions.send_goal_async(_goal())
            if place != "accept":
                client.peer.until(sent.done)
                result = sent.result().get_result_async()
            if place == "cancel":
                sent.result().cancel_goal_async()
        if place == "execute" and way in breaker.goes_on:
            client.peer.until(result.done)
            assert result.result().status == GoalStatus.STATUS_ABORTED
            code, output = stop(process, signal.SIGINT)
            assert code == 0, output
        else:
            client.peer.until(lambda: process.poll() is not None)
            output, _ = process.communicate()
            assert process.returncode == breaker.codes[way], output
    assert breaker.reasons[way] in output


def _goal() -> Any:
    from test_msgs.action import Fibonacci

    return Fibonacci.Goal(order=ORDINARY)


def _set_at_once(peer: Peer, place: str) -> None:
    """Set the place without waiting for the response, which does not arrive."""
    from rcl_interfaces.srv import SetParameters
    from rclpy.parameter import Parameter

    client = peer.node.create_client(SetParameters, "/breaker/set_parameters")
    peer.until(client.service_is_ready)
    wanted = [Parameter("place", value=place).to_parameter_msg()]
    client.call_async(SetParameters.Request(parameters=wanted))


@needs("rclcpp")
@pytest.mark.parametrize("way", WAYS)
def test_failing_destructor_ends_the_program_with_the_reason(
    way: str, breaker: Breaker, start: Start, client: Client
) -> None:
    """An exception from a destructor cannot be caught, but the reason is printed."""
    if not isinstance(breaker, CppBreaker):
        pytest.skip("Python has no destructors")
    with start(place="destructor", way=way) as process:
        client.peer.until(client.actions.server_is_ready)
        code, output = stop(process, signal.SIGINT)
    assert (code, breaker.reasons[way] in output) == (1, True), output


# Goals --------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_goals_delay_neither_messages_nor_cancel_requests(start: Start, client: Client) -> None:
    """Even with the maximum number of goals, all other requests are served while these run."""
    from action_msgs.msg import GoalStatus

    peer = client.peer
    with start() as process:
        goals = [client.send_goal() for _ in range(4)]
        assert all(goal.accepted for goal in goals)
        results = [goal.get_result_async() for goal in goals]
        client.send_message()
        peer.until(lambda: client.echoes)
        (changed,) = set_parameter(peer, "breaker", knob=1.0)
        assert changed.successful
        assert not client.send_goal().accepted
        assert not any(result.done() for result in results)
        goals[0].cancel_goal_async()
        peer.until(results[0].done)
        assert [result.done() for result in results] == [True, False, False, False]
        assert results[0].result().status == GoalStatus.STATUS_CANCELED
        # The thread of the goal ends after its result is published.
        peer.until(lambda: client.send_goal().accepted)
        code, output = stop(process, signal.SIGINT)
    assert code == 0, output
    assert "goal of count rejected: 4 goals are in execution" in output


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("order", [ORDINARY, USUAL])
def test_termination_aborts_goals(
    order: int, number: signal.Signals, start: Start, client: Client
) -> None:
    """A signal during goals ends the node without an error, and clients learn of the abort."""
    from action_msgs.msg import GoalStatus

    with start() as process:
        goals = [client.send_goal(order) for _ in range(3)]
        results = [goal.get_result_async() for goal in goals]
        process.send_signal(number)
        client.peer.until(lambda: process.poll() is not None)
        output, _ = process.communicate()
        assert process.returncode == 0, output
        if order == ORDINARY:
            client.peer.until(lambda: all(result.done() for result in results))
            assert {r.result().status for r in results} == {GoalStatus.STATUS_ABORTED}
    for sign in ("terminate", "Traceback", "ERROR", "FATAL"):
        assert sign not in output


def test_goal_that_does_not_return_is_abandoned(start: Start, client: Client) -> None:
    """The program ends anyway, and reports the running goal."""
    with start() as process:
        assert client.send_goal(STUBBORN).accepted
        code, output = stop(process, signal.SIGINT)
    assert code == 0, output
    assert "ends in the middle of a goal, which does not return" in output
