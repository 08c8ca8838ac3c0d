"""The demo of the wheeled robots' faults, as ``make demo ROBOT=kobuki`` runs it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.examples import EXAMPLES

DEMO = EXAMPLES / "faults/demo.py"
LONGEST = 600.0
"""Seconds after which the demo is considered hung."""


def run(arguments: list[str], environment: dict[str, str]) -> subprocess.CompletedProcess[str]:
    """Run the demo to its end."""
    command = [sys.executable, str(DEMO), *arguments]
    return subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=LONGEST, check=False
    )


@pytest.mark.ros
@pytest.mark.parametrize(
    ("robot", "fault"),
    [("kobuki", "spin"), ("frobit", "left_throttle"), ("intelligent_one", "speed")],
)
def test_demo_shows_a_fault_its_stop_and_its_picture(
    robot: str, fault: str, tmp_path: Path, ros_env: dict[str, str]
) -> None:
    """It says what was expected and what the safety node said, and exits with 0 as both agree."""
    outcome = run([robot, "--fault", fault, "--output", str(tmp_path)], ros_env)
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr
    first, second, *_ = outcome.stdout.splitlines()
    expected = first.split("“")[1].split("”")[0]
    assert first.startswith(f"{fault}: expected")
    assert f"the safety node said “{expected}" in second
    assert second.endswith("; the robot stands")
    picture = (tmp_path / "run.html").read_text(encoding="utf-8")
    assert picture.count("<figure>") == 1
    assert "<title>stop</title>" in picture
    assert ("<title>yard</title>" in picture) == (robot == "kobuki")
