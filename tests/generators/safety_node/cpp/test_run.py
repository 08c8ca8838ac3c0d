"""The C++ safety node on real middleware, and in place of the Python one.

Behaviour common to both languages is tested with the Python node, in tests that run with each.
"""

from __future__ import annotations

import re
import signal
from pathlib import Path

import pytest

from tests.support.needs import needs
from tests.support.ros import LIMIT
from tests.support.safety_node import CppNode, PythonNode, Robot, Start, end, starting

pytestmark = [pytest.mark.ros, needs("rclcpp")]

_DURATION = re.compile(r"\b\d+\.\d{3} s\b")
"""Since when something is so, or in how long it will be."""


@pytest.fixture
def start(tmp_path: Path, ros_env: dict[str, str]) -> Start:
    """Return a function that runs the C++ node."""
    return starting(CppNode(tmp_path / "cpp"), ros_env)


@pytest.fixture
def start_python(tmp_path: Path, ros_env: dict[str, str]) -> Start:
    """Return a function that runs the Python node, in the same domain and with the same files."""
    return starting(PythonNode(tmp_path / "python"), ros_env)


def test_latches_are_shared_between_languages(
    start: Start, start_python: Start, robot: Robot
) -> None:
    """Latched by one node and killed, active in the other; reset there, inactive in the first."""
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


def test_nodes_of_both_languages_exclude_each_other(
    start: Start, start_python: Start, robot: Robot
) -> None:
    """They share one lock: the second exits at once and names the first."""
    for first, second in ((start, start_python), (start_python, start)):
        with first() as running:
            robot.event("start")
            with second() as refused:
                output, _ = refused.communicate(timeout=LIMIT)
            assert refused.returncode == 1
            assert f"as process {running.pid}: this second one ends now" in output
        robot.forget()


def test_both_languages_report_the_same(start: Start, start_python: Start, robot: Robot) -> None:
    """Statuses and events have the same level, message and values, except for times."""
    seen = []
    for each in (start, start_python):
        robot.take_over(0)  # a starting node gets the last mode
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
    kept = ((name, value) for name, value in values.items() if name not in times)
    return {name: _DURATION.sub("... s", value) for name, value in kept}


@pytest.mark.parametrize(
    ("parameter", "fragment"),
    [
        ("publish_freq:=-1.0", "publish_freq"),
        ("publish_freq:=often", "publish_freq"),
        ("realtime_priority:=100", "realtime_priority"),
        ("state_file:=3", "state_file"),
    ],
)
def test_invalid_parameter_is_reported_without_a_crash(
    start: Start, parameter: str, fragment: str
) -> None:
    """The program exits with 1 and a message."""
    with start(parameter) as process:
        output, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == 1
    assert fragment in output
    assert "terminate called" not in output


def test_garbage_collection_parameter_has_no_effect(start: Start, robot: Robot) -> None:
    """Parameter files of the Python node are valid for the C++ node."""
    with start("garbage_collection:=false") as process:
        robot.meet()
        code, _ = end(process, robot, signal.SIGTERM)
    assert code == 0
