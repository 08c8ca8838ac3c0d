"""Signals at any instant: no traceback, the exit code of an interrupt, and nothing left behind."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from deros.cli.interrupts import INTERRUPTED
from tests.cli.commands.test_up import SYSTEM, generate_package
from tests.support.interrupted import LOST
from tests.support.stand_ins import Run, make_prefix

BEGUN = """\
import signal
real = signal.signal
def tell(*arguments):
    before = real(*arguments)
    signal.signal = real
    print("begun", flush=True)
    return before
signal.signal = tell
from deros.cli.start import main
main()
"""
"""``deros``, which tells when it has replaced Python's own handling of SIGINT, as it does first."""


def as_in_a_shell(code: int) -> int:
    """Return the exit code of a process that may have been ended by a signal."""
    return code if code >= 0 else 128 - code


def signal_at(
    instant: float, number: signal.Signals, folder: Path, env: dict[str, str]
) -> tuple[int, str]:
    """Run the system, and send the signal so many seconds after its begin; return code and output.

    Raises:
        AssertionError: if a traceback is printed, or a node is left.
    """
    run = Run([sys.executable, "-c", BEGUN, "up", folder / "talk.system", "--install", folder], env)
    try:
        run.until("begun")
        time.sleep(instant)  # what is tested: it makes no difference where this is
        run.signal(number)
        code = as_in_a_shell(run.end())
    finally:
        run.close()
    text = "\n".join(run.lines)
    assert "Traceback" not in text, f"after {instant} s:\n{text}"
    assert "Fatal Python error" not in text, f"after {instant} s:\n{text}"
    assert not [pid for pid in run.started().values() if Path(f"/proc/{pid}").exists()], text
    return code, text


@pytest.fixture
def talk(tmp_path: Path) -> Path:
    """Make a system of generated nodes in Python, run from their sources; return its folder."""
    generate_package(tmp_path)
    (tmp_path / "talk.system").write_text(SYSTEM)
    return tmp_path


@pytest.mark.ros
@pytest.mark.parametrize("instant", [0.0, 0.3, 0.6, 0.9, 1.2, 1.8])
def test_interrupt_gives_no_traceback_at_any_instant(
    talk: Path, ros_env: dict[str, str], instant: float
) -> None:
    """Whatever deros and its nodes are about, they end in silence."""
    code, text = signal_at(instant, signal.SIGINT, talk, ros_env)
    assert code == INTERRUPTED, text


@pytest.mark.ros
@pytest.mark.parametrize(("number", "instant"), [(signal.SIGTERM, 0.9), (signal.SIGHUP, 1.2)])
def test_other_signals_give_no_traceback(
    talk: Path, ros_env: dict[str, str], number: signal.Signals, instant: float
) -> None:
    """The nodes are stopped as by Ctrl-C; the code is that of the signal, or 0 with nodes."""
    code, text = signal_at(instant, number, talk, ros_env)
    assert code in (0, 128 + number), text


@pytest.mark.slow(seconds=30)
@pytest.mark.ros
@pytest.mark.parametrize("tenths", range(0, 40, 5))
def test_interrupt_at_each_50_ms_of_the_first_four_seconds(
    talk: Path, ros_env: dict[str, str], tenths: int
) -> None:
    """As above, in small steps."""
    for step in range(11):
        instant = tenths / 10 + step * 0.05
        code, text = signal_at(instant, signal.SIGINT, talk, ros_env)
        assert code == INTERRUPTED, f"after {instant} s:\n{text}"


@pytest.mark.slow(seconds=50)
@pytest.mark.ros
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_other_signals_at_each_200_ms(
    talk: Path, ros_env: dict[str, str], number: signal.Signals
) -> None:
    """As above, in small steps."""
    for step in range(21):
        code, text = signal_at(step * 0.2, number, talk, ros_env)
        assert code in (0, 128 + number), f"after {step * 0.2} s:\n{text}"


@pytest.mark.ros
def test_failed_node_is_not_drowned_by_those_that_start(
    talk: Path, ros_env: dict[str, str]
) -> None:
    """A node that ends at once with a reason stops the others, which say nothing of it."""
    prefix = make_prefix(talk / "install" / "demo", names=["failing"])
    (talk / "failing.rnd").write_text("node failing : demo")
    system = SYSTEM.replace("subsystem front", "node bad : failing\n    subsystem front")
    (talk / "talk.system").write_text(system)
    places: list[str | Path] = ["--install", talk, "--install", prefix.parent]
    run = Run([sys.executable, "-c", BEGUN, "up", talk / "talk.system", *places], ros_env)
    try:
        assert run.end() == 1
    finally:
        run.close()
    text = "\n".join(run.lines)
    assert "[bad] giving up" in run.lines
    assert "[Talk] stopping: bad has failed" in run.lines
    assert "Traceback" not in text, text


# Other commands -----------------------------------------------------------------------------------

IN_WRITING = """\
import os, pathlib, signal
from deros.cli.start import main
real = pathlib.Path.replace
def replace(*arguments):
    pathlib.Path.replace = real
    os.kill(os.getpid(), signal.{number})
    return real(*arguments)
pathlib.Path.replace = replace
main()
"""


def deros(text: str, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """Run a program that calls ``deros`` with the arguments."""
    return subprocess.run(
        [sys.executable, "-c", text, *arguments], capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize("command", [["check"], ["generate", "--target", "python"]])
def test_interrupt_of_a_command_is_not_lost(tmp_path: Path, command: list[str]) -> None:
    """Python's own handler would raise an exception that some places print and forget."""
    (tmp_path / "a.rnd").write_text("node a : demo")
    done = deros(LOST, *command, tmp_path / "a.rnd")
    assert (done.returncode, done.stdout) == (INTERRUPTED, "")
    assert done.stderr == "\nderos: interrupted\n"
    assert [path.name for path in tmp_path.iterdir()] == ["a.rnd"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_nothing_is_half_written(tmp_path: Path, number: signal.Signals) -> None:
    """A signal among the renames waits for the last of them."""
    (tmp_path / "a.rnd").write_text("node a : demo")
    whole = deros("from deros.cli.start import main; main()", *arguments(tmp_path, "whole"))
    assert whole.returncode == 0, whole.stderr
    done = deros(IN_WRITING.format(number=number.name), *arguments(tmp_path, "signalled"))
    assert as_in_a_shell(done.returncode) == 128 + number
    assert "Traceback" not in done.stderr
    assert written(tmp_path / "signalled") == written(tmp_path / "whole")


def arguments(folder: Path, output: str) -> list[str | Path]:
    """Return those that generate the node into a folder of that name."""
    return ["generate", folder / "a.rnd", "--target", "python", "-o", folder / output]


def written(folder: Path) -> set[str]:
    """Return the paths of all files below a folder."""
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
