"""Second nodes and second publishers, in virtual time."""

from __future__ import annotations

import pytest

from tests.support.faults import GATE, NODE
from tests.support.played import TOPICS, speed
from tests.support.virtual_robot import HEARTBEAT, VirtualRobot

EARLY = 5.0
"""Seconds after its start during which a node exits if it finds another one of its name."""


def unlock(robot: VirtualRobot) -> None:
    """Remove the locks, or start the next node on another machine, which has none of them."""
    for lock in robot.folder.glob("deros-*/*"):
        lock.unlink()


@pytest.mark.parametrize("name", [NODE, GATE])
@pytest.mark.parametrize("apart", [0.0, 1.0, EARLY - 0.3, EARLY + 1.0, 100.0])
def test_later_of_two_nodes_ends(robot: VirtualRobot, name: str, apart: float) -> None:
    """Without a common lock they meet in the graph; the one that started last ends, and soon."""
    first = robot.start(name)
    robot.run(apart)
    unlock(robot)
    robot.start(name)
    with pytest.raises(Exception, match="this one started last and ends now") as ended:
        robot.run(2 * EARLY)
    assert type(ended.value).__name__ == "Refusal"
    ender = ended.traceback[-1].frame.f_locals["self"]._node
    assert (ender is not first) or apart == 0.0
    ender.destroy_node()
    robot.run(2 * EARLY)  # the other one continues
    robot.until(lambda: "another" not in robot.statuses[name].message)


@pytest.mark.parametrize("name", [NODE, GATE])
def test_second_node_that_stays_is_a_fault(robot: VirtualRobot, name: str) -> None:
    """Old ones do not end when they meet: both report it until one is gone."""
    first = robot.start(name)
    first.freeze()
    unlock(robot)
    topic = HEARTBEAT if name == NODE else "/cmd_vel"
    robot.graph.nodes.remove(first)  # out of reach, as a partition of the network makes it
    second = robot.start(name)
    robot.run(2 * EARLY)
    first.thaw()
    robot.graph.nodes.append(first)
    robot.run(2 * EARLY + 1.0)
    assert topic in {each.key for each in robot.statuses[name].values}
    second.destroy_node()
    robot.run(2.0)
    assert topic not in {each.key for each in robot.statuses[name].values}


def test_foreign_heartbeat_and_states_are_faults(robot: VirtualRobot) -> None:
    """A heartbeat could make a dead node look alive; readers cannot distinguish two states."""
    robot.start()
    robot.run(EARLY)
    for topic, text in {
        HEARTBEAT: "another node publishes this heartbeat",
        "/stop": "published by /sensors_",
    }.items():
        kind = "std_msgs/msg/UInt64" if topic == HEARTBEAT else "std_msgs/msg/Bool"
        other = robot.sensors({topic: kind})
        robot.run(2.0)
        faults = {each.key: each.value for each in robot.statuses[NODE].values}
        assert text in faults[topic]
        assert any(e["kind"] == "fault" and text in e["message"] for e in robot.events)
        other.destroy_node()
        robot.run(2.0)
        assert topic not in {each.key for each in robot.statuses[NODE].values}


def test_every_publisher_of_an_input_is_evaluated(robot: VirtualRobot) -> None:
    """A message of either publisher may violate a rule."""
    robot.start()
    sensors = robot.sensors()
    sensors.drive()
    robot.until_free()
    second = robot.sensors({"/speed": TOPICS["/speed"]})
    second.send("/speed", speed(2.0))
    assert robot.until_active("/stop") == robot.now


def test_publisher_of_another_type_is_not_the_sensor(robot: VirtualRobot) -> None:
    """It is reported, has no effect, and does not hide the silence."""
    from tests.support.played import button

    robot.start()
    stranger = robot.sensors({"/speed": "std_msgs/msg/Bool"})
    stranger.play("/speed", button(True))
    robot.run(2.0)
    assert any("publishes std_msgs/msg/Bool on it" in each["message"] for each in robot.events)
    sensors = robot.sensors()
    sensors.drive()
    robot.until_free()
    sensors.quiet("/speed")
    assert robot.until_active("/halt") == sensors.last["/speed"] + 500_000_000
