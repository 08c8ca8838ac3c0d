"""The safety node in C++ on the real middleware, and in the place of the one in Python.

What both nodes have to do alike is held by the tests of the Python one, which run with each.
"""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from tests.support.cpp import needs_rclcpp
from tests.support.ros import LIMIT
from tests.support.safety_node import CppNode, PythonNode, Robot, Start, end, starting

pytestmark = [pytest.mark.ros, needs_rclcpp]


@pytest.fixture
def start(tmp_path: Path, ros_env: dict[str, str]) -> Start:
    """Give a function that runs the node in C++."""
    return starting(CppNode(tmp_path / "cpp"), ros_env)


@pytest.fixture
def start_python(tmp_path: Path, ros_env: dict[str, str]) -> Start:
    """Give a function that runs the node in Python, in the same domain and with the same files."""
    return starting(PythonNode(tmp_path / "python"), ros_env)


def test_each_node_takes_over_what_the_other_has_latched(
    start: Start, start_python: Start, robot: Robot
) -> None:
    """Latched by one and killed, active in the other; reset by that one, inactive in the first."""
    for first, second in ((start, start_python), (start_python, start)):
        with first() as process:
            robot.meet()
            robot.drive_until(0.9, lambda: robot.stop[-1])
            process.kill()
            process.wait(LIMIT)
        robot.forget()
        with second() as process:
            robot.peer.until(lambda: robot.beats and robot.stop)
            assert all(robot.stop)
            assert robot.event("latched")["action"] == "stop"
            assert not robot.reset().success
            robot.peer.until(lambda: robot.reset(0.1).message == "stop is reset")
            robot.peer.until(lambda: not robot.stop[-1])
            process.kill()
            process.wait(LIMIT)
        robot.forget()
        with first():
            robot.peer.until(lambda: robot.beats and robot.stop)
            assert not any(robot.stop)
        robot.forget()


def test_neither_runs_beside_the_other(start: Start, start_python: Start, robot: Robot) -> None:
    """The lock is one: the second ends at once and names the first."""
    for first, second in ((start, start_python), (start_python, start)):
        with first() as running:
            robot.event("start")
            with second() as refused:
                output, _ = refused.communicate(timeout=LIMIT)
            assert refused.returncode == 1
            assert f"as process {running.pid}: this second one ends now" in output
        robot.forget()


def test_both_report_the_same_of_the_same_messages(
    start: Start, start_python: Start, robot: Robot
) -> None:
    """Every status has the same level, message and values, but for the times; and each event."""
    seen = []
    for each in (start, start_python):
        robot.take_over(0)  # a node that starts is told the last mode
        with each("diagnostics_freq:=20.0"):
            robot.meet()
            robot.event("trigger", action="crawl")  # nobody has driven yet
            robot.drive_until(0.9, lambda: robot.stop[-1])

            def is_well() -> bool:
                robot.report_health()
                return robot.status("body.ill").message.startswith("false")

            robot.drive_until(0.9, is_well)
            robot.take_over(1)
            robot.peer.until(lambda: robot.status("operator.manual").values.get("mode") == "1")
            robot.event("reset", action="crawl")
            robot.peer.until(lambda: robot.status("action crawl").values["runs"] == "2")
            robot.peer.until(lambda: robot.limit[-1] == 0.2)
            robot.peer.until(
                lambda: robot.status("drive.silent").values["speed.missing()"] == "true"
            )
            robot.peer.until(lambda: robot.status("drive.fast").message.startswith("unknown"))
            assert not robot.reset().success
            refused = robot.event("refused", action="stop")
            assert (refused["holding"], refused["unknown"]) == ("", "speeding")
            assert robot.status("action stop").message == "active"
            statuses = {
                name: (status.level, status.message, _timeless(status.values))
                for name, status in robot.statuses.items()
            }
            robot.peer.until(lambda: robot.reset(0.1).success)
            events = [
                _timeless(robot.event("trigger", action="stop")),
                _timeless(robot.event("trigger", action="crawl")),
                _timeless(robot.event("trigger", action="log_state")),
                _timeless(robot.event("refused", action="stop")),
                _timeless(robot.event("reset", action="stop")),
                _timeless(robot.event("start")),
            ]
            seen.append((statuses, events))
        robot.forget()
    in_cpp, in_python = seen
    assert in_cpp == in_python


def _timeless(values: dict[str, str]) -> dict[str, str]:
    times = {"since", "since_ns", "time_ns", "published_ns", "ros_time_ns"}
    return {name: value for name, value in values.items() if name not in times}


@pytest.mark.parametrize(
    ("parameter", "fragment"),
    [
        ("publish_freq:=-1.0", "publish_freq"),
        ("publish_freq:=often", "publish_freq"),
        ("realtime_priority:=100", "realtime_priority"),
        ("state_file:=3", "state_file"),
    ],
)
def test_a_bad_parameter_is_a_line_and_not_a_crash(
    start: Start, parameter: str, fragment: str
) -> None:
    """The program ends with 1 and says what is wrong."""
    with start(parameter) as process:
        output, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == 1
    assert fragment in output
    assert "terminate called" not in output


def test_garbage_collection_is_taken_and_has_no_effect(start: Start, robot: Robot) -> None:
    """The parameter files of the Python node are valid for this one."""
    with start("garbage_collection:=false") as process:
        robot.meet()
        code, _ = end(process, robot, signal.SIGTERM)
    assert code == 0
