"""The feeding robot on real middleware: its fifteen cases, and a clean end in all circumstances."""

from __future__ import annotations

import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.cpp import BUILD_LIMIT, python_overlay
from tests.support.examples import EXAMPLES
from tests.support.needs import needs
from tests.support.processes import processes_with

DEMO = EXAMPLES / "feeding_robot/demo.py"
RUNS = (range(1, 4), range(4, 8), range(8, 15), range(15, 16))
"""Cases that are played in one run each, so that test processes share them; the last one is played
on simulated time, which needs a start of its own anyway.
"""

LONGEST = 900.0
"""Seconds after which the demo is considered hung."""


def start(
    arguments: list[str], environment: dict[str, str], output: Path, demo: Path = DEMO
) -> subprocess.Popen[str]:
    """Start the demo, or the given one, as a background job of a shell."""
    command = [sys.executable, str(demo), "--output", str(output), *arguments]
    return subprocess.Popen(
        ["sh", "-c", 'trap "" INT; exec "$@"', "sh", *command],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def logs(folder: Path) -> list[str]:
    """Return the last lines of the output of the robot's nodes."""
    return [
        f"{log.name}: {line}"
        for log in sorted(folder.glob("*.log"))
        for line in log.read_text().splitlines()[-100:]
    ]


def test_runs_cover_all_fifteen_cases() -> None:
    """No case is omitted or repeated."""
    assert [number for cases in RUNS for number in cases] == list(range(1, 16))


@needs("sh")
@pytest.mark.ros
@pytest.mark.parametrize(
    ("language", "cases"),
    [
        ("python", RUNS[0]),
        *(pytest.param("python", cases, marks=pytest.mark.slow) for cases in RUNS[1:]),
        pytest.param("cpp", range(1, 16), marks=needs("rclcpp")),
    ],
    ids=lambda value: f"{value[0]}-{value[-1]}" if isinstance(value, range) else None,
)
@pytest.mark.essential
def test_cases_pass(language: str, cases: range, ros_env: dict[str, str], tmp_path: Path) -> None:
    """Every case reacts as expected, the picture shows it, and no process is left."""
    arguments = ["--cases", f"{cases[0]}-{cases[-1]}"]
    limit = LONGEST
    if language == "cpp":
        arguments, limit = [*arguments, "--cpp"], LONGEST + BUILD_LIMIT
        ros_env = python_overlay(tmp_path / "cpp/install", ros_env)
    with start(arguments, ros_env, tmp_path) as demo:
        text, _ = demo.communicate(timeout=limit)
    assert demo.returncode == 0, "\n".join([text, *logs(tmp_path)])
    passed = f"{len(cases)} of {len(cases)} cases passed"
    assert passed in (tmp_path / "run.html").read_text()
    assert ("median" in text) is any(number < 14 for number in cases)
    assert processes_with(str(tmp_path)) == []


@needs("sh")
@pytest.mark.ros
@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_demo_leaves_no_process(
    number: signal.Signals, ros_env: dict[str, str], tmp_path: Path
) -> None:
    """A signal during a case ends player and robot, with the matching exit code."""
    with start(["--cases", "7,8"], ros_env, tmp_path) as demo:
        assert demo.stdout is not None
        for line in demo.stdout:
            if line.startswith(" 7 "):
                break  # the first case is over, the second has started
        assert processes_with(str(tmp_path)) != []
        demo.send_signal(number)
        demo.stdout.read()
    assert demo.returncode == 128 + number
    assert processes_with(str(tmp_path)) == []


def changed(tmp_path: Path, file: str, before: str, after: str) -> Path:
    """Return the demo of a copy of the example with one text replaced."""
    example = tmp_path / "feeding_robot"
    shutil.copytree(DEMO.parent, example)
    text = (example / file).read_text()
    assert text.count(before) == 1
    (example / file).write_text(text.replace(before, after))
    return example / "demo.py"


@needs("sh")
@pytest.mark.ros
@pytest.mark.slow
def test_wrong_reaction_fails_the_demo(ros_env: dict[str, str], tmp_path: Path) -> None:
    """With a rule too lax, the case that needs it fails, and so does the run."""
    rule = "const forward_limit = "
    demo = changed(tmp_path, "feeding_robot.deros", f"{rule}1.0 m/s", f"{rule}1.4 m/s")
    with start(["--cases", "10"], ros_env, tmp_path / "out", demo) as run:
        text, _ = run.communicate(timeout=LONGEST)
    assert run.returncode == 1, text
    assert "Case 10 failed: the reaction took" in text, text


@needs("sh")
@pytest.mark.slow
@pytest.mark.ros
def test_failed_node_ends_the_demo_at_once(ros_env: dict[str, str], tmp_path: Path) -> None:
    """The demo does not wait for a missing robot, and the message names the failed node."""
    body = "src/feeding_robot_plc/feeding_robot_plc/plc.py"
    demo = changed(tmp_path, body, "self._reports = 0", "raise RuntimeError('broken')")
    with start(["--cases", "1,4"], ros_env, tmp_path / "out", demo) as run:
        text, _ = run.communicate(timeout=LONGEST)
    assert run.returncode == 1, text
    assert "Case 1 failed: the system has ended: plc has failed; see" in text
    assert processes_with(str(tmp_path)) == []


@needs("sh")
@pytest.mark.ros
def test_model_error_prevents_the_demo(ros_env: dict[str, str], tmp_path: Path) -> None:
    """The demo reports the line without a traceback, and starts nothing."""
    demo = changed(tmp_path, "feeding_robot.deros", "speed > forward_limit", "sped > forward_limit")
    with start([], ros_env, tmp_path / "out", demo) as run:
        text, _ = run.communicate(timeout=LONGEST)
    assert run.returncode == 1
    assert re.search(r"feeding_robot\.deros:\d+: .*'sped'", text), text
    assert "Traceback" not in text
