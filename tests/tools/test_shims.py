"""The libraries that simulate faults: safe wherever the program under test may call them."""

from __future__ import annotations

import errno
import os
import re
import subprocess
import time
from pathlib import Path

import pytest

from tests.support.needs import needs
from tests.support.preload import Disk, WallClock, build_shim

HARNESS = Path(__file__).resolve().parents[1] / "support" / "c" / "signal_stack.c"

STACK = 800
"""Maximum stack size in bytes of a function of a shim; two thousand are guaranteed."""

WRITES = slice(2, 6)
MAKES = slice(6, 9)


@pytest.fixture(scope="session")
def harness(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build a program that calls the functions from a signal handler on a small stack."""
    program = tmp_path_factory.mktemp("harness") / "signal_stack"
    options = ["-Wall", "-Wextra", "-Werror", "-O2", "-Wl,-z,now"]
    subprocess.run(["gcc", *options, "-o", str(program), str(HARNESS)], check=True)
    return program


def call(harness: Path, folder: Path, env: dict[str, str]) -> tuple[list[int], list[int]]:
    """Call all functions; return their results (an error number or 0) and the times read.

    Raises:
        CalledProcessError: with the signal that ended it, if a call overruns its stack.
    """
    stored = folder / "stored"
    stored.touch()
    command = [harness, folder.parent / "plain", stored, folder / "new"]
    done = subprocess.run(
        command, env={**os.environ, **env}, capture_output=True, text=True, check=True
    )
    words = [int(word) for word in done.stdout.split()]
    return words[:12], words[12:]


def preloads(tmp_path: Path) -> tuple[Disk, WallClock, dict[str, str]]:
    """Return a disk, a clock, and the environment with both."""
    folder = tmp_path / "disk"
    folder.mkdir()
    disk, clock = Disk(folder, tmp_path), WallClock(tmp_path)
    both = f"{disk.env['LD_PRELOAD']}:{clock.env['LD_PRELOAD']}"
    return disk, clock, {**disk.env, **clock.env, "LD_PRELOAD": both}


@needs("gcc")
def test_signal_handlers_may_call_the_shims(harness: Path, tmp_path: Path) -> None:
    """On the smallest stack, with a guard page below it, all calls succeed and preserve errno."""
    _, _, env = preloads(tmp_path)
    results, times = call(harness, tmp_path / "disk", env)
    assert results == [0] * 12
    assert all(abs(seconds - time.time()) < 60 for seconds in times)


@needs("gcc")
def test_signal_handlers_get_the_faults(harness: Path, tmp_path: Path) -> None:
    """The disk is full for the folder only, and the clock is stepped."""
    disk, clock, env = preloads(tmp_path)
    (tmp_path / "disk" / "stored").touch()
    disk.fill()
    clock.step(-86_400)
    results, times = call(harness, tmp_path / "disk", env)
    assert results[:2] == [0, 0]
    assert results[WRITES] == [errno.ENOSPC] * 4
    assert results[MAKES] == [errno.ENOSPC] * 3
    assert results[9:] == [0] * 3
    assert all(abs(seconds - time.time() + 86_400) < 60 for seconds in times)
    disk.clear()
    assert call(harness, tmp_path / "disk", env)[0] == [0] * 12


@needs("gcc")
def test_other_folder_with_the_same_prefix_has_space(harness: Path, tmp_path: Path) -> None:
    """Only the named folder is full, not every folder whose name starts like it."""
    disk, _, env = preloads(tmp_path)
    disk.fill()
    (tmp_path / "disk2").mkdir()
    assert call(harness, tmp_path / "disk2", env)[0] == [0] * 12


@needs("gcc")
@pytest.mark.parametrize("name", ["clock", "disk"])
def test_shims_have_a_small_stack_bound(name: str, tmp_path: Path) -> None:
    """The compiler knows a small bound for each function."""
    build_shim(name, tmp_path, "-fstack-usage")
    ((report),) = tmp_path.glob("*.su")
    uses = re.findall(r"^\S*?(\w+)\t(\d+)\t(\S+)$", report.read_text(), re.MULTILINE)
    assert len(uses) > 8
    assert {bound for _, _, bound in uses} == {"static"}
    assert [use for use in uses if int(use[1]) > STACK] == []


@needs("gcc")
def test_disk_is_full_until_the_last_fill_is_cleared(tmp_path: Path) -> None:
    """Two faults of a campaign may overlap."""
    disk = Disk(tmp_path, tmp_path)
    full = Path(disk.env["DISK_FULL"])
    for fillings in (1, 2):
        disk.fill()
        assert full.exists(), fillings
    disk.clear()
    assert full.exists()
    disk.clear()
    assert not full.exists()
