"""What is seen of a running system: log files beside the output, and a table in its place."""

from __future__ import annotations

import fcntl
import os
import re
import struct
import subprocess
import sys
import termios
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from deros.generators.system.script.standalone.watch.logs import LogFile, Logs, OpenError
from deros.generators.system.script.standalone.watch.table import Usage
from tests.support.stand_ins import Run, end_careless, make_prefix, make_script

Start = Callable[..., Run]
STAMP = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}[+-]\d{4} ")


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    """Return the variables under which the stand-ins are found."""
    prefix = make_prefix(tmp_path / "prefix")
    return {"PATH": os.environ["PATH"], "AMENT_PREFIX_PATH": str(prefix)}


@pytest.fixture
def start(tmp_path: Path, environment: dict[str, str]) -> Iterator[Start]:
    """Return a function that starts the script of a system."""
    runs: list[Run] = []

    def start_script(members: str, *arguments: str) -> Run:
        script = make_script(tmp_path, members)
        runs.append(Run([sys.executable, "-IS", script, *arguments], environment))
        return runs[-1]

    yield start_script
    for run in runs:
        run.close()


def lines_of(file: Path) -> list[str]:
    """Return the lines of a log file without their stamps, each of which is one."""
    found = file.read_text().splitlines()
    assert all(STAMP.match(line) for line in found)
    return [STAMP.sub("", line, count=1) for line in found]


# Log files ----------------------------------------------------------------------------------------


def test_each_program_has_a_log_file_beside_the_output(start: Start, tmp_path: Path) -> None:
    """And one holds everything in its order, with what the script says."""
    logs = tmp_path / "some" / "logs"
    run = start(
        "node a : unfinished node b : short namespace /x node b : failing namespace /y",
        "--keep-going",
        "--log-dir",
        str(logs),
    )
    assert run.end() == 1
    assert sorted(each.name for each in logs.iterdir()) == [
        *("Robot-all.log", "a.log", "x.b.log", "y.b.log"),
    ]
    assert lines_of(logs / "a.log") == ["one", "two", "three"]
    assert lines_of(logs / "x.b.log") == ["done"]
    assert lines_of(logs / "y.b.log") == ["giving up"]
    assert lines_of(logs / "Robot-all.log") == run.lines


def test_log_files_are_added_to(start: Start, tmp_path: Path) -> None:
    """A second run loses nothing of the first."""
    for _ in range(2):
        assert start("node a : short", "--log-dir", str(tmp_path / "logs")).end() == 0
    assert lines_of(tmp_path / "logs" / "a.log") == ["done", "done"]


