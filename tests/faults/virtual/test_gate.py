"""A gate whose inputs fall silent, return or lie, in virtual time."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import Any

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.qos import DurabilityPolicy, QoSProfile

from tests.support.faults import GATE, NODE
from tests.support.played import COMMAND, COMMANDER, SENSES, TOPICS, button, command, load, speed
from tests.support.virtual_graph import VirtualNode
from tests.support.virtual_robot import HEARTBEAT, Seen, Sensors, VirtualRobot, ns

LOST_HEARTBEAT, LOST_INPUT = ns(0.3), ns(0.5)
"""Times after which the gate considers heartbeat or input lost; see the rules."""

PERIOD = ns(0.05)
LIMIT = 0.1
"""The speed to which the gate limits commands while the arm is overloaded."""


@pytest.fixture
def gate(robot: VirtualRobot, node: VirtualNode) -> VirtualNode:
    """Return the running gate."""
    assert node.is_running
    return robot.start(GATE)


@pytest.fixture
def sensors(robot: VirtualRobot, gate: VirtualNode) -> Sensors:
    """Return the sensors of a robot that drives."""
    assert gate.is_running
    sensors = robot.sensors()
    sensors.drive()
    until_driving(robot)
    return sensors


def until_driving(robot: VirtualRobot) -> None:
    """Wait until commands pass, for good."""
    robot.until(lambda: len(robot.commands) > 9 and {c.value for c in robot.commands[-9:]} == {0.4})


def first_zero(robot: VirtualRobot) -> int:
    """Return when the next zero reaches the drive; until then there are only commands."""
    before = len(robot.commands)
    robot.until(lambda: robot.commands[-1].value == 0.0)
    assert {each.value for each in robot.commands[before:-1]} <= {COMMAND}
    return robot.commands[-1].at


def assert_zeros(robot: VirtualRobot, seconds: float = 1.0) -> None:
    """Assert that the drive gets zeros for a time: at once, or at the rate without gaps."""
    before = len(robot.commands)
    robot.run(seconds)
    zeros = robot.commands[before - 1 :]
    assert {each.value for each in zeros} == {0.0}
    gaps = [after.at - earlier.at for earlier, after in pairwise(zeros)]
    assert max(gaps) <= PERIOD
    assert robot.now - zeros[-1].at < PERIOD


def hang(_robot: VirtualRobot, node: VirtualNode) -> None:
    """Let a node hang."""
    node.freeze()


@pytest.mark.parametrize("fault", [VirtualRobot.kill, hang])
def test_dead_or_hung_safety_node_stops_the_robot(
    robot: VirtualRobot,
    node: VirtualNode,
    sensors: Sensors,
    fault: Callable[[VirtualRobot, VirtualNode], None],
) -> None:
    """The zero comes 0.3 s after the last heartbeat, and zeros follow; a new node takes over."""
    robot.run(0.077)
    fault(robot, node)
    assert sensors.is_running
    assert first_zero(robot) == robot.beats[-1].at + LOST_HEARTBEAT
    assert_zeros(robot)
    if fault is hang:
        node.thaw()
    else:
        robot.start()
    until_driving(robot)


@pytest.mark.usefixtures("sensors")
def test_restarted_node_counts_once_the_dead_one_is_forgotten(
    robot: VirtualRobot, node: VirtualNode
) -> None:
    """Until the lease of the killed node ends, the heartbeat has two publishers."""
    robot.kill(node, lease=5.0)
    ends = robot.now + ns(5.0)
    first_zero(robot)
    again = robot.start()
    assert_zeros(robot, 4.6)
    assert again.is_running
    until_driving(robot)
    assert robot.now > ends


def test_gate_without_a_safety_node_commands_zero(robot: VirtualRobot) -> None:
    """Started alone, it lets no command pass, from the first instant on."""
    sensors = robot.sensors()
    sensors.drive()
    began = robot.now
    robot.start(GATE)
    robot.run(0.001)
    assert robot.commands[0] == Seen(0.0, began)
    assert_zeros(robot, 5.0)


def test_heartbeat_alone_opens_nothing(robot: VirtualRobot) -> None:
    """Of a node that never publishes its states, nothing is known."""
    robot.start(GATE)
    sensors = robot.sensors(COMMANDER)
    sensors.drive()
    beating = impostor(robot, NODE)
    beating.play("heartbeat")
    robot.run(0.5)
    assert_zeros(robot)


@pytest.mark.usefixtures("gate")
@pytest.mark.parametrize("fault", ["kill", "freeze", "quiet"])
def test_dead_or_hung_controller_is_followed_by_zeros(robot: VirtualRobot, fault: str) -> None:
    """Without a command for 0.5 s the drive gets zeros, even if no sensor is missing."""
    senses, commander = robot.sensors(SENSES), robot.sensors(COMMANDER)
    senses.drive()
    commander.drive()
    until_driving(robot)
    robot.run(0.021)
    if fault == "quiet":
        commander.quiet("/cmd_vel_nav")
    else:
        getattr(commander, fault)()
    assert first_zero(robot) == commander.last["/cmd_vel_nav"] + LOST_INPUT
    assert_zeros(robot)
    assert not robot.is_active("/halt")
    again = robot.sensors(COMMANDER)
    again.drive()
    until_driving(robot)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_command_that_is_not_finite_counts_as_lost_input(
    robot: VirtualRobot, sensors: Sensors, bad: float
) -> None:
    """A zero comes at once and no NaN passes; the next good command does."""
    sensors.play("/cmd_vel_nav", command(bad), rate=20.0)
    assert first_zero(robot) == sensors.last["/cmd_vel_nav"]
    assert_zeros(robot)
    sensors.play("/cmd_vel_nav", command(), rate=20.0)
    until_driving(robot)
    robot.run(1.1)
    values = {each.key: each.value for each in robot.statuses[GATE].values}
    assert int(values["refused"]) >= 20
    assert "a NaN or an infinite number" in values["refused_last"]


@pytest.mark.parametrize("data", [b"", b"\x00\x01\x00\x00", b"\x00\x01\x00\x00" + bytes(17)])
def test_undecodable_command_is_refused(robot: VirtualRobot, sensors: Sensors, data: bytes) -> None:
    """A zero comes at once; invalid bytes affect only that command."""
    sensors.quiet("/cmd_vel_nav")
    sensors.send("/cmd_vel_nav", data)
    assert first_zero(robot) == sensors.last["/cmd_vel_nav"]
    sensors.play("/cmd_vel_nav", command(), rate=20.0)
    until_driving(robot)


def test_command_passes_at_once(robot: VirtualRobot, sensors: Sensors) -> None:
    """Without an active action each command is published at the same instant."""
    robot.run(0.011)
    for number in range(20):
        sensors.send("/cmd_vel_nav", command(number / 100))
        robot.run(0.0)
        assert robot.commands[-1] == Seen(number / 100, robot.now)


def test_stop_passes_the_gate_at_once(robot: VirtualRobot, sensors: Sensors) -> None:
    """A violation becomes a zero at the same instant, and no command passes until the reset."""
    sensors.play("/speed", speed(9.0))
    assert first_zero(robot) == sensors.last["/speed"]
    sensors.play("/speed", speed(0.1))
    stopped = len(robot.commands)
    assert_zeros(robot)
    assert len(robot.commands) - stopped == 20  # at 20 Hz, with or without commands
    robot.until(lambda: robot.reset()[0])
    until_driving(robot)


def test_status_reports_output_and_reason(robot: VirtualRobot, sensors: Sensors) -> None:
    """One status each second and 50 ms after a change, which says since when a line applies."""
    sent: list[tuple[int, str, str]] = []

    def take(message: Any) -> None:
        for status in message.status:
            if status.name == f"/{GATE}":
                since = next(each.value for each in status.values if each.key == "since_ns")
                sent.append((robot.now, status.message, since))

    robot.peer.create_subscription(DiagnosticArray, "/diagnostics", take, 10)
    robot.run(2.5)
    assert {message for _, message, _ in sent} == {"commands pass"}
    sent.clear()
    sensors.send("/speed", speed(9.0))
    stopped = robot.now
    robot.run(3.5)
    first = stopped + ns(0.05)
    assert [at for at, _, _ in sent] == [first + ns(second) for second in range(4)]
    assert {message.partition(" (")[0] for _, message, _ in sent} == {"stop: zero"}
    assert {since for _, _, since in sent} == {str(stopped)}


def test_no_old_command_is_published_when_a_stop_ends(
    robot: VirtualRobot, sensors: Sensors
) -> None:
    """After a stop the gate is silent until the next command, or zero."""
    sensors.send("/speed", speed(9.0))
    assert first_zero(robot) == robot.now
    sensors.quiet("/cmd_vel_nav")
    sensors.send("/cmd_vel_nav", command(0.1))
    robot.until(lambda: robot.reset()[0])
    ended = len(robot.commands)
    robot.run(2.0)
    assert {each.value for each in robot.commands[ended:]} == {0.0}
    sensors.play("/cmd_vel_nav", command(), rate=20.0)
    until_driving(robot)


def test_latched_stop_survives_any_crash(
    robot: VirtualRobot, node: VirtualNode, gate: VirtualNode, sensors: Sensors
) -> None:
    """From the stop to its reset the drive gets only zeros, whichever process dies."""
    sensors.send("/speed", speed(9.0))
    first_zero(robot)
    robot.kill(node)
    robot.start()
    assert_zeros(robot)
    robot.kill(gate)
    robot.run(3.0)
    stopped = len(robot.commands)
    robot.start(GATE)
    robot.run(0.001)
    assert [each.value for each in robot.commands[stopped:]] == [0.0]
    assert_zeros(robot)
    robot.until(lambda: robot.reset()[0])
    until_driving(robot)


def test_limit_becomes_zero_when_the_safety_node_dies(
    robot: VirtualRobot, node: VirtualNode, sensors: Sensors
) -> None:
    """The robot does not creep under a limit that is no longer monitored."""
    sensors.send("/load", load(99.0))
    robot.run(0.001)
    assert robot.commands[-1] == Seen(LIMIT, sensors.last["/load"])  # without a new command
    limited = len(robot.commands)
    robot.run(1.0)
    assert {each.value for each in robot.commands[limited:]} == {LIMIT}
    robot.kill(node)
    robot.until(lambda: robot.commands[-1].value == 0.0)
    assert robot.commands[-1].at == robot.beats[-1].at + LOST_HEARTBEAT
    assert_zeros(robot)


@pytest.mark.usefixtures("sensors")
def test_hung_gate_continues_with_zero(robot: VirtualRobot, gate: VirtualNode) -> None:
    """The loss during the hang counts, whatever waits for the gate when it goes on."""
    robot.run(0.033)
    gate.freeze()
    hung = len(robot.commands)
    robot.run(1.0)
    assert len(robot.commands) == hung
    gate.thaw()
    robot.run(0.0)
    assert robot.commands[hung].value == 0.0
    until_driving(robot)


@pytest.mark.parametrize("rate", [0.0, 0.05])
def test_losses_are_measured_on_the_steady_clock(robot: VirtualRobot, rate: float) -> None:
    """With a paused or slow simulated clock, silence is detected in time, and zeros follow."""
    node = robot.start()
    robot.start(GATE, use_sim_time=True)
    sensors = robot.sensors({**TOPICS, "/clock": "rosgraph_msgs/msg/Clock"})
    robot.peer.create_timer(0.02, lambda: sensors.send("/clock", ticked(robot, rate)))
    sensors.drive()
    until_driving(robot)
    node.freeze()
    assert first_zero(robot) == robot.beats[-1].at + LOST_HEARTBEAT
    assert_zeros(robot)


def test_simulation_that_ends_stops_the_robot(robot: VirtualRobot) -> None:
    """With /clock the heartbeat rests, which the gate misses on its steady clock."""
    robot.start(use_sim_time=True)
    robot.start(GATE, use_sim_time=True)
    sensors = robot.sensors({**TOPICS, "/clock": "rosgraph_msgs/msg/Clock"})
    time = robot.peer.create_timer(0.02, lambda: sensors.send("/clock", ticked(robot, 1.0)))
    sensors.drive()
    until_driving(robot)
    time.cancel()
    assert first_zero(robot) == robot.beats[-1].at + LOST_HEARTBEAT
    assert_zeros(robot)


def ticked(robot: VirtualRobot, rate: float) -> Any:
    """Return a simulated time that passes at a rate."""
    from rosgraph_msgs.msg import Clock  # type: ignore[import-untyped]

    message = Clock()
    passed = ns(500.0) + round(rate * robot.now)
    message.clock.sec, message.clock.nanosec = divmod(passed, ns(1.0))
    return message


# Other publishers -------------------------------------------------------------------------------


class Impostor(VirtualNode):
    """A node that publishes what the safety node should.

    Attributes:
        count: of its heartbeats.
    """

    count = 0

    def say(self, topic: str, active: bool) -> None:
        """Publish a state, once."""
        self._publisher(topic).publish(button(active))

    def beat(self, advance: int = 1) -> None:
        """Publish a heartbeat, once."""
        from std_msgs.msg import UInt64

        self.count += advance
        self._publisher(HEARTBEAT).publish(UInt64(data=self.count))

    def play(self, *what: str, advance: int = 1) -> None:
        """Publish the heartbeat, or an inactive state, ten times a second."""
        for each in what:
            beat, state = partial(self.beat, advance), partial(self.say, each, False)
            say = beat if each == "heartbeat" else state
            say()
            self.create_timer(0.1, say)

    def _publisher(self, topic: str) -> Any:
        from std_msgs.msg import Bool, UInt64

        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        known = {each.topic_name: each for each in self.publishers}
        if topic in known:
            return known[topic]
        is_beat = topic == HEARTBEAT
        return self.create_publisher(UInt64 if is_beat else Bool, topic, 10 if is_beat else latched)


def impostor(robot: VirtualRobot, name: str = "stranger") -> Impostor:
    """Start a node that publishes like the safety node."""
    return Impostor(name, graph=robot.graph)


STATES = ("/stop", "/halt", "/slow")


def test_node_that_replaces_the_safety_node_is_obeyed(
    robot: VirtualRobot, node: VirtualNode, sensors: Sensors
) -> None:
    """A sole publisher of heartbeat and states is the safety node: names are public."""
    assert sensors.is_running
    robot.kill(node)
    first_zero(robot)
    stranger = impostor(robot)
    stranger.play("heartbeat", *STATES)
    until_driving(robot)


def test_restarted_safety_node_may_publish_states_first(
    robot: VirtualRobot, node: VirtualNode, sensors: Sensors
) -> None:
    """During its grace period the states come long before the first heartbeat."""
    assert sensors.is_running
    robot.kill(node)
    robot.run(3.0)
    stranger = impostor(robot, NODE)
    stranger.play(*STATES)
    robot.run(2.0)
    assert_zeros(robot)
    stranger.play("heartbeat")
    until_driving(robot)


@pytest.mark.parametrize("advance", [0, 1])
def test_constant_heartbeat_releases_nothing(robot: VirtualRobot, advance: int) -> None:
    """The counter must advance; a message alone is not a sign of life."""
    robot.start(GATE)
    robot.sensors(COMMANDER).drive()
    stranger = impostor(robot, NODE)
    stranger.play("heartbeat", *STATES, advance=advance)
    robot.run(3.0)
    assert robot.commands[-1].value == (COMMAND if advance else 0.0)
    if not advance:
        assert_zeros(robot)


def test_foreign_inactive_state_does_not_release(robot: VirtualRobot, sensors: Sensors) -> None:
    """Latched or repeated, no command passes while the safety node publishes active."""
    sensors.send("/speed", speed(9.0))
    first_zero(robot)
    stranger = impostor(robot)
    stranger.say("/stop", False)
    assert_zeros(robot)
    stranger.play("/stop")
    robot.run(3.0)
    assert_zeros(robot)
    assert f"publishers where one is expected: /{NODE}, /stranger" in robot.waiting(GATE)
    stranger.destroy_node()
    assert_zeros(robot)
    robot.until(lambda: robot.reset()[0])
    until_driving(robot)


@pytest.mark.parametrize("lives", [0.0, 0.001, 0.3])
@pytest.mark.parametrize("is_hung", [False, True])
@pytest.mark.parametrize("is_late", [False, True])
def test_short_lived_foreign_publisher_does_not_release(
    robot: VirtualRobot,
    gate: VirtualNode,
    sensors: Sensors,
    lives: float,
    is_hung: bool,
    is_late: bool,
) -> None:
    """However briefly it exists, its state does not count, also if the gate hangs meanwhile.

    Nor does it if the gate learns of the publisher only after the message.
    """
    sensors.send("/speed", speed(9.0))
    first_zero(robot)
    if is_hung:
        gate.freeze()
    robot.graph.events_are_late = is_late
    stopped = len(robot.commands)
    for _ in range(5):
        robot.run(0.137)
        stranger = impostor(robot)
        stranger.say("/stop", False)
        if lives:
            robot.run(lives)
        stranger.destroy_node()
    gate.thaw()
    for _ in range(20):  # a command at each turn of the gate, should it be open in between
        sensors.send("/cmd_vel_nav", command())
        robot.graph.turn()
    robot.run(2.0)
    assert {each.value for each in robot.commands[stopped:]} == {0.0}


def test_foreign_active_state_stops(robot: VirtualRobot, sensors: Sensors) -> None:
    """It counts, at once, until its publisher is gone, whatever the safety node publishes."""
    assert sensors.is_running
    stranger = impostor(robot)
    stranger.say("/stop", True)
    assert first_zero(robot) == robot.now
    assert_zeros(robot, 2.0)
    stranger.destroy_node()
    until_driving(robot)


def test_second_heartbeat_publisher_counts_as_a_loss(
    robot: VirtualRobot, sensors: Sensors, node: VirtualNode
) -> None:
    """The safety node cannot be identified; when the second is gone, the gate continues."""
    assert sensors.is_running
    robot.run(6.0)  # so that the safety node is not the one to end
    stranger = impostor(robot)
    stranger.beat()
    assert first_zero(robot) == robot.now
    robot.run(3.0)
    assert_zeros(robot)
    assert f"publishers where one is expected: /{NODE}, /stranger" in robot.waiting(GATE)
    stranger.play("heartbeat")
    node.freeze()
    assert_zeros(robot, 2.0)
    node.thaw()
    stranger.destroy_node()
    until_driving(robot)


def test_state_of_another_node_than_the_heartbeat_is_ignored(robot: VirtualRobot) -> None:
    """It is the only publisher of the topic and inactive, but nothing passes."""
    robot.start(GATE)
    robot.sensors(COMMANDER).drive()
    impostor(robot, NODE).play("heartbeat", "/halt", "/slow")
    impostor(robot).play("/stop")
    robot.run(2.0)
    assert_zeros(robot)
    assert f"/stranger publishes it, not the safety node /{NODE}" in robot.waiting(GATE)


def test_undecodable_state_stops(robot: VirtualRobot) -> None:
    """Invalid bytes count as active until a valid state of the safety node arrives."""
    robot.start(GATE)
    robot.sensors(COMMANDER).drive()
    stranger = impostor(robot, NODE)
    stranger.play("heartbeat")
    for topic in STATES:
        stranger.say(topic, False)
    robot.run(0.0)
    for topic in STATES:
        stranger.say(topic, False)
    until_driving(robot)
    robot.run(5.0)  # a state that is not repeated remains valid
    assert robot.commands[-1].value == COMMAND
    stranger._publisher("/stop").publish(b"\x00\x01\x00\x00")
    assert first_zero(robot) == robot.now
    assert_zeros(robot)
    stranger.say("/stop", False)
    until_driving(robot)
