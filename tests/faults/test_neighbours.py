"""Faults of other nodes: duplicate publishers, a second safety node, a switched clock."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import pytest

from tests.support.faults import NODE, PROMPT, Robot
from tests.support.gate_nodes import Stranger
from tests.support.played import SENSES, TOPICS, button, imu, speed, ticks

pytestmark = pytest.mark.ros

HEARTBEAT = f"/{NODE}/heartbeat"
EARLY = 5.0
"""Seconds after its start during which a node exits if it finds another one of its name."""


def until_fault(robot: Robot, topic: str, *texts: str) -> None:
    """Wait until the diagnostics and an event report such a fault of a topic."""

    def is_reported() -> bool:
        # The publisher may not be identified at first.
        events = robot.fault_events.get(topic, [])[-1:]
        reports = [robot.faults.get(topic, ""), *events]
        return bool(events) and all(text in each for text in texts for each in reports)

    robot.until(is_reported)


def until_no_fault(robot: Robot, topic: str) -> None:
    """Wait until the diagnostics report no fault of a topic any more."""
    robot.until(lambda: topic not in robot.faults)


@pytest.mark.slow
def test_second_publisher_does_not_hide_a_dead_sensor(robot: Robot) -> None:
    """Two publishers of one input are a fault, whichever of them is alive; one is not."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        until_no_fault(robot, "/imu")
        with robot.sensors({"/imu": SENSES["/imu"]}) as second:
            second.play("/imu", imu())
            until_fault(robot, "/imu", "2 publishers where one is expected")
            sensors.quiet("/imu")
            robot.spin(1.0)  # longer than the timeout, with messages from the second one
            assert "2 publishers" in robot.faults["/imu"]
        robot.until_stopped("/halt")


@pytest.mark.slow
def test_every_publisher_of_an_input_is_evaluated(robot: Robot) -> None:
    """A message of either publisher may violate a rule."""
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        with robot.sensors({"/speed": SENSES["/speed"]}) as second:
            second.match("/speed")
            second.play("/speed", speed(2.0))
            robot.until_stopped(limit=PROMPT)


@pytest.mark.slow
def test_second_publisher_of_a_state_is_a_fault(robot: Robot) -> None:
    """Readers of the topic cannot distinguish the two, so the safety node names the other one."""
    with robot.safety_node():
        with robot.sensors({"/stop": "std_msgs/msg/Bool"}):
            until_fault(robot, "/stop", "published by /", ", too")
        until_no_fault(robot, "/stop")


def test_incompatible_reader_is_a_fault(robot: Robot) -> None:
    """A reader that requests more than the node offers would never stop; the fault names it."""
    from rclpy.duration import Duration
    from rclpy.qos import QoSProfile
    from std_msgs.msg import Bool, UInt64

    asked = QoSProfile(depth=1, deadline=Duration(seconds=1))
    node = robot.peer.node
    with robot.safety_node():
        for topic, kind in (("/stop", Bool), (HEARTBEAT, UInt64)):
            subscription = node.create_subscription(kind, topic, lambda _: None, asked)
            until_fault(robot, f"readers of {topic}", node.get_name(), "asks for a QoS", "deadline")
            node.destroy_subscription(subscription)
            until_no_fault(robot, f"readers of {topic}")


@pytest.mark.slow
def test_node_corrects_states_from_other_publishers(robot: Robot) -> None:
    """The node repeats the state of its rules after a foreign message on its topic."""
    with robot.safety_node() as node:
        for topic in ("/stop", "/halt", "/slow", HEARTBEAT):
            publishers = robot.peer.node.get_publishers_info_by_topic(topic)
            assert [each.node_name for each in publishers] == [NODE]
        with Stranger(robot.env) as stranger:
            publisher = stranger.state("/halt", button(False))
            robot.until(publisher.get_subscription_count)
            robot.until(lambda: not robot.is_active("/halt"))
            robot.until_stopped("/halt", limit=PROMPT)
        assert "halt, by" in node.output()
        assert "halt is reset" not in node.output()


@pytest.mark.slow
def test_second_publisher_of_the_heartbeat_is_a_fault(robot: Robot) -> None:
    """It could make a dead node look alive."""
    with robot.safety_node():
        begun = time.monotonic()
        robot.until(lambda: time.monotonic() > begun + EARLY)
        with robot.sensors({HEARTBEAT: "std_msgs/msg/UInt64"}):
            until_fault(robot, HEARTBEAT, "another node publishes this heartbeat")
        until_no_fault(robot, HEARTBEAT)


@pytest.mark.slow
def test_second_node_is_detected_without_a_shared_folder(robot: Robot, tmp_path: Path) -> None:
    """As on another machine or in another container: the second exits, the first continues."""
    with robot.safety_node():
        folder = tmp_path / "elsewhere"
        folder.mkdir()
        env = {"TMPDIR": str(folder), "TEMP": "", "TMP": ""}
        second = robot.start(NODE, [f"state_file:={folder / 'state'}"], **env)
        assert robot.until(second.popen.poll) == 1
        assert "another node publishes this heartbeat" in second.output()
        assert "Traceback" not in second.output()
        until_no_fault(robot, HEARTBEAT)


@pytest.mark.slow
def test_second_clock_is_a_fault(robot: Robot) -> None:
    """Time set by two publishers would jump back and forth."""
    with_clock = {**TOPICS, "/clock": "rosgraph_msgs/msg/Clock"}
    with robot.sensors(with_clock) as sensors:
        sensors.play("/clock", *ticks())
        with robot.safety_node("use_sim_time:=true"):
            until_no_fault(robot, "/clock")
            with robot.sensors({"/clock": with_clock["/clock"]}):
                until_fault(robot, "/clock", "2 publishers where one is expected")
            until_no_fault(robot, "/clock")


@pytest.mark.slow
@pytest.mark.parametrize("chosen", [True, False])
def test_clock_source_cannot_be_changed(robot: Robot, chosen: bool) -> None:
    """A change of use_sim_time is rejected with a reason, and the node keeps monitoring."""
    with_clock = {**TOPICS, "/clock": "rosgraph_msgs/msg/Clock"}
    with robot.sensors(with_clock) as sensors:
        sensors.play("/clock", *ticks())
        with robot.safety_node(f"use_sim_time:={str(chosen).lower()}"):
            for value in (not chosen, chosen):
                result = set_use_sim_time(robot, value)
                assert result.successful == (value == chosen)
                assert value == chosen or "cannot change while the node runs" in result.reason
            robot.until_alive()


def set_use_sim_time(robot: Robot, value: bool) -> Any:
    """Set the parameter of the safety node, and return the result."""
    from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
    from rcl_interfaces.srv import SetParameters

    client = robot.peer.node.create_client(SetParameters, f"/{NODE}/set_parameters")
    value_set = ParameterValue(type=ParameterType.PARAMETER_BOOL, bool_value=value)
    request = SetParameters.Request(parameters=[Parameter(name="use_sim_time", value=value_set)])
    return robot.peer.call(client, request).results[0]