def test_full_log_file_begins_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The newest lines are all there, in order; what is older than the last files is gone."""
    monkeypatch.setattr(LogFile, "SIZE", 2000)
    logs = Logs(tmp_path, "Robot", ["a"])
    for number in range(500):
        assert logs.write("a", [b"%d" % number]) == []
    logs.close()
    files = [tmp_path / f"a.log{end}" for end in (".5", ".4", ".3", ".2", ".1", "")]
    assert sorted(tmp_path.glob("a.log*")) == sorted(files)
    assert all(file.stat().st_size <= 2000 for file in files)
    numbers = [int(line) for file in files for line in lines_of(file)]
    assert numbers == list(range(500 - len(numbers), 500))
    assert len(numbers) > 5 * 2000 // 40


def test_logs_that_cannot_be_opened_prevent_the_start(start: Start, tmp_path: Path) -> None:
    """So that nobody finds out after the accident."""
    (tmp_path / "file").write_text("")
    run = start("node a : short", "--log-dir", str(tmp_path / "file"))
    assert run.end() == 2
    assert run.lines[0] == "Logs cannot be written, so nothing was started:"
    assert str(tmp_path / "file") in run.lines[1]
    assert run.started() == {}
    with pytest.raises(OpenError):
        Logs(tmp_path / "file" / "below", "Robot", [])


def test_full_disk_is_reported_and_ends_nothing(start: Start, tmp_path: Path) -> None:
    """Once for each file; the output goes on."""
    (tmp_path / "logs").mkdir()
    (tmp_path / "logs" / "a.log").symlink_to("/dev/full")
    run = start("node a : unfinished node b : short", "--log-dir", str(tmp_path / "logs"))
    assert run.end() == 0
    assert [line for line in run.lines if line.startswith("[a]")] == [
        *("[a] one", "[a] two", "[a] three"),
    ]
    faults = [line for line in run.lines if "cannot be written any more" in line]
    assert len(faults) == 1
    assert re.fullmatch(r"\[Robot\] .*/a\.log cannot be written .*No space left.*", faults[0])
    assert lines_of(tmp_path / "logs" / "b.log") == ["done"]


# The table ----------------------------------------------------------------------------------------


def frames(
    folder: Path, env: dict[str, str], members: str, size: tuple[int, int], *arguments: str
) -> tuple[list[str], int]:
    """Return all that a script draws on a terminal of some lines and columns, and its exit code."""
    script = make_script(folder, members)
    pid, terminal = os.forkpty()
    if pid == 0:
        command = [sys.executable, "-IS", str(script), "--table", *arguments]
        # Waits for a line, so that the size is set before the script asks for it.
        os.read(0, 100)
        os.execvpe(command[0], command, {**env, "NO_COLOR": "1"})
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", *size, 0, 0))
    os.write(terminal, b"\n")
    text = b""
    try:
        while data := os.read(terminal, 4096):
            text += data
    except OSError:  # how Linux reports the end of a terminal
        pass
    _, status = os.waitpid(pid, 0)
    os.close(terminal)
    found = text.decode().split("\033[H")[1:]
    return found, os.waitstatus_to_exitcode(status)


def screen(frame: str) -> list[str]:
    """Return the lines of a frame."""
    assert frame.endswith("\033[J")
    return frame.removesuffix("\033[J").replace("\033[K", "").replace("\r", "").split("\n")[:-1]


MEMBERS = "node a : unfinished node long_name : short namespace /x node b : failing respawn max 2"


def test_table_shows_how_each_program_is(tmp_path: Path, environment: dict[str, str]) -> None:
    """Its state, how often it was started again, and below the last lines of the output."""
    found, code = frames(tmp_path, environment, MEMBERS, (40, 120), "--keep-going")
    assert code == 1
    (head, *rows), last = screen(found[-1])[:4], screen(found[-1])[5:]
    assert head.split() == ["Robot", "pid", "cpu", "memory", "restarts", "state"]
    assert [row.split() for row in rows] == [
        ["a", "ended"],
        ["long_name", "ended"],
        ["b", "2", "exited", "with", "code", "3"],
    ]
    assert "[b] giving up" in last
    assert len(last) <= 8
    assert any("waiting" in frame or "running" in frame for frame in found)


def test_table_tells_what_was_stopped_from_what_failed(
    tmp_path: Path, environment: dict[str, str]
) -> None:
    """As the lines of the output do, whatever signal or code ended it."""
    members = "node a : slow node b : starting node c : failing node d : short delay 100 sec"
    found, code = frames(tmp_path, environment, members, (40, 120), "--stop-timeout", "0.5")
    assert code == 1
    assert [row.split() for row in screen(found[-1])[1:5]] == [
        ["a", "stopped"],
        ["b", "stopped"],
        ["c", "exited", "with", "code", "3"],
        ["d", "not", "started"],
    ]


def test_table_tells_what_is_left_behind(tmp_path: Path, environment: dict[str, str]) -> None:
    """What no signal ends has not ended."""
    found, code = frames(tmp_path, environment, "node a : unburied", (9, 120), "--stop-timeout=0.1")
    assert code == 1
    lines = [line.rstrip() for line in screen(found[-1])]
    assert lines[1].endswith("left behind")
    end_careless(lines)


def test_table_fits_on_the_screen(tmp_path: Path, environment: dict[str, str]) -> None:
    """However many programs there are; what has no room is counted."""
    members = " ".join(f"node node_{number} : short" for number in range(20))
    found, code = frames(tmp_path, environment, members, (16, 30))
    assert code == 0
    for frame in found:
        lines = screen(frame)
        assert len(lines) < 16
        assert max(map(len, lines)) <= 30
        assert lines[5] == "and 16 more"


def test_table_goes_with_log_files(tmp_path: Path, environment: dict[str, str]) -> None:
    """Where all lines are."""
    arguments = ("--keep-going", "--log-dir", str(tmp_path / "logs"))
    frames(tmp_path, environment, MEMBERS, (40, 120), *arguments)
    assert lines_of(tmp_path / "logs" / "b.log") == ["giving up"] * 3
    assert lines_of(tmp_path / "logs" / "a.log") == ["one", "two", "three"]


def test_table_needs_a_terminal(start: Start) -> None:
    """In a pipe nobody could read it."""
    run = start("node a : short", "--table")
    assert run.end() == 2
    assert run.lines == ["--table draws on a terminal, and the output is none"]


def test_load_and_memory_are_those_of_a_whole_group() -> None:
    """A quarter of a second of two processes, in what is said to be a second."""
    code = """import os, sys, time
child = os.fork()
memory = bytearray(50_000_000 if child else 0)
if child:
    sys.stdin.readline()
while time.process_time() < 0.3:
    pass
if child:
    os.waitid(os.P_PID, child, os.WEXITED | os.WNOWAIT)
    print("spent", flush=True)
    sys.stdin.readline()
    os.wait()
"""
    with subprocess.Popen(
        [sys.executable, "-ISc", code],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        usage = Usage()
        first = usage.measured([process.pid, 1 << 30], 100.0)
        assert list(first) == [process.pid]
        assert first[process.pid][0] is None
        process.stdin.write("go\n")
        process.stdin.flush()
        assert process.stdout.readline() == "spent\n"
        share, memory = usage.measured([process.pid], 101.0)[process.pid]
        assert share is not None
        assert 0.2 < share < 1.5
        assert memory > 50_000_000
        process.stdin.write("end\n")
    assert usage.measured([process.pid], 102.0) == {}
