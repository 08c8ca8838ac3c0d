"""The process that runs a launch file: what it says where that does not work.

The modules named ``launch`` here stand for what a user may have; none of them is the real one.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.importers.launch.python_files import running
from deros.importers.launch.python_files.running import visited
from deros.importers.readers import UnreadableError


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a launch file beside which modules may be put that the process imports first."""
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    made = tmp_path / "robot.launch.py"
    made.write_text("def generate_launch_description():\n    return None\n")
    return made


def test_another_program_named_launch_is_not_the_one(file: Path) -> None:
    """What to source is said in one line."""
    (file.parent / "launch.py").write_text("")
    with pytest.raises(UnreadableError) as raised:
        visited(file, {})
    said = str(raised.value)
    assert said.startswith(f"{file}: launch and launch_ros run it, and Python cannot import them")
    assert said.endswith("source ROS 2 before, as in 'source /opt/ros/jazzy/setup.bash'")
    assert "\n" not in said


def test_file_that_goes_on_for_ever_is_ended_with_all_it_has_started(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its processes hold a pipe, which ends when the last one of them is gone."""
    pipe = file.parent / "held"
    import os

    os.mkfifo(pipe)
    end = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    (file.parent / "launch.py").write_text(
        "import os, subprocess, sys, threading\n"
        f"held = os.open({str(pipe)!r}, os.O_WRONLY)\n"
        "os.write(held, b'held')\n"
        "waits = 'import threading; threading.Event().wait()'\n"
        "subprocess.Popen([sys.executable, '-c', waits], pass_fds=[held])\n"
        "print('waits for a robot', flush=True)\n"
        "threading.Event().wait()\n"
    )
    monkeypatch.setattr(running, "LONGEST_S", 2.0)
    with pytest.raises(UnreadableError) as raised:
        visited(file, {})
    assert str(raised.value) == (
        f"{file}: the launch file has not made its actions within 2 s; "
        "the end of its output:\n  waits for a robot"
    )
    os.set_blocking(end, True)
    with os.fdopen(end, "rb") as stream:
        assert stream.read() == b"held"  # up to its end


def test_file_that_ends_the_process_is_refused(file: Path) -> None:
    """With what it has said before."""
    (file.parent / "launch.py").write_text(
        "import os\nprint('no\\x1b[31m robot', flush=True)\nos._exit(3)\n"
    )
    with pytest.raises(UnreadableError, match=r"robot\.launch\.py: .* ended its process \(3\)"):
        visited(file, {})
    with pytest.raises(UnreadableError) as raised:
        visited(file, {})
    assert "\x1b" not in str(raised.value)
    assert "robot" in str(raised.value).splitlines()[-1]
