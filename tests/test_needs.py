"""Tests declare the programs that they run (:mod:`tests.support.needs`)."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.needs import may_run, need_of

ROOT = Path(__file__).resolve().parents[1]

DECLARED = """
import subprocess
from tests.support.needs import may_run, needs

@needs("no-such-program")
def test_is_skipped():
    assert False

@needs("gcc", "make")
def test_needs_two():
    subprocess.run(["make", "--version"], check=True)

@may_run("no-such-program")
def test_runs_without_it():
    pass
"""

SEEN = {
    "a command": 'import subprocess\ndef test_it():\n    subprocess.run(["gcc", "--version"])\n',
    "a constant": (
        'import subprocess\nCOMPILER = "gcc"\n'
        "def test_it():\n    subprocess.run([COMPILER, '--version'])\n"
    ),
    "a command in a constant": (
        'import subprocess\nCOMPILER = ("gcc", "-O2")\n'
        "def test_it():\n    subprocess.run([*COMPILER, '--version'])\n"
    ),
    "a parameter": (
        'import subprocess, pytest\n@pytest.mark.parametrize("command", [("gcc", "-v")])\n'
        "def test_it(command):\n    subprocess.run(command)\n"
    ),
    "a fixture": (
        "import subprocess, pytest\n@pytest.fixture\ndef built():\n"
        '    subprocess.run(["gcc", "--version"])\ndef test_it(built):\n    pass\n'
    ),
    "a support module": (
        "from tests.support import preload\n"
        "def test_it(tmp_path):\n    preload.build_shim('clock', tmp_path)\n"
    ),
    "a method": (
        "from tests.support.preload import WallClock\n"
        "def test_it(tmp_path):\n    WallClock(tmp_path)\n"
    ),
    "a search": "import shutil\ndef test_it():\n    assert shutil.which('gcc')\n",
}
"""Tests that run gcc and do not declare it, by what has to be read to see that."""

HIDDEN = """
import subprocess

def test_it():
    subprocess.run(["ls" + "", "--version"], check=True, capture_output=True)

def test_that_runs_python():
    import sys
    subprocess.run([sys.executable, "--version"], check=True)
"""


@pytest.fixture
def run(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> pytest.Pytester:
    """Return a folder whose tests are run with the plug-in, in a process of their own."""
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    return pytester


def outcome(run: pytest.Pytester, text: str, *arguments: str) -> pytest.RunResult:
    """Run the tests of a text."""
    run.makepyfile(text)
    plugin = ("-p", "tests.support.needs", "-p", "no:cacheprovider", "-rs")
    return run.runpytest_subprocess(*plugin, *arguments)


def test_missing_program_skips_the_test_by_name(
    run: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The reason names each missing program; a test that may do without one passes."""
    monkeypatch.setenv("PATH", "")
    result = outcome(run, DECLARED)
    result.assert_outcomes(passed=1, skipped=2)
    result.stdout.fnmatch_lines(["*no no-such-program", "*no gcc, no make"])


@pytest.mark.parametrize("way", SEEN)
def test_undeclared_program_is_an_error_in_collection(run: pytest.Pytester, way: str) -> None:
    """It is found by reading, so even where the program is missing or no test is run."""
    result = outcome(run, SEEN[way], "--collect-only")
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(['*test_it* runs *gcc, which it does not declare*@needs(*"gcc")*'])


def test_programs_of_ros_come_with_rclcpp(monkeypatch: pytest.MonkeyPatch) -> None:
    """A container is no need of its own; what is beside the prefix is."""
    monkeypatch.setenv("AMENT_PREFIX_PATH", "/opt/own:/opt/ros/jazzy")
    container = Path("/opt/ros/jazzy/lib/rclcpp_components/component_container")
    assert need_of(container) == "rclcpp"
    assert need_of(Path("/opt/ros/jazzy/bin/ros2")) == "ros2"
    assert need_of(Path("/usr/lib/tool")) == "tool"


def test_undeclared_program_that_cannot_be_read_fails_the_test(run: pytest.Pytester) -> None:
    """What is run is seen when it runs; Python itself needs no declaration."""
    result = outcome(run, HIDDEN)
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(['*the test runs ls, which it does not declare*@needs("ls")*'])


@may_run("make")
def test_guards_hold_where_there_are_only_python_and_make(tmp_path: Path) -> None:
    """On such a machine the tests with needs are skipped, and what is left of them passes."""
    for name, program in {"python3": sys.executable, "make": shutil.which("make")}.items():
        if program is not None:
            (tmp_path / name).symlink_to(program)
    files = [path for path in (ROOT / "tests").rglob("test_*.py") if "needs(" in path.read_text()]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-m", "needs", *files],
        cwd=ROOT,
        env={**os.environ, "PATH": str(tmp_path), "PYTEST_ADDOPTS": ""},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-5000:]
    counts = {word: int(number) for number, word in re.findall(r"(\d+) (\w+)", done.stdout[-200:])}
    assert counts["skipped"] > 300
    assert counts.get("passed", 0) < 10
