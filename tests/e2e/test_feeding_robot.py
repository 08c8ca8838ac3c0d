"""The feeding robot on the real middleware: its fifteen cases, and a clean end whatever happens."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.examples import EXAMPLES
from tests.support.processes import processes_with

DEMO = EXAMPLES / "feeding_robot/demo.py"
LONGEST = 400.0
"""Seconds after which the demo is taken to hang."""


def start(arguments: list[str], environment: dict[str, str], output: Path) -> subprocess.Popen[str]:
    """Start the demo."""
    return subprocess.Popen(
        [sys.executable, str(DEMO), "--output", str(output), *arguments],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


@pytest.mark.ros
def test_the_fifteen_cases_pass(ros_env: dict[str, str], tmp_path: Path) -> None:
    """Every case reacts as it must, the picture tells so, and nothing is left running."""
    with start([], ros_env, tmp_path) as demo:
        text, _ = demo.communicate(timeout=LONGEST)
    assert demo.returncode == 0, text
    assert "15 of 15 cases passed" in (tmp_path / "run.html").read_text()
    assert "median" in text
    assert processes_with(str(tmp_path)) == []


@pytest.mark.ros
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_demo_leaves_nothing_running(
    number: signal.Signals, ros_env: dict[str, str], tmp_path: Path
) -> None:
    """A signal in the middle of a case ends player and robot, and the exit code tells."""
    with start(["--cases", "7,8"], ros_env, tmp_path) as demo:
        assert demo.stdout is not None
        for line in demo.stdout:
            if line.startswith(" 7 "):
                break  # the first case has been played, the second has begun
        assert processes_with(str(tmp_path)) != []
        demo.send_signal(number)
        demo.stdout.read()
    assert demo.returncode == 128 + number
    assert processes_with(str(tmp_path)) == []


@pytest.mark.ros
def test_a_robot_that_reacts_wrongly_fails_the_demo(
    ros_env: dict[str, str], tmp_path: Path
) -> None:
    """With a rule too lax, the case that needs it fails, and so does the whole run."""
    example = tmp_path / "feeding_robot"
    subprocess.run(["cp", "-r", str(DEMO.parent), str(example)], check=True)
    rules = example / "feeding_robot.deros"
    text = rules.read_text()
    assert "const forward_limit = 1.0 m/s" in text
    rules.write_text(text.replace("const forward_limit = 1.0 m/s", "const forward_limit = 1.4 m/s"))
    command = [sys.executable, str(example / "demo.py"), "--cases", "10"]
    run = subprocess.run(
        [*command, "--output", str(tmp_path / "out")],
        env=ros_env,
        capture_output=True,
        text=True,
        timeout=LONGEST,
        check=False,
    )
    assert run.returncode == 1, run.stdout
    assert "Case 10 failed" in run.stdout
