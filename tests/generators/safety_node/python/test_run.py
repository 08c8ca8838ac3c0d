"""The generated safety node on real middleware."""

from __future__ import annotations

import itertools
import signal
from collections.abc import Callable
from typing import Any

import pytest

from tests.support.ros import LIMIT, Peer
from tests.support.safety_node import Robot, Software, Start, end, result_of

pytestmark = pytest.mark.ros


@pytest.mark.essential
def test_violation_stops_the_robot_until_a_reset(start: Start, robot: Robot) -> None:
    """While the rule is violated, a reset is refused with the reason."""
    with start() as process:
        robot.meet()
        assert robot.stop[-1] is False
        robot.drive_until(0.9, lambda: robot.stop[-1])

        why = "stop stays active, called for by speeding (every_thing."
        robot.peer.until(lambda: robot.reset(0.9).message.startswith(why))
        assert robot.stop[-1]

        robot.peer.until(lambda: robot.reset(0.1).success)
        robot.peer.until(lambda: robot.stop[-1] is False)
        assert robot.reset().message == "no latched action was active"

        code, lines = end(process, robot)
    assert code == 0
    place = "speeding (every_thing.deros:28): drive.fast for 100 ms: speed 0.9 > 0.5 m/s"
    assert lines[0] == "watching 10 rules of every_thing.deros"
    assert f"stop, by {place}" in lines
    assert "speed limit exceeded, by speeding" in lines
    assert "stop is reset" in lines


def test_action_without_code_is_reported(start: Start, robot: Robot, node: Software) -> None:
    """The node lists it at the start, and again when it should act."""
    with start() as process:
        robot.meet()
        robot.drive_until(0.9, lambda: robot.stop[-1])
        code, lines = end(process, robot)
    file = node.actions_file
    assert code == 0
    assert f"action beep does nothing: write its code in {file}" in lines
    assert not any("action release" in line for line in lines)  # it only resets others
    assert (
        f"action beep(3, 'too fast') should have been carried out now: write its code in {file}"
        in lines
    )


def test_user_code_gets_the_arguments_of_the_rules(
    start: Start, robot: Robot, node: Software
) -> None:
    """A body written by the user is called with them."""
    node.fill_in("tell")
    with start() as process:
        robot.meet()
        robot.drive_until(0.9, lambda: robot.stop[-1])
        _, lines = end(process, robot)
    assert "beep 3 times: too fast" in lines
    assert not [line for line in lines if line.startswith("action beep")]


def test_failing_action_does_not_prevent_others(start: Start, robot: Robot, node: Software) -> None:
    """The other actions are executed, and then the node exits, so that its heartbeat stops."""
    node.fill_in("fail")
    with start() as process:
        robot.meet()
        robot.drive_until(0.9, lambda: robot.stop[-1])
        output, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == 1
    assert "action beep failed" in output
    assert "speed limit exceeded, by speeding" in output


def test_silent_sensor_acts_and_takeover_resets(start: Start, robot: Robot) -> None:
    """A deadline acts without a message; another action resets it once all causes are over."""
    with start() as process:
        robot.meet()
        robot.peer.until(lambda: robot.limit[-1] == 0.2)
        # A takeover may arrive before the causes are over and be refused; then it is repeated.
        modes = itertools.cycle([0, 1])

        def released() -> bool:
            robot.report_health()
            robot.take_over(next(modes))
            return robot.limit[-1] == 0.0

        robot.drive_until(0.1, released)
        code, lines = end(process, robot, signal.SIGINT)
    assert code == 0
    assert "crawl, by lost (every_thing.deros:29): drive.silent: speed.missing()" in lines
    assert "crawl is reset" in lines


def test_heartbeat_and_states_repeat_at_publish_freq(start: Start, robot: Robot) -> None:
    """Both are repeated, faster if the parameter says so."""
    with start("publish_freq:=100.0") as process:
        robot.meet()
        states, beats = len(robot.stop), len(robot.beats)
        robot.peer.until(lambda: len(robot.beats) >= beats + 20)
        # A state replaces the one before it if the receiver is late: some are never seen.
        robot.peer.until(lambda: len(robot.stop) >= states + 10)
        assert robot.beats == sorted(set(robot.beats))
        code, _ = end(process, robot)
    assert code == 0


class Simulation:
    """Publishes simulated time, which begins at 1000 s.

    Attributes:
        seconds: what it is.
    """

    def __init__(self, peer: Peer) -> None:
        """Publish nothing yet."""
        from rosgraph_msgs.msg import Clock  # type: ignore[import-untyped]

        self.seconds = 1000.0
        self._message = Clock
        self._peer = peer
        self._publisher = peer.node.create_publisher(Clock, "/clock", 10)

    def meet(self) -> None:
        """Wait until a node listens; rclcpp adds a subscription of its own."""
        self._peer.until(self._publisher.get_subscription_count)

    def tick(self, step: float) -> None:
        """Publish a time that is later, or earlier."""
        self.seconds += step
        message = self._message()
        message.clock.sec, message.clock.nanosec = int(self.seconds), int(self.seconds % 1 * 1e9)
        self._publisher.publish(message)

    def until(self, condition: Callable[[], Any]) -> None:
        """Let time pass until something happens."""

        def once() -> Any:
            self.tick(0.02)
            return condition()

        self._peer.until(once)


def test_simulated_time_may_step_and_start_late(start: Start, robot: Robot) -> None:
    """Deadlines follow /clock; it may start at any time, and a step back is reported."""
    simulation = Simulation(robot.peer)
    with start("use_sim_time:=true") as process:
        simulation.meet()
        robot.peer.until(lambda: robot.limit)
        robot.peer.until(lambda: "" in robot.statuses)
        assert "waits for /clock" in robot.statuses[""].message
        simulation.tick(0.0)
        begun = simulation.seconds
        simulation.until(lambda: robot.limit[-1] == 0.2)
        assert simulation.seconds >= begun + 0.5
        beats = len(robot.beats)
        simulation.tick(-500.0)
        simulation.until(lambda: len(robot.beats) > beats + 2)
        process.send_signal(signal.SIGTERM)
        code, lines = result_of(process)
    assert code == 0
    (step,) = [n for n, line in enumerate(lines) if line.startswith("the clock stepped back")]
    crawls = [n for n, line in enumerate(lines) if line.startswith("crawl, by lost")]
    # After the step the input is awaited again: no heartbeat before it is missing a second time.
    assert [n < step for n in crawls] == [True, False]


def test_what_came_before_simulated_time_counts(start: Start, robot: Robot) -> None:
    """What was sent only then, and acted upon, is not forgotten when /clock begins."""
    simulation = Simulation(robot.peer)

    def since(name: str) -> float:
        return int(robot.status(name).values["since_ns"]) / 1e9

    with start("use_sim_time:=true") as process:
        simulation.meet()

        def crawls() -> bool:
            robot.report_health(ill=True)
            return bool(robot.limit) and robot.limit[-1] == 0.2

        robot.peer.until(crawls)
        assert robot.event("trigger", action="crawl")["time_ns"] == "0"
        crawling, begun = len(robot.limit), simulation.seconds
        simulation.until(lambda: len(robot.beats) > 2)
        assert set(robot.limit[crawling:]) == {0.2}
        simulation.until(lambda: since("action crawl") and since("body.ill"))
        # A tick before the last discovery may be lost.
        assert begun <= since("action crawl") == since("body.ill") <= simulation.seconds
        process.send_signal(signal.SIGTERM)
        code, _ = result_of(process)
    assert code == 0
