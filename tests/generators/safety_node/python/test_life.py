"""Life cycle of a generated safety node on real middleware: start, faults, reports, restart."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.support.processes import freeze, thaw
from tests.support.ros import LIMIT, running
from tests.support.safety_node import NODE, Process, Robot, Software, Start, end

pytestmark = pytest.mark.ros

OK, WARN, ERROR, STALE = range(4)


def state_file(ros_env: dict[str, str]) -> Path:
    """Return the file in which the node stores its latches."""
    name = f"{NODE}.{ros_env['ROS_DOMAIN_ID']}.latches"
    return Path(ros_env["ROS_HOME"]) / "deros" / name


def break_the_rule(robot: Robot) -> None:
    """Drive too fast until the robot is stopped."""
    robot.meet()
    robot.drive_until(0.9, lambda: robot.stop[-1])


def kill(process: Process) -> None:
    """Kill the node, as a crash would."""
    process.kill()
    process.wait(LIMIT)


# Start ----------------------------------------------------------------------------------------


def test_no_heartbeat_before_the_inputs(start: Start, robot: Robot) -> None:
    """During the grace period readers of the heartbeat hold the robot, and the status says why."""
    with start("startup_grace:=60.0") as process:
        robot.peer.until(lambda: robot.stop and robot.statuses)
        states = len(robot.stop)
        robot.peer.until(lambda: len(robot.stop) >= states + 5)
        assert robot.beats == []
        assert robot.status().level == WARN
        assert robot.status().message.startswith("starting")
        robot.peer.until(lambda: robot._speed.get_subscription_count() == 1)
        robot.drive_until(0.1, lambda: robot.beats)
        robot.peer.until(lambda: robot.status().values["state"] == "watching")
        code, lines = end(process, robot)
    assert code == 0
    assert not [line for line in lines if line.startswith("crawl")]


def test_behaviour_that_waits_for_its_inputs_blames_no_rule(start: Start, robot: Robot) -> None:
    """Of 'drive.silent or body.ill', the second is unknown: the first, false, holds no robot."""
    with start("startup_grace:=60.0"):
        robot.peer.until(lambda: robot.status("body.ill").level == STALE)
        robot.peer.until(lambda: robot.status("drive.silent").values)
        status = robot.status("drive.silent")
        assert (status.level, status.message) == (OK, "false: silent: speed.missing();")


def test_grace_ends_with_missing_inputs(start: Start, robot: Robot) -> None:
    """The timeouts count from its end; then the node has a heartbeat and acts by its rules."""
    with start("startup_grace:=0.5"):
        robot.peer.until(lambda: robot.beats)
        robot.peer.until(lambda: robot.limit and robot.limit[-1] == 0.2)
        assert int(robot.event("trigger")["time_ns"]) > 0


def test_second_instance_is_refused(start: Start, robot: Robot) -> None:
    """It exits at once and names the first, which continues."""
    with start() as first:
        robot.meet()
        with start() as second:
            output, _ = second.communicate(timeout=LIMIT)
        assert second.returncode == 1
        assert f"/{NODE} runs already in domain" in output
        assert f"as process {first.pid}" in output
        assert "Traceback" not in output
        beats = len(robot.beats)
        robot.peer.until(lambda: len(robot.beats) > beats + 2)
        robot.peer.until(lambda: robot.status().values)
        assert robot.status().values.keys() == {"state"}


def test_second_heartbeat_ends_the_younger_node(start: Start, robot: Robot) -> None:
    """A node on another machine shares no lock, but is detected."""
    from std_msgs.msg import UInt64

    robot.peer.node.create_publisher(UInt64, f"/{NODE}/heartbeat", 10)
    with start() as process:
        output, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == 1
    assert "this one started last and ends now" in output


def test_missing_permissions_are_reported(start: Start, robot: Robot) -> None:
    """With all options set the node runs, either with them or with a warning."""
    options = ("realtime_priority:=20", "lock_memory:=true", "garbage_collection:=false")
    with start(*options) as process:
        break_the_rule(robot)
        code, lines = end(process, robot)
    assert code == 0
    assert all("not permitted" in line for line in lines if line.startswith(options[0][:8]))


# Reports --------------------------------------------------------------------------------------


def test_each_trigger_is_one_event_with_its_cause(start: Start, robot: Robot) -> None:
    """The event has action, behaviour, place, condition, time, and the values of the cause."""
    with start():
        break_the_rule(robot)
        event = robot.event("trigger", action="stop")
    assert (
        event.items()
        >= {
            "action": "stop",
            "behaviour": "speeding",
            "origin": "every_thing.deros:28",
            "condition": "drive.fast for 100 ms",
            "cause": "drive.fast for 100 ms: speed 0.9 > 0.5 m/s",
            "rule drive.fast": "true",
            "value speed": "0.9",
        }.items()
    )
    assert event["message"] == (
        "stop, by speeding (every_thing.deros:28): drive.fast for 100 ms: speed 0.9 > 0.5 m/s"
    )
    assert int(event["published_ns"]) >= int(event["time_ns"])  # tests/faults/virtual: the same


def test_diagnostics_show_rules_actions_and_values(start: Start, robot: Robot) -> None:
    """They show causes of true rules, start times of active actions, and unknown values."""
    with start("diagnostics_freq:=20.0"):
        break_the_rule(robot)
        robot.drive_until(0.9, lambda: robot.status("action stop").level == WARN)
        rule, action = robot.status("drive.fast"), robot.status("action stop")
        assert rule.level == ERROR
        assert rule.message == "true: fast: speed > limit;"
        assert rule.values["speed"] == "0.9"
        assert rule.values["line"] == "16"
        assert (action.level, action.message) == (WARN, "active")
        assert action.values["cause"] == "speeding"
        assert action.values["since"].endswith(" s ago")
        assert robot.status("action beep").message == "run 1 times"
        assert robot.status("body.tilted").level == STALE
        assert robot.status().message == "watching 10 rules"
        robot.drive(0.1)
        robot.peer.until(lambda: robot.status("drive.fast").level == OK)


def test_diagnostics_show_what_comes_and_how_old_inputs_are(start: Start, robot: Robot) -> None:
    """An interval that runs, a sensor that falls silent, and a topic that never sent."""
    with start("diagnostics_freq:=50.0"):
        robot.meet()
        then = "if values stay", "if no message comes"
        robot.drive_until(0.1, lambda: robot.status("drive.fast").level == OK)
        assert not {"if values stay"} & {*robot.status("drive.fast").values}
        # The whole half second, if the message came in the millisecond of the report.
        expected = re.compile(r"unknown in 0\.([0-4]\d\d|500) s")
        assert expected.fullmatch(robot.status("drive.fast").values[then[1]])
        expected = re.compile(r"true in 0\.([0-4]\d\d|500) s")
        assert expected.fullmatch(robot.status("drive.silent").values[then[1]])
        robot.drive_until(0.1, lambda: robot.status("inputs").values["speed"].startswith("0."))
        assert robot.status("inputs").values["mode"] == "never"
        assert "mode" in robot.status("inputs").message
        robot.peer.until(lambda: robot.status("drive.silent").level != OK)
        robot.peer.until(lambda: robot.status("inputs").values["speed"] >= "0.5")
        assert not {*then} & {*robot.status("drive.silent").values}


def test_change_is_published_before_the_next_period(start: Start, robot: Robot) -> None:
    """It need not wait for the period of the diagnostics."""
    with start("diagnostics_freq:=0.001"):
        break_the_rule(robot)
        robot.peer.until(lambda: robot.status("action stop").message == "active")


def test_undecodable_data_is_ignored(start: Start, robot: Robot, node: Software) -> None:
    """It is reported once, does not restart a timeout, and has no other effect."""
    with start() as process:
        robot.meet()

        def send() -> Any:
            robot._speed.publish(b"\x00\x01\x00\x00\x01")
            return robot.limit[-1] == 0.2

        robot.peer.until(send)
        if node.sees_what_it_cannot_read:
            assert robot.event("undecodable")["topic"] == "/speed"
            robot.peer.until(lambda: robot.status().level == ERROR)
        robot.drive_until(0.9, lambda: robot.stop[-1])
        code, lines = end(process, robot)
    assert code == 0
    undecodable = [event for event in robot.events if event["kind"] == "undecodable"]
    assert len(undecodable) == node.sees_what_it_cannot_read
    assert "Traceback" not in "\n".join(lines)


def test_incompatible_publishers_are_reported(
    start: Start, robot: Robot, ros_env: dict[str, str]
) -> None:
    """They have another type, or offer best effort on a topic that must be reliable."""
    from rclpy.qos import QoSProfile, ReliabilityPolicy
    from std_msgs.msg import Float64

    unfit = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    with start():
        robot.meet()
        publisher = robot.peer.node.create_publisher(Float64, "/speed", unfit)
        event = robot.event("fault", subject="/speed")
        assert "offers an incompatible QoS on it" in event["message"]
        robot.peer.until(lambda: "/speed" in robot.status().values)
        robot.peer.node.destroy_publisher(publisher)
        robot.peer.until(lambda: "/speed" not in robot.status().values)
        robot.events.clear()
        with stranger("/imu", ros_env):
            event = robot.event("fault", subject="/imu")
        assert "publishes std_msgs/msg/String on it" in event["message"]


def stranger(topic: str, env: dict[str, str]) -> Any:
    """Publish another type on a topic from another process until the block ends."""
    code = (
        "import sys, rclpy; from rclpy.node import Node; from std_msgs.msg import String;"
        "rclpy.init(); node = Node('stranger');"
        f"node.create_publisher(String, {topic!r}, 10); rclpy.spin(node)"
    )
    return running([sys.executable, "-c", code], env)


# Optional behaviours --------------------------------------------------------------------------


@pytest.mark.slow
def test_optional_behaviour_can_be_disabled_and_enabled(start: Start, robot: Robot) -> None:
    """Disabled, it does nothing and is listed as such; enabled, it acts at once if it holds."""
    with start("behaviours.speeding.enabled:=false", "diagnostics_freq:=20.0"):
        robot.meet()
        robot.drive_until(0.9, lambda: robot.status("drive.fast").level != STALE)
        robot.peer.until(lambda: robot.status().message == "disabled: speeding")
        for _ in range(20):
            robot.drive(0.9)
            robot.peer.until(lambda: len(robot.beats) % 2 == 0)
            robot.peer.until(lambda: len(robot.beats) % 2 == 1)
        assert not robot.stop[-1]
        robot.drive(0.9)
        robot.set_parameter("behaviours.speeding.enabled", True)
        robot.drive_until(0.9, lambda: robot.stop[-1])
        assert robot.event("enabled")["behaviour"] == "speeding"
        robot.set_parameter("behaviours.speeding.enabled", False)
        assert robot.event("disabled")["message"] == "speeding is disabled"
        assert robot.reset().success


# Latched actions ------------------------------------------------------------------------------


@pytest.mark.slow
def test_latched_action_survives_a_restart(start: Start, robot: Robot) -> None:
    """Killed or ended, the next process starts with it, until a reset."""
    with start() as process:
        break_the_rule(robot)
        kill(process)
    robot.stop.clear()
    with start() as process:
        robot.peer.until(lambda: robot.stop)
        assert all(robot.stop)
        assert robot.event("latched")["action"] == "stop"
        robot.peer.until(lambda: robot.beats)
        refused = robot.reset()
        assert not refused.success
        assert refused.message == (
            "stop stays active, not known to be false: speeding"
            " (every_thing.deros:28: speed is unknown)"
        )
        robot.peer.until(lambda: robot.reset(0.1).message == "stop is reset")
        robot.peer.until(lambda: not robot.stop[-1])
        kill(process)
    robot.stop.clear()
    with start():
        robot.peer.until(lambda: robot.stop)
        assert not any(robot.stop)


@pytest.mark.slow
def test_damaged_state_file_means_active(
    start: Start, robot: Robot, ros_env: dict[str, str]
) -> None:
    """The robot is stopped until an operator resets it."""
    state_file(ros_env).parent.mkdir(parents=True)
    state_file(ros_env).write_text("stop\n")
    with start():
        robot.peer.until(lambda: robot.stop)
        assert all(robot.stop)
        assert "is damaged" in robot.event("fault", subject="latches")["message"]
        robot.peer.until(lambda: robot.reset(0.1).success)
        robot.peer.until(lambda: not robot.stop[-1])


def test_reset_is_refused_without_a_state_file(start: Start, robot: Robot, tmp_path: Path) -> None:
    """Latches that cannot be stored count as active, and the refusal gives the reason."""
    (tmp_path / "file").write_text("")
    with start(f"state_file:={tmp_path}/file/robot.latches"):
        robot.peer.until(lambda: robot.stop)
        assert all(robot.stop)
        answer = robot.reset()
        assert not answer.success
        assert answer.message.startswith("nothing is reset, because")
        assert robot.stop[-1]


def test_suspended_node_has_no_heartbeat(start: Start, robot: Robot) -> None:
    """The monitor itself publishes the heartbeat: while it does nothing, there is none."""
    with start() as process:
        robot.meet()
        freeze(process.pid)
        beats = len(robot.beats) + 2  # including those in transit
        try:
            with pytest.raises(AssertionError, match="did not come"):
                robot.peer.until(lambda: len(robot.beats) > beats, limit=1.0)
        finally:
            thaw(process.pid)
        beats = len(robot.beats)
        robot.peer.until(lambda: len(robot.beats) > beats)
